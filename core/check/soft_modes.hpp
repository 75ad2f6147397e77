#pragma once

#include <vector>

#include "core/check/check.hpp"

namespace bowstring::checking {

/// Near-zero modes of the Lagrangian's Hessian on the null space of the equality rows, besides the given motions (rates
/// of all tangent numbers): sliding of nodes along a curve, turns of single frames, and others by the unknown that
/// moves most. Multipliers are those of least squares over the equality rows.
std::vector<CheckLine> find_soft_modes(Assembly& assembly, const std::vector<double>& q,
                                       const std::vector<std::vector<double>>& known);

}  // namespace bowstring::checking
