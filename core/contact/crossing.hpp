#pragma once

#include <optional>

#include "core/contact/centerline.hpp"

namespace bowstring::contact {

/// A wire as the check sees it: straight chords between its nodes.
struct WirePolyline {
  int nodes = 0;                   ///< ≥ 2
  const double* points = nullptr;  ///< nodes × dimension of the vessel, mm
  const double* radius = nullptr;  ///< nodes, mm, linear between them; null: 0
};

/// Where a wire reaches farthest into the wall, or comes closest to it.
struct Penetration {
  double depth = 0.0;              ///< |x − q(σ)| − c(σ), mm; ≤ 0 inside
  double wire_arc = 0.0;           ///< arc coordinate from the wire's first node, mm
  int segment = 0;                 ///< the chord between nodes segment and segment + 1 …
  double t = 0.0;                  ///< … at (1 − t) x_segment + t x_{segment+1}
  double vessel_coordinate = 0.0;  ///< σ, in edges of the vessel
  double distance = 0.0;           ///< |x − q(σ)|, mm
};

/// The largest depth of the wire in the SPLINE wall of a vessel, whatever the view's own interpolation, over
/// `samples_per_segment` equal parts of every chord, both ends included.
///
/// σ is followed continuously from the wire's first end: every sample descends from the σ of the one before
/// it, and at most ten times as far along the vessel as the wire has moved. (Where R κ < 0.8, the closest
/// point of a point inside moves by at most five times that point's step.) A wire that passes through the
/// wall into another limb stays measured from the limb that it left, where a search of each point's own
/// neighbourhood would find it inside of both. Where that leads deeper than anything before, the lowest place that is
/// connected through the lumen (`lowest_connected`) is gone on from: past a ridge of the wall the nearest place jumps.
/// Beyond an end of the vessel the tube is taken to continue
/// straight: only distance across it counts.
///
/// Samples that lie inside by more than the wire can rise on its way to them are not looked at.
///
/// `start`: σ of the wire's first node where it is known; otherwise the globally nearest place.
/// A NaN coordinate gives a NaN depth and its place.
Penetration deepest_penetration(const Centerline& vessel, const WirePolyline& wire, int samples_per_segment,
                                std::optional<double> start = std::nullopt) noexcept;

/// The depth that a result reports, by which every formulation is judged alike: 16 parts of every chord.
Penetration max_penetration_dense(const Centerline& vessel, const WirePolyline& wire,
                                  std::optional<double> start = std::nullopt) noexcept;

/// The depth that a sound discretisation may show between its rows: κh²/4 + c/20, mm, with κ the largest
/// nodal curvature of the vessel, h the longest chord of the wire and c the smallest clearance (smallest
/// lumen radius less largest wire radius). Chords cut the wall by κh²/8. κh²/4 counts up to c: a mesh error
/// beyond the clearance excuses nothing.
double crossing_allowance(const Centerline& vessel, const WirePolyline& wire) noexcept;

/// Whether the wall passes between two nodes of a wire.
struct CrossingCheck {
  Penetration deepest;     ///< beyond `exit` it may be measured from another limb of the vessel
  Penetration exit;        ///< where the allowance is first exceeded; meaningful where `crossed()`
  double allowance = 0.0;  ///< mm

  bool crossed() const noexcept { return !(deepest.depth <= allowance); }
};

/// The check by 20 parts of every chord.
CrossingCheck check_crossing(const Centerline& vessel, const WirePolyline& wire,
                             std::optional<double> start = std::nullopt) noexcept;

/// Both of the above.
struct WallCheck {
  Penetration dense;
  CrossingCheck crossing;
};

/// Both in one walk along the wire.
WallCheck check_wall(const Centerline& vessel, const WirePolyline& wire,
                     std::optional<double> start = std::nullopt) noexcept;

}  // namespace bowstring::contact
