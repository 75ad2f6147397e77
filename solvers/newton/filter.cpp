#include "solvers/newton/filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring::newton {

namespace {

constexpr double violation_margin = 1e-5, objective_margin = 1e-8;

/// What rounding leaves of an objective.
double rounding(double objective) noexcept {
  return 10.0 * std::numeric_limits<double>::epsilon() * std::fabs(objective);
}

}  // namespace

void Filter::reset(double largest) {
  largest_ = largest;
  entries_.clear();
}

bool Filter::improves(double violation, double objective, double old_violation, double old_objective) noexcept {
  return violation <= (1.0 - violation_margin) * old_violation ||
         objective <= old_objective - objective_margin * old_violation + rounding(old_objective);
}

bool Filter::accepts(double violation, double objective) const noexcept {
  if (!(violation <= largest_) || !std::isfinite(objective)) return false;
  return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return improves(violation, objective, entry.violation, entry.objective);
  });
}

void Filter::add(double violation, double objective) {
  entries_.erase(
      std::remove_if(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.violation >= violation && entry.objective >= objective; }),
      entries_.end());
  entries_.push_back({violation, objective});
}

}  // namespace bowstring::newton
