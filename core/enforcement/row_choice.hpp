#pragma once

#include <string>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring {

/// The rows that an enforcement takes away from the solver. `names`: groups of rows, that is labels of constraints, of
/// which every row is taken, equality or not; empty: every inequality row of the scene.
///
/// What is left of the problem. `invalid_input` where a name is none of a constraint, or where it names closure rows,
/// without which a curve would fall apart.
Status without_rows(const ProblemSummary& problem, const std::vector<std::string>& names, ProblemSummary& out);

/// Per row whether it is taken. The names have passed `without_rows`.
std::vector<char> chosen_rows(const Problem& problem, const std::vector<std::string>& names);

}  // namespace bowstring
