#pragma once

#include <string>
#include <vector>

#include "core/interfaces/solver.hpp"
#include "plugins/sdk/guard.hpp"
#include "solvers/newton/lent_system.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"
#include "solvers/shared/backend.hpp"

namespace bowstring::newton {

/// What Bowstring's own solvers are apart from their methods: limits, guard, traits, and the system that they lend.
class NativeBackend {
 public:
  /// Reads tolerance, max-iterations, time-limit and step-guard.
  explicit NativeBackend(const ParameterSet& parameters) : guard_(backend::step_guard(parameters)) {
    limits_.tolerance = parameters.scalar("tolerance");
    limits_.max_iterations = static_cast<int>(parameters.integer("max-iterations"));
    limits_.time_limit = backend::time_limit(parameters);
  }

  /// Patterns follow contact, so a narrow window will do.
  static SolverTraits traits() noexcept {
    SolverTraits traits;
    traits.window_segments = 2;
    traits.window_length = 0.0;
    return traits;
  }

  /// `method`: (Point&, Progress&, multipliers) → Ending, from point.q; multipliers are empty at a cold start.
  template <class Method>
  Status solve(Problem& problem, Span<const double> start, const SolverContext& context, SolverResult& out,
               Method&& method) noexcept {
    return guard([&] {
      const backend::Guarded guarded(problem, guard_);
      Point point(problem, out);
      point.q.assign(start.begin(), start.end());
      Progress progress(limits_, context, out);
      std::vector<double> multipliers(context.multipliers.begin(), context.multipliers.end());
      const Ending ending = method(point, progress, multipliers);
      lent_.keep(problem, point.q, multipliers);
      out.q = point.q;
      out.multipliers = multipliers;
      out.claim = ending.claim;
      out.reason = ending.reason;
    });
  }

  Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept {
    return guard([&] { return lent_.solve(right_hand_side, out); });
  }

 private:
  Limits limits_;
  LentSystem lent_;
  double guard_;
};

}  // namespace bowstring::newton
