#include "core/certificate/activity.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring {

namespace {

constexpr double vanishing = 1e-6;  // mm and N
constexpr double undecided = 1e-4;  // mm and N
constexpr double apart = 1e2;       // so many times the other: the smaller one counts as vanishing

}  // namespace

RowSide row_side(double lower, double upper, double value, double multiplier) noexcept {
  const bool from_upper = std::isfinite(upper) && (multiplier >= 0.0 || !std::isfinite(lower));
  RowSide out;
  out.bound = from_upper ? upper : lower;
  out.distance = std::fabs(value - out.bound);
  out.multiplier = from_upper ? multiplier : -multiplier;
  return out;
}

Activity activity(const RowSide& side) noexcept {
  const double x = side.distance, z = side.multiplier;
  if (x <= vanishing) return z <= vanishing ? Activity::weak : Activity::strong;
  const double larger = std::max(x, z), smaller = std::min(x, z);
  if (larger <= undecided && apart * smaller >= larger) return Activity::undecided;
  return z > x ? Activity::strong : Activity::open;
}

}  // namespace bowstring
