#pragma once

#include <vector>

#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"

namespace bowstring::newton {

/// A barrier method that hands its point over to an active-set method, which ends exactly on the rows that it holds and
/// takes few steps from near a solution. Where the active set does not settle, the barrier method goes on from its own
/// point to the next hand-over, and after the last one to its end.
struct HandOver {
  std::vector<double> barriers;  ///< N mm, falling
  /// Start with the active-set method where multipliers are given.
  bool active_set_first = false;
};

/// From point.q. `multipliers`: m, or empty at a cold start; at the end those of the result.
Ending solve_by_hand_over(Point& point, Progress& progress, const HandOver& how, std::vector<double>& multipliers);

}  // namespace bowstring::newton
