#pragma once

#include <string>
#include <vector>

#include "core/enforcement/softened_problem.hpp"
#include "enforcement/shared/row_sides.hpp"

namespace bowstring::softening {

/// What rows that have become energies leave of themselves, at a solution of what remains.
///
/// That state is the one of least energy among those with rows r ≤ r_i of its own, and λ_i = φ'(r_i) are the
/// multipliers of these. Of E(p), the least energy with rows relaxed by p, dE/dp_i = −λ_i, so that exact rows (p = 0)
/// would add
///   E(0) − E(p) = Σ λ_i p_i + ½ pᵀ ∂²E/∂p² p + …
/// with p_i = r_i: first order in p, and so in 1/weight; what is left out is of second order, and positive where E is
/// convex in p.
struct Bias {
  double violation = 0.0;        ///< mm, largest of the rows taken away
  int worst_row = -1;            ///< the row of that, among all rows
  double complementarity = 0.0;  ///< N mm, largest |λ r| of them
  double energy = 0.0;           ///< N mm, Σ λ_i r_i
};

/// `rows`, `multipliers`: of all rows.
Bias bias_of(const SoftenedProblem& problem, const RowSides& sides, const std::vector<double>& rows,
             const std::vector<double>& multipliers);

/// "%.3g" of a number.
std::string number(double value);

}  // namespace bowstring::softening
