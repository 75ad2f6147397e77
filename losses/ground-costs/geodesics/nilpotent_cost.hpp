#pragma once

#include "core/lie/se3.hpp"

namespace bowstring::geodesics {

/// The squared distance of a target from the identity in the nilpotent approximation, and its derivative by the body
/// tangent (ω, ν) of the first place, in units of β and β/w₁. The smaller of both branches of log.
struct NilpotentCost {
  double squared = 0.0;
  Vector<6> gradient;  ///< only where asked for
};
NilpotentCost nilpotent_cost(const lie::Se3& target, double roll_squared, bool with_gradient) noexcept;

}  // namespace bowstring::geodesics
