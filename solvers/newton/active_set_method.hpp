#pragma once

#include <string>
#include <vector>

#include "core/kkt/kkt_system.hpp"
#include "solvers/newton/barrier_method.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"
#include "solvers/newton/sides.hpp"

namespace bowstring::newton {

/// Newton's method on the complementarity system, a primal-dual active-set strategy (M. Hintermüller, K. Ito and
/// K. Kunisch, SIAM J. Optim. 13 (2002) 865, who show that it is a semismooth Newton method): rows in the active set
/// hold as equalities, others are left out; a row leaves whose predicted force pulls, and one enters whose predicted
/// gap is positive. It converges fast from near a solution, in a few factorizations after a change of a load, and from
/// nowhere else: it gives up, and leaves the point where it began, when errors do not fall.
class ActiveSetMethod {
 public:
  /// `hasty`: a few rows of a set that has not settled may change along with the next step, which saves factorizations
  /// after a change of a load, and goes astray more often after a barrier method.
  ActiveSetMethod(Point& point, Progress& progress, bool hasty);

  /// From point.q, which is accepted and expanded, and multipliers near a solution's. A claim other than `optimal`
  /// leaves both as they were, unless a limit was reached or the user stopped (`interrupted`).
  Ending run(std::vector<double>& multipliers);
  bool interrupted() const noexcept { return interrupted_; }

 private:
  struct Errors {
    double stationarity = 0.0, violation = 0.0, complementarity = 0.0;
  };

  void choose_active(const std::vector<double>& multipliers);
  void keep_active_forces(std::vector<double>& multipliers) const;
  Errors errors(const std::vector<double>& multipliers);
  /// Solves for the step; false: the system has no positive curvature on the active rows' null space.
  bool solve(const std::vector<double>& multipliers);
  void solve_again(const std::vector<double>& multipliers, int most_refinements);
  int update_active(const std::vector<double>& multipliers);
  bool direction(std::vector<double>& multipliers);
  double longest_step() const;
  bool step(std::vector<double>& multipliers, double& length);

  Point& point_;
  Progress& progress_;
  Problem& problem_;
  std::vector<Side> sides_, bounds_;
  std::vector<int> equalities_;
  std::vector<char> active_;  // per side
  std::vector<double> softness_, right_a_, right_b_, delta_, change_, stationarity_, trial_q_, trial_rows_;
  bool hasty_;
  int steps_ = 0, changes_ = 0;
  bool interrupted_ = false;
};

}  // namespace bowstring::newton
