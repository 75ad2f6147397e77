#pragma once

#include "core/contact/gap.hpp"

namespace bowstring::contact {

/// Gaps that differ by less are equal: which of two places is taken makes no difference to a result, mm.
inline constexpr double equal_gaps = 1e-8;

/// What shortens a search along a tube: its largest radius (mm), and how much |x − q| − R can change per segment at
/// most (mm).
struct TubeBounds {
  double widest = 0.0, fastest = 0.0;
};
TubeBounds tube_bounds(const Centerline& curve) noexcept;

/// The lowest local minimum of the gap of x that is connected to the place `from`, or `from` where none is lower by
/// `equal_gaps`. On a spline; `from` on a polyline, whose search compares all that a row sees already.
///
/// Where the radius rises or falls fast, the wall has ridges: two balls of the tube, about q(σ₁) and q(σ₂), meet there
/// and the balls between them stay behind. As x passes, the lowest minimum jumps from σ₁ to σ₂, and the one at σ₁ goes
/// on outside of the tube.
///
/// Connected: the centerline between σ₁ and σ₂ lies within the two balls of radius c there. Both hold x (to the depth
/// that is measured), so that their union is star-shaped about it, and the loop x → q(σ₁) → along the centerline →
/// q(σ₂) → x shrinks to a point within the lumen: no wall is in it. A loop through two limbs of a vessel runs around
/// what separates them, and leaves the balls: the centerline of a tube that does not fold into itself (Rκ < 0.8) leaves
/// a ball before it has turned by 48°. Places that are connected by steps are.
/// `bounds`: of the curve as it lies.
ClosestPoint lowest_connected(const Centerline& curve, const TubeBounds& bounds, const double* x, GapShape shape,
                              const ClosestPoint& from) noexcept;

}  // namespace bowstring::contact
