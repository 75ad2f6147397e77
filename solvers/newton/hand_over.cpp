#include "solvers/newton/hand_over.hpp"

#include <algorithm>

#include "plugins/sdk/guard.hpp"
#include "solvers/newton/active_set_method.hpp"
#include "solvers/newton/barrier_method.hpp"

namespace bowstring::newton {

namespace {

constexpr double warm_barrier = 1e-4;  // N mm: a smaller one traps a warm start of a fine mesh beside its rows

}  // namespace

Ending solve_by_hand_over(Point& point, Progress& progress, Span<const double> barriers,
                          std::vector<double>& multipliers) {
  BarrierSettings settings;
  if (!multipliers.empty()) {
    settings.warm = true;
    settings.first_barrier = warm_barrier;
  }
  if (settings.warm) {
    if (Status status = point.arrive(); !status.ok()) throw StatusError(status);
    ActiveSetMethod method(point, progress, true);
    const Ending ending = method.run(multipliers);
    if (ending.claim != Claim::stalled || method.interrupted()) return ending;
  }
  for (const double barrier : barriers) {
    settings.hand_over_barrier = barrier;
    settings.first_barrier = std::max(settings.first_barrier, barrier);
    BarrierMethod first(point, progress, settings);
    Ending ending = first.run(multipliers);
    if (ending.claim != Claim::optimal) return ending;
    ActiveSetMethod second(point, progress, false);
    ending = second.run(multipliers);
    if (ending.claim != Claim::stalled || second.interrupted()) return ending;
    settings.warm = true;
    settings.first_barrier = barrier;
  }
  settings.hand_over_barrier = 0.0;
  BarrierMethod last(point, progress, settings);
  return last.run(multipliers);
}

}  // namespace bowstring::newton
