#pragma once

#include "core/contact/centerline.hpp"

namespace bowstring::contact {

/// The gap of a wire point x at a place of the curve, φ = F(r, c) in mm, with r = |x − q(σ)|² and the
/// clearance c = R(σ) − wire radius. Minimised over σ it is negative inside the tube's canal surface, the
/// envelope of the spheres of radius c(σ), and zero there (to δ for `smooth_distance`).
///
/// | form            | F                 |                                                             |
/// |-----------------|-------------------|-------------------------------------------------------------|
/// | squared         | (r − c²)/(2c)     | smooth at r = 0; ∂F/∂√r = 1 at contact; needs c > 0         |
/// | distance        | √r − c            | no derivative at r = 0, where the subgradient 0 is returned |
/// | smooth_distance | √(r + δ²) − δ − c | δ = 1e-3 mm; c may have any sign; low by at most δ          |
enum class GapForm : int { squared, distance, smooth_distance };

inline constexpr double gap_smoothing = 1e-3;  ///< δ, mm

/// F and its derivatives in r and c. NaN where the form is not defined (`squared` with c ≤ 0).
struct GapFormValue {
  double value, r, c, rr, rc, cc;
};
GapFormValue gap_form(GapForm form, double r, double c) noexcept;

/// What the gap of one row is measured with.
struct GapShape {
  GapForm form = GapForm::squared;
  double wire_radius = 0.0;  ///< mm
};

/// The stretch low ≤ σ ≤ high of a centerline that a row may search.
struct Window {
  double low = 0.0;
  double high = 0.0;
};

Window whole(const Centerline& curve) noexcept;

/// The segment that σ lies in and `neighbours` segments on each side of it, as far as the curve goes.
Window window_around(double sigma, int neighbours, int nodes) noexcept;

/// All nodes that the curve inside a window depends on.
NodeRange window_nodes(Interpolation interpolation, Window window, int nodes) noexcept;

/// What kind of minimum a closest point is.
enum class Location : int {
  interior,     ///< φ_σ = 0 within a smooth piece
  vertex,       ///< at a polyline's vertex: σ* stays there under small changes
  curve_end,    ///< at σ = 0 or n − 1: σ* stays there
  window_edge,  ///< φ still falls at the window's edge: the closest point is outside the window
};

struct ClosestPoint {
  CurveCoordinate at;
  Location location = Location::interior;
  double gap = 0.0;        ///< h = φ(σ*), mm
  double distance = 0.0;   ///< |x − q(σ*)|, mm
  double clearance = 0.0;  ///< c(σ*), mm
};

/// The closest point of x within a window: σ* = argmin φ.
/// On a spline the search descends from `start` (clipped to the window) to the first minimum and so follows
/// its branch; on a polyline, where φ is convex on each edge, it takes the lowest of the edges' exact minima.
/// σ* is exact to rounding, which second derivatives need. x: dimension numbers, mm. Allocates nothing; the
/// number of steps is bounded; a NaN in x or in the nodes gives a NaN gap.
ClosestPoint closest(const Centerline& curve, const double* x, GapShape shape, Window window, double start) noexcept;

/// The place of least gap on the whole curve: a scan of each segment, then `closest` from every local minimum
/// of it.
ClosestPoint globally_closest(const Centerline& curve, const double* x, GapShape shape) noexcept;

/// The gap at a place that is given instead of searched, as a closest point that stays there.
ClosestPoint gap_at(const Centerline& curve, const double* x, GapShape shape, CurveCoordinate at) noexcept;

/// A point of a wire: its node, or x = (1 − t) p_0 + t p_1 on the straight chord between two nodes.
struct WirePoint {
  int nodes = 1;                   ///< 1 or 2
  const double* points = nullptr;  ///< nodes × dimension, mm
  double radius[2] = {0.0, 0.0};   ///< of the wire at the nodes, mm
  double t = 0.0;
  bool extremal = false;  ///< t is where h is largest or least along the chord, and moves with the nodes

  void position(int dimension, double* x) const noexcept;
  GapShape shape(GapForm form) const noexcept;
};

/// Where h is extremal along a chord.
struct ChordExtremum {
  double t = 0.0;
  bool interior = false;  ///< h_t = 0 there; otherwise at an end
  double bend = 0.0;      ///< how much h_t changes from end to end, mm; < 0 with an extremum between them, > 0 without
  double end_sigma[2] = {};  ///< of the closest points of the chord's two ends
  ClosestPoint closest;
};

/// A stretch of a chord, 0 ≤ low < high ≤ 1.
struct ChordPart {
  double low = 0.0, high = 1.0;

  double middle() const noexcept { return 0.5 * (low + high); }
};

/// The largest (`sign` = 1) or least (−1) h along a chord between two nodes: a local maximum between the ends where
/// there is one, by the slopes there or, where both have one sign, by the cubic through values and slopes; otherwise
/// where the chord's own t is, so that h stays continuous where that maximum vanishes, or, with t at an end, the larger
/// end. `start` is σ of the search at both ends. The location is `window_edge` where a closest point leaves
/// the window. The ends are those of `part`, a stretch of the chord's t; `chord.t` lies in it.
ChordExtremum chord_extremum(const Centerline& curve, const WirePoint& chord, GapForm form, double sign, Window window,
                             double start, ChordPart part = {}) noexcept;

/// h to second order at a closest point, in z = (wire nodes, nodes of the segment's stencil), by the envelope theorem:
/// ∇h = φ_z at fixed σ* and t*, ∇²h = φ_zz − φ_zη φ_ηη⁻¹ φ_ηz with η what moves with z: σ at an interior minimum, t at
/// an interior extremum of the chord.
struct GapExpansion {
  int dimension = 3, wire_nodes = 1;
  NodeRange nodes;                          ///< of the centerline; at most `max_stencil`
  double d[3] = {};                         ///< x − q(σ*) = Σ weight_a z_a
  double slope[3] = {}, chord[3] = {};      ///< q', and ∂x/∂t
  double weight[2 + max_stencil] = {};      ///< of the wire's nodes first
  double weight_sigma[max_stencil] = {};    ///< ∂weight/∂σ of the centerline's nodes
  double first = 0.0, second = 0.0;         ///< 2 F_r, 4 F_rr
  double along_sigma = 0.0, along_t = 0.0;  ///< 2 (F_rr r_η + F_rc c_η)
  double sigma_sigma = 0.0;                 ///< φ_σσ; 0 where σ does not move
  double sigma_t = 0.0;                     ///< φ_σt; 0 where σ does not move
  double t_t = 0.0;                         ///< φ_tt with σ eliminated; 0 where t does not move
};
GapExpansion expand_gap(const Centerline& curve, const WirePoint& point, GapForm form,
                        const ClosestPoint& closest) noexcept;

/// factor·∇h: (wire_nodes + nodes.count)·dimension numbers, the wire's first, then the centerline's nodes in order.
void gap_gradient(const GapExpansion& expansion, double factor, double* out) noexcept;
/// weight·∇²h as packed lower triangle of that order, row by row.
void gap_hessian(const GapExpansion& expansion, double weight, double* out) noexcept;

/// Both at once, null where not wanted; `weight` is of the Hessian alone. Returns the nodes.
NodeRange gap_derivatives(const Centerline& curve, const WirePoint& point, GapForm form, const ClosestPoint& closest,
                          double* gradient, double weight, double* hessian) noexcept;

/// The same for a node of the wire at x.
NodeRange gap_derivatives(const Centerline& curve, const double* x, GapShape shape, const ClosestPoint& closest,
                          double* gradient, double weight, double* hessian) noexcept;

/// A first place on the curve for each of `count` wire points (count × dimension, mm): of all assignments
/// that are monotone along the curve, the one with the least sum of squared distances, so that no point of
/// the wire takes a shortcut to another limb. The wire may run against the curve's direction; it does where
/// that at least halves the sum. Writes σ per point.
void bind_along(const Centerline& curve, const double* points, int count, double* sigma);

}  // namespace bowstring::contact
