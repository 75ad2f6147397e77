#pragma once

#include <cstddef>
#include <vector>

#include "core/lie/small_matrix.hpp"

namespace bowstring {

/// One piece of a chain: straight, or a bend in one plane.
struct BendSegment {
  double length = 0.0;  ///< mm, > 0
  double bend = 0.0;    ///< rad, the angle between its end tangents, counted on past π
  double plane = 0.0;   ///< rad, direction of the bend about the tangent, from the transported +y toward +z
};

/// Segments one after the other, beginning at the origin along +x.
///
/// Within a segment of length l and bend β the curvature rises and falls as κ(s) = (β/l)(1 − cos 2πs/l), so
/// that curvature and its derivative vanish at every joint: the curve is three times continuously
/// differentiable. Its peak is 2β/l, so the tightest radius is l/(2β). The direction of a bend is fixed in
/// the Bishop (parallel-transported) frame of the whole chain. A segment is planar, hence the frame is exact
/// and the position the integral of (cos θ, sin θ), θ(s) = (β/l)(s − (l/2π) sin 2πs/l), by Gauss–Legendre
/// rules to rounding.
class BendChain {
 public:
  explicit BendChain(std::vector<BendSegment> segments);

  double length() const noexcept { return start_.back().arc; }
  std::size_t segment_at(double arc) const;
  Vector3 position(double arc) const;
  Vector3 tangent(double arc) const;
  /// dt/ds, 1/mm.
  Vector3 curvature_vector(double arc) const;

 private:
  /// Where a segment starts: arc length, position and Bishop frame.
  struct Start {
    double arc = 0.0;
    Vector3 position, tangent{{1.0, 0.0, 0.0}}, normal{{0.0, 1.0, 0.0}}, binormal{{0.0, 0.0, 1.0}};
  };
  Vector3 bend_direction(std::size_t segment) const;
  Vector3 position_in(std::size_t segment, double local) const;

  std::vector<BendSegment> segments_;
  std::vector<Start> start_;  ///< one per segment and one for the end
};

}  // namespace bowstring
