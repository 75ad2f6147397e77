#pragma once

#include <iterator>
#include <vector>

#include "solvers/newton/hand_over.hpp"
#include "solvers/newton/native_backend.hpp"

namespace bowstring::newton {

/// A solver plugin that is a barrier method and an active-set method, one after the other. `Choice` says which it is:
/// its `name`, and in `hand_overs` the barriers (N mm, falling) at which the first hands over to the second.
template <class Choice>
class HandOverSolver final : public Solver {
 public:
  explicit HandOverSolver(const ParameterSet& parameters) : backend_(parameters) {}

  SolverTraits traits() const noexcept override { return NativeBackend::traits(); }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] { backend::check_equalities(Choice::name, summary); });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return backend_.solve(
        problem, start, context, out, [](Point& point, Progress& progress, std::vector<double>& multipliers) {
          return solve_by_hand_over(point, progress, {Choice::hand_overs, std::size(Choice::hand_overs)}, multipliers);
        });
  }

  Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept override {
    return backend_.solve_kkt(right_hand_side, out);
  }

 private:
  NativeBackend backend_;
};

}  // namespace bowstring::newton
