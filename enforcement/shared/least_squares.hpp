#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::softening {

/// Multipliers of a problem that has equality rows alone: of all λ those that leave the least of ∇E + Jᵀλ, each number
/// in newtons. They come from the KKT system with the scales' squares for W (core/kkt), (W Jᵀ; J 0)(δ, λ) = (−∇E, 0).
/// Empty where that is singular.
Status least_squares_multipliers(Problem& problem, const std::vector<double>& q, std::vector<double>& out);

}  // namespace bowstring::softening
