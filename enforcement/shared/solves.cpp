#include "enforcement/shared/solves.hpp"

#include <algorithm>

#include "enforcement/shared/least_squares.hpp"

namespace bowstring::softening {

double largest_violation(const SoftenedProblem& problem, const RowSides& sides) noexcept {
  double largest = 0.0;
  for (std::size_t r = 0; r < problem.last_rows().size(); ++r) {
    largest = std::max(largest, sides.violation(static_cast<int>(r), problem.last_rows()[r]));
  }
  return largest;
}

Status Solves::run(SoftenedProblem& problem, Solver& solver, const std::vector<double>& q, std::vector<double>& kept,
                   const Enough& enough, SolverResult& out) {
  out = {};
  was_enough_ = false;
  const int before = total_.iterations;
  if (!total_.history.empty() && problem.epoch_due()) {
    if (Status status = problem.new_epoch(); !status.ok()) return status;
  }
  SolverContext context;
  context.multipliers = kept;
  context.on_iteration = [&](const IterationRecord& solved) {
    IterationRecord record = solved;
    record.iteration += before;
    record.penetration = std::max(record.penetration, largest_violation(problem, sides_));
    // Further solves begin where the one before has ended.
    if (solved.iteration > 0 || total_.history.empty()) {
      total_.history.push_back(record);
      if (context_.on_iteration && !context_.on_iteration(record)) stopped_by_user_ = true;
    }
    was_enough_ = !stopped_by_user_ && enough && enough(record);
    return !stopped_by_user_ && !was_enough_;
  };
  Status status = solver.solve(problem, q, context, out);
  total_.iterations = before + out.iterations;
  total_.factorizations += out.factorizations;
  total_.evaluations += out.evaluations;
  total_.evaluation_seconds += out.evaluation_seconds;
  total_.factorization_seconds += out.factorization_seconds;
  if (!status.ok()) return status;
  if (out.q.size() != static_cast<std::size_t>(problem.coordinates())) out.q = q;
  // Where it goes on from, whatever trial the solver has looked at last.
  if (status = problem.accept(out.q); !status.ok()) return status;
  kept = out.multipliers;
  if (kept.size() == problem.kept_rows().size()) return {};
  kept.clear();
  if (problem.summary().inequalities > 0) return {};
  return least_squares_multipliers(problem, out.q, kept);
}

}  // namespace bowstring::softening
