#pragma once

#include "core/interfaces/solver.hpp"

namespace bowstring {

/// kind `enforcement`: how inequality rows are imposed. Problem → problem plus an outer loop around a solver that
/// can take what remains; it never touches a kinematics' closure rows.
class Enforcement {
 public:
  virtual ~Enforcement() = default;
  /// What the inner solver will be asked to take.
  virtual Status remaining(const ProblemSummary& problem, ProblemSummary& out) const noexcept = 0;
  virtual Status solve(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
                       SolverResult& out) noexcept = 0;
};

}  // namespace bowstring
