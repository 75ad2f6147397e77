#include "solvers/newton/active_set_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/newton/stopwatch.hpp"

namespace bowstring::newton {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double infinity = std::numeric_limits<double>::infinity();
// An active row gives way by its softness times the change of its force: a proximal step in the multipliers, which
// keeps rows apart that say nearly the same (a chord's and its nodes'), and whose error vanishes with the change. mm/N
constexpr double first_softness = 1e-5, softening = 0.1, last_softness = 1e-8;
constexpr double activity = 1.0;  // N/mm: a row is taken as active where its force exceeds that times its distance
constexpr int few_changes = 2;
constexpr double few_of_rows = 0.005;
constexpr int most_changes_of_set = 6;  // at one point
constexpr int refinements = 6;
constexpr double refined = 1e-7;  // relative residual that no further refinement is spent on
// Times the tolerance, and times the error before: then the last factors serve for one more step.
constexpr double near_enough = 30.0, fast_enough = 1e-2;
constexpr int patience = 3, patience_when_hasty = 7;  // steps that may pass without smaller errors
constexpr double bound_share = 0.9;                   // of the way to a bound of an unknown
constexpr double shortest_step = 1e-3;
constexpr double pull = 1e-12;  // N: a predicted force so small may stay

}  // namespace

ActiveSetMethod::ActiveSetMethod(Point& point, Progress& progress, bool hasty)
    : point_(point), progress_(progress), problem_(point.problem()), hasty_(hasty) {
  sides_ = sides_of_rows(problem_);
  bounds_ = sides_of_unknowns(problem_);
  equalities_ = equality_rows(problem_);
  active_.assign(sides_.size(), 0);
  softness_.assign(at(problem_.rows()), infinity);
  right_a_.resize(at(problem_.unknowns()));
  right_b_.resize(at(problem_.rows()));
  delta_.resize(at(problem_.unknowns()));
  change_.resize(at(problem_.rows()));
  trial_q_.resize(at(problem_.coordinates()));
  trial_rows_.resize(at(problem_.rows()));
}

void ActiveSetMethod::choose_active(const std::vector<double>& multipliers) {
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const double force = sides_[k].sign * multipliers[at(sides_[k].index)];
    const double distance = -sides_[k].violation(point_.rows[at(sides_[k].index)]);
    active_[k] = force > 0.0 && force > activity * distance ? 1 : 0;
  }
}

void ActiveSetMethod::keep_active_forces(std::vector<double>& multipliers) const {
  std::vector<char> carries(multipliers.size(), 0);
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    if (active_[k] != 0) carries[at(sides_[k].index)] = 1;
  }
  for (const Side& side : sides_) {
    if (carries[at(side.index)] == 0) multipliers[at(side.index)] = 0.0;
  }
}

ActiveSetMethod::Errors ActiveSetMethod::errors(const std::vector<double>& multipliers) {
  Errors out;
  point_.lagrangian_gradient(multipliers, stationarity_);
  out.stationarity = point_.in_newtons(stationarity_);
  for (const int r : equalities_) {
    out.violation = std::max(out.violation, std::fabs(point_.rows[at(r)] - problem_.row_lower()[at(r)]));
  }
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const double gap = sides_[k].violation(point_.rows[at(sides_[k].index)]);
    const double force = sides_[k].sign * multipliers[at(sides_[k].index)];
    out.violation = std::max(out.violation, gap);
    if (active_[k] == 0) continue;
    out.complementarity = std::max({out.complementarity, std::fabs(force * gap), -force});
  }
  return out;
}

bool ActiveSetMethod::solve(const std::vector<double>& multipliers) {
  const double softness = std::max(last_softness, first_softness * std::pow(softening, steps_));
  for (const Side& side : sides_) softness_[at(side.index)] = infinity;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    if (active_[k] != 0) softness_[at(sides_[k].index)] = softness;
  }
  kkt::KktSystem::Values values;
  values.hessian = point_.hessian;
  values.jacobian = point_.jacobian;
  values.softness = softness_;
  kkt::KktSystem::Outcome outcome;
  {
    const Stopwatch watch(progress_.result().factorization_seconds);
    outcome = point_.system().factor(values);
  }
  ++progress_.result().factorizations;
  if (!outcome.exists || outcome.saddle_directions != 0) return false;
  solve_again(multipliers, refinements);
  return true;
}

/// With the last factors.
void ActiveSetMethod::solve_again(const std::vector<double>& multipliers, int most_refinements) {
  const Stopwatch watch(progress_.result().factorization_seconds);
  std::fill(right_b_.begin(), right_b_.end(), 0.0);
  for (const int r : equalities_) right_b_[at(r)] = problem_.row_lower()[at(r)] - point_.rows[at(r)];
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    if (active_[k] != 0) right_b_[at(sides_[k].index)] = sides_[k].bound - point_.rows[at(sides_[k].index)];
  }
  point_.lagrangian_gradient(multipliers, stationarity_);
  for (std::size_t u = 0; u < right_a_.size(); ++u) right_a_[u] = -stationarity_[u];
  point_.system().solve(right_a_, right_b_, {}, most_refinements, delta_, change_, refined);
}

/// Rows whose predicted force pulls leave, rows whose predicted gap is positive enter. Returns how many did.
int ActiveSetMethod::update_active(const std::vector<double>& multipliers) {
  const double tolerance = 0.1 * progress_.limits().tolerance;
  int changes = 0;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const Side& side = sides_[k];
    if (active_[k] != 0) {
      if (side.sign * (multipliers[at(side.index)] + change_[at(side.index)]) >= -pull) continue;
      active_[k] = 0;
    } else {
      const double gap = side.violation(point_.rows[at(side.index)]);
      if (gap + side.sign * point_.row_rate(side.index, delta_) <= tolerance) continue;
      active_[k] = 1;
    }
    ++changes;
  }
  return changes;
}

bool ActiveSetMethod::direction(std::vector<double>& multipliers) {
  const int share = static_cast<int>(few_of_rows * static_cast<double>(sides_.size()));
  const int few = hasty_ ? std::max(few_changes, share) : 0;
  for (int k = 0; k <= most_changes_of_set; ++k) {
    keep_active_forces(multipliers);
    if (!solve(multipliers)) return false;
    changes_ = update_active(multipliers);
    if (changes_ <= few) break;
  }
  return true;
}

double ActiveSetMethod::longest_step() const {
  double longest = 1.0;
  std::vector<double> values, room;
  read_room(problem_, bounds_, point_.q, values, room);
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const double rate = bounds_[k].sign * delta_[at(bounds_[k].index)];
    if (rate > 0.0) longest = std::min(longest, bound_share * std::max(room[k], 0.0) / rate);
  }
  return longest;
}

/// Takes the step as far as bounds and the guard let it.
bool ActiveSetMethod::step(std::vector<double>& multipliers, double& length) {
  std::vector<double> scaled(delta_.size());
  length = longest_step();
  while (length > shortest_step) {
    for (std::size_t u = 0; u < scaled.size(); ++u) scaled[u] = length * delta_[u];
    problem_.retract(point_.q, scaled, trial_q_);
    double energy = 0.0;
    const Status status = point_.try_out(trial_q_, energy, trial_rows_);
    if (status.ok()) break;
    length *= 0.5;
  }
  if (!(length > shortest_step)) return false;
  point_.q.swap(trial_q_);
  for (std::size_t r = 0; r < multipliers.size(); ++r) multipliers[r] += length * change_[r];
  return true;
}

Ending ActiveSetMethod::run(std::vector<double>& multipliers) {
  const std::vector<double> start_q = point_.q, start_multipliers = multipliers;
  const auto give_up = [&](const char* reason) -> Ending {
    point_.q = start_q;
    multipliers = start_multipliers;
    if (!point_.arrive().ok()) return {Claim::failed, "the start could not be evaluated again"};
    return {Claim::stalled, reason};
  };
  const Limits& limits = progress_.limits();
  const double target = std::max(limits.tolerance, problem_.rounding_floor());
  multipliers.resize(at(problem_.rows()), 0.0);
  choose_active(multipliers);
  keep_active_forces(multipliers);
  double best = infinity, before = infinity, length = 0.0;
  int waited = 0;
  bool factors_fit = false;
  for (bool settled = false;;) {
    const Errors now = errors(multipliers);
    if (!progress_.record(point_.energy, now.stationarity, now.violation, length)) {
      interrupted_ = true;
      return {Claim::stalled, progress_.reason()};
    }
    if (settled && now.stationarity <= target && now.violation <= limits.tolerance &&
        now.complementarity <= limits.tolerance) {
      return {Claim::optimal, "the first-order conditions hold to the tolerance"};
    }
    const double worst = std::max(now.stationarity / target, now.violation / limits.tolerance);
    waited = worst < 0.5 * best ? 0 : waited + 1;
    best = std::min(best, worst);
    if (waited > (hasty_ ? patience_when_hasty : patience)) return give_up("errors do not fall");
    // Near the solution the last factors serve once more (a simplified Newton step).
    const bool again = factors_fit && settled && worst < near_enough && worst < fast_enough * before;
    before = worst;
    if (again) {
      solve_again(multipliers, 1);
      changes_ = update_active(multipliers);
      factors_fit = false;
    } else {
      if (!point_.find_hessian(multipliers).ok()) return give_up("the Hessian could not be evaluated");
      if (!direction(multipliers)) return give_up("curvature is negative on the active rows");
      factors_fit = true;
    }
    if (!step(multipliers, length)) return give_up("the step guard stopped the step");
    bool new_epoch = false;
    if (!point_.arrive(&new_epoch).ok()) return give_up("an accepted point could not be evaluated");
    if (new_epoch) factors_fit = false;
    settled = length == 1.0 && changes_ == 0;
    ++steps_;
  }
}

}  // namespace bowstring::newton
