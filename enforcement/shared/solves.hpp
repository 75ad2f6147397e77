#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/enforcement/softened_problem.hpp"
#include "core/interfaces/solver.hpp"
#include "enforcement/shared/row_sides.hpp"

namespace bowstring::softening {

/// Solves of what remains, one after the other, told as one: iterations are numbered through, counts, seconds and
/// histories are summed, and the violation of a record is that of all rows.
class Solves {
 public:
  Solves(const SolverContext& context, const RowSides& sides, SolverResult& total)
      : context_(context), sides_(sides), total_(total) {}

  /// Asked after each iteration, with its record; true: this solve has come far enough.
  using Enough = std::function<bool(const IterationRecord&)>;
  /// From `q`. `kept`: multipliers of the rows that are left, to start from, or empty; at the end those of the result,
  /// estimated by least squares where the solver has none and only equality rows are left; otherwise empty.
  /// Answers the solver's result, whose q and claim are its own.
  Status run(SoftenedProblem& problem, Solver& solver, const std::vector<double>& q, std::vector<double>& kept,
             const Enough& enough, SolverResult& out);

  bool stopped_by_user() const noexcept { return stopped_by_user_; }
  /// The last solve came to an end because it was enough.
  bool was_enough() const noexcept { return was_enough_; }

 private:
  const SolverContext& context_;
  const RowSides& sides_;
  SolverResult& total_;
  bool stopped_by_user_ = false, was_enough_ = false;
};

/// mm: by how much rows miss their bounds at most, at the point that was last evaluated.
double largest_violation(const SoftenedProblem& problem, const RowSides& sides) noexcept;

}  // namespace bowstring::softening
