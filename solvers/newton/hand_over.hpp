#pragma once

#include <vector>

#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"

namespace bowstring::newton {

/// Where multipliers are given an active-set method starts from them. Otherwise, or where it does not settle, a barrier
/// method hands its point over to an active-set method, which ends exactly on the rows that it holds and takes few
/// steps from near a solution; where that set does not settle, the barrier method goes on from its own point to the
/// next hand-over, and after the last one to its end. From point.q. `barriers`: where the barrier method hands over, N
/// mm, falling. `multipliers`: m, or empty at a cold start; at the end those of the result.
Ending solve_by_hand_over(Point& point, Progress& progress, Span<const double> barriers,
                          std::vector<double>& multipliers);

}  // namespace bowstring::newton
