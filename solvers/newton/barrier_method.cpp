#include "solvers/newton/barrier_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/newton/restoration.hpp"
#include "solvers/newton/step_length.hpp"
#include "solvers/newton/stopwatch.hpp"

namespace bowstring::newton {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_slack = 1e-2;  // mm, of a row at a cold start
constexpr double bound_push = 1e-2;   // of its size (at least 1): how far inside its bound an unknown starts
// mm and N mm: a scene that begins with large forces needs a barrier that can hold them off the walls.
constexpr double barrier_of_pull = 0.02, most_first_barrier = 2.0;
constexpr double rows_of_first_barrier = 100.0;
constexpr double barrier_factor = 0.05, barrier_power = 1.5;
constexpr double subproblem = 30.0;         // errors of a solved subproblem, in units of the barrier
constexpr double boundary = 0.99;           // share of the way to a bound that a step may go
constexpr double multiplier_spread = 1e10;  // of z s against μ
constexpr int refinements = 3;
// Relative residuals that no further refinement is spent on: of a step, and of a correction.
constexpr double refined = 1e-7, fully_refined = 1e-13;
// A step with a larger residual is none: then shifts of the Hessian, N/mm, growing by a factor.
constexpr double unsolved = 0.5, first_mended = 1e-7, mended_growth = 100.0;
constexpr int most_mended = 4;
// Of the filter's line search.
constexpr double slope_power = 2.3, violation_power = 1.1, armijo = 1e-4, small_violation = 1e-4;
constexpr double negligible_violation = 1e-2;  // of the tolerance
constexpr double shortest_step = 1e-8;
constexpr int most_shortenings = 40;
constexpr int most_shifts = 6;        // of the Hessian, after line searches that found nothing
constexpr double first_retry = 1e-3;  // N/mm
// A motion without curvature, as of a rod that slides along an arc, goes far for next to nothing: where a whole step
// that is to win less than the tolerance (N mm) is refused, a shift of that share of it (N/mm) keeps the motion short.
constexpr double neutral_shift = 1e3, most_neutral_shift = 1e5;
constexpr int patience = 8;           // iterations without progress at the last barrier
constexpr int rows_patience = 25;     // iterations without progress of rows that fail
constexpr double progressing = 0.99;  // of a violation
constexpr double far_apart = 1e-2;    // mm: rows that fail by more have to come closer
constexpr double noticeable = 1e-5;   // mm: rows that fail by so little are left to Newton's steps
constexpr double restored = 0.1;      // of the violation that a restoration begins with
constexpr int most_restorations = 5;

}  // namespace

BarrierMethod::BarrierMethod(Point& point, Progress& progress, const BarrierSettings& settings)
    : point_(point), progress_(progress), settings_(settings), problem_(point.problem()) {}

void BarrierMethod::set_up(Span<const double> start_multipliers) {
  sides_ = sides_of_rows(problem_);
  bounds_ = sides_of_unknowns(problem_);
  equalities_ = equality_rows(problem_);
  row_share_ = std::min(1.0, rows_of_first_barrier / std::max<double>(1.0, static_cast<double>(sides_.size())));
  barrier_ = settings_.first_barrier;
  if (!settings_.warm) {
    const double pull = barrier_of_pull * point_.in_newtons(point_.gradient);
    barrier_ = std::max(barrier_, std::min(pull, most_first_barrier));
  }
  multipliers_.assign(at(problem_.rows()), 0.0);
  if (!start_multipliers.empty()) std::copy(start_multipliers.begin(), start_multipliers.end(), multipliers_.begin());
  fill_slacks(settings_.warm);
  softness_.assign(at(problem_.rows()), 0.0);
  right_a_.resize(at(problem_.unknowns()));
  right_b_.resize(at(problem_.rows()));
  direction_.delta.resize(at(problem_.unknowns()));
  direction_.rows.resize(at(problem_.rows()));
  direction_.slack.resize(sides_.size());
  direction_.force.resize(sides_.size());
  direction_.bound_force.resize(bounds_.size());
  trial_.q.resize(at(problem_.coordinates()));
  trial_.rows.resize(at(problem_.rows()));
}

/// From the point's rows, and where the start is warm from multipliers.
void BarrierMethod::fill_slacks(bool warm) {
  const double mu = barrier_of_row();
  const double floor = warm ? std::sqrt(mu) : least_slack;
  slack_.clear();
  force_.clear();
  for (const Side& side : sides_) {
    const double slack = std::max(-side.violation(point_.rows[at(side.index)]), floor);
    const double given = std::max(0.0, side.sign * multipliers_[at(side.index)]);
    slack_.push_back(slack);
    force_.push_back(warm && given > 0.0 ? std::max(given, mu / slack) : mu / slack);
  }
  read_bounds();
  bound_force_.clear();
  for (const double slack : bound_slack_) bound_force_.push_back(mu / slack);
  combine_multipliers();
}

void BarrierMethod::read_bounds() { read_room(problem_, bounds_, point_.q, unknown_value_, bound_slack_); }

/// Moves unknowns that start on their bound, or beyond, to the inside.
void BarrierMethod::keep_inside() {
  pull_inside(problem_, sides_of_unknowns(problem_), point_.q, [](const Side& side) {
    return std::min(bound_push * std::max(1.0, std::fabs(side.bound)), 0.1 * std::max(std::fabs(side.bound), 1e-3));
  });
}

double BarrierMethod::violation(const std::vector<double>& rows, const std::vector<double>& slack) const noexcept {
  double sum = 0.0;
  for (const int r : equalities_) sum += std::fabs(rows[at(r)] - problem_.row_lower()[at(r)]);
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    sum += std::fabs(sides_[k].violation(rows[at(sides_[k].index)]) + slack[k]);
  }
  return sum;
}

double BarrierMethod::objective(double energy, const std::vector<double>& slack,
                                Span<const double> bound_slack) const noexcept {
  // Products before logarithms: one logarithm for eight numbers of moderate size.
  double sum = 0.0, product = 1.0;
  int held = 0;
  const auto add = [&](double number) {
    product *= number;
    if (++held == 8) {
      sum += std::log(product);
      product = 1.0;
      held = 0;
    }
  };
  for (const double s : slack) add(s);
  for (const double s : bound_slack) add(s);
  return energy - barrier_of_row() * (sum + std::log(product));
}

void BarrierMethod::combine_multipliers() {
  for (const Side& side : sides_) multipliers_[at(side.index)] = 0.0;
  for (std::size_t k = 0; k < sides_.size(); ++k) multipliers_[at(sides_[k].index)] += sides_[k].sign * force_[k];
}

void BarrierMethod::fill_stationarity() {
  point_.lagrangian_gradient(multipliers_, stationarity_);
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    stationarity_[at(bounds_[k].index)] += bounds_[k].sign * bound_force_[k];
  }
}

BarrierMethod::Errors BarrierMethod::errors(double mu) const noexcept {
  Errors out;
  out.stationarity = point_.in_newtons(stationarity_);
  for (const int r : equalities_) {
    out.violation = std::max(out.violation, std::fabs(point_.rows[at(r)] - problem_.row_lower()[at(r)]));
  }
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const double gap = sides_[k].violation(point_.rows[at(sides_[k].index)]);
    out.violation = std::max(out.violation, mu > 0.0 ? std::fabs(gap + slack_[k]) : gap);
    // Of the problem itself the row's own distance counts, as the kernel's certificate measures it.
    const double product = force_[k] * (mu > 0.0 ? slack_[k] : std::fabs(gap));
    out.complementarity = std::max(out.complementarity, std::fabs(product - mu));
  }
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    out.complementarity = std::max(out.complementarity, std::fabs(bound_force_[k] * bound_slack_[k] - mu));
  }
  return out;
}

double BarrierMethod::penetration() const noexcept { return errors(0.0).violation; }

bool BarrierMethod::lower_barrier() {
  const double last = settings_.last_barrier / row_share_;
  if (barrier_ <= last) return false;
  barrier_ = std::max(last, std::min(barrier_factor * barrier_, std::pow(barrier_, barrier_power)));
  return true;
}

bool BarrierMethod::find_direction(double least_shift, Status& failure) {
  failure = point_.find_hessian(multipliers_);
  if (!failure.ok()) return false;
  const double mu = barrier_of_row();
  std::vector<double>& w = point_.hessian;
  const SparsityPattern pattern = problem_.hessian_pattern();
  for (int u = 0; u < problem_.unknowns(); ++u) right_a_[at(u)] = -stationarity_[at(u)];
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const int u = bounds_[k].index;
    w[at(pattern.begin[at(u)])] += bound_force_[k] / bound_slack_[k];
    right_a_[at(u)] -= bounds_[k].sign * (mu / bound_slack_[k] - bound_force_[k]);
  }
  std::fill(right_b_.begin(), right_b_.end(), 0.0);
  for (const int r : equalities_) right_b_[at(r)] = problem_.row_lower()[at(r)] - point_.rows[at(r)];
  // A row with two sides: Σ z/s stands for both.
  for (const Side& side : sides_) softness_[at(side.index)] = 0.0;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const Side& side = sides_[k];
    const double ratio = force_[k] / slack_[k];
    const double gap = side.violation(point_.rows[at(side.index)]) + slack_[k];
    softness_[at(side.index)] += ratio;
    right_b_[at(side.index)] += side.sign * (mu / slack_[k] - force_[k] + ratio * gap);
  }
  int previous = -1;
  for (const Side& side : sides_) {
    if (side.index == previous) continue;
    previous = side.index;
    double& e = softness_[at(side.index)];
    e = 1.0 / e;
    right_b_[at(side.index)] *= -e;
  }
  kkt::KktSystem::Values values;
  values.hessian = w;
  values.jacobian = point_.jacobian;
  values.softness = softness_;
  // Where next to nothing has curvature along a curve (a straight wire without tension) rounding may leave factors of
  // the right inertia that do not solve the system; a little curvature mends them.
  double residual = infinity;
  for (int more = 0; !(residual <= unsolved) && more <= most_mended; ++more) {
    const double least = more == 0 ? least_shift : std::max(first_mended, mended_growth * inertia_.shift());
    if (!inertia_.factor(point_.system(), values, std::max(least, least_shift), progress_.result())) return false;
    residual = solve_system(right_a_, refinements, refined, direction_.delta, direction_.rows);
  }
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const Side& side = sides_[k];
    const double rate = side.sign * point_.row_rate(side.index, direction_.delta);
    const double gap = side.violation(point_.rows[at(side.index)]) + slack_[k];
    direction_.slack[k] = -gap - rate;
    direction_.force[k] = mu / slack_[k] - force_[k] - force_[k] / slack_[k] * direction_.slack[k];
  }
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const double change = -bounds_[k].sign * direction_.delta[at(bounds_[k].index)];
    direction_.bound_force[k] = mu / bound_slack_[k] - bound_force_[k] - bound_force_[k] / bound_slack_[k] * change;
  }
  return true;
}

double BarrierMethod::solve_system(Span<const double> right, int most_refinements, double enough, Span<double> delta,
                                   Span<double> rows) {
  const Stopwatch watch(progress_.result().factorization_seconds);
  return point_.system().solve(right, right_b_, {}, most_refinements, delta, rows, enough);
}

BarrierMethod::Step BarrierMethod::longest_step() const noexcept {
  const double share = std::max(boundary, 1.0 - barrier_);
  Step step{1.0, 1.0};
  const auto limit = [&](double& length, double value, double change) {
    if (change < 0.0) length = std::min(length, -share * value / change);
  };
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    limit(step.primal, slack_[k], direction_.slack[k]);
    limit(step.dual, force_[k], direction_.force[k]);
  }
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    limit(step.primal, bound_slack_[k], -bounds_[k].sign * direction_.delta[at(bounds_[k].index)]);
    limit(step.dual, bound_force_[k], direction_.bound_force[k]);
  }
  return step;
}

double BarrierMethod::slope() const noexcept {
  double sum = 0.0;
  for (int u = 0; u < problem_.unknowns(); ++u) sum += point_.gradient[at(u)] * direction_.delta[at(u)];
  const double mu = barrier_of_row();
  for (std::size_t k = 0; k < sides_.size(); ++k) sum -= mu * direction_.slack[k] / slack_[k];
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    sum += mu * bounds_[k].sign * direction_.delta[at(bounds_[k].index)] / bound_slack_[k];
  }
  return sum;
}

BarrierMethod::Verdict BarrierMethod::try_step(const std::vector<double>& delta, const std::vector<double>& slack,
                                               double step) {
  by_violation_ = false;
  trial_failure_ = {};
  for (std::size_t u = 0; u < scaled_.size(); ++u) scaled_[u] = step * delta[u];
  problem_.retract(point_.q, scaled_, trial_.q);
  trial_failure_ = point_.try_out(trial_.q, trial_.energy, trial_.rows);
  if (!trial_failure_.ok()) return Verdict::no_trial;
  for (std::size_t k = 0; k < sides_.size(); ++k) trial_.slack[k] = slack_[k] + step * slack[k];
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    trial_bound_slack_[k] = bound_slack_[k] - step * bounds_[k].sign * delta[at(bounds_[k].index)];
  }
  const double new_violation = violation(trial_.rows, trial_.slack);
  const double new_objective = objective(trial_.energy, trial_.slack, trial_bound_slack_);
  const bool by_objective = base_.slope < 0.0 &&
                            base_.violation <= small_violation * std::max(1.0, largest_start_violation_) &&
                            step * std::pow(-base_.slope, slope_power) > std::pow(base_.violation, violation_power);
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * std::fabs(base_.objective);
  // Rows that hold to rounding before and after have nothing to win or to lose: the objective alone decides.
  const bool rows_hold =
      std::max(base_.violation, new_violation) <= negligible_violation * progress_.limits().tolerance;
  if (rows_hold && new_objective <= base_.objective + armijo * step * std::min(base_.slope, 0.0) + rounding) {
    return Verdict::accepted;
  }
  const bool enough = by_objective ? new_objective <= base_.objective + armijo * step * base_.slope + rounding
                                   : Filter::improves(new_violation, new_objective, base_.violation, base_.objective);
  if (enough && filter_.accepts(new_violation, new_objective)) {
    if (!by_objective) filter_.add(base_.violation, base_.objective);
    return Verdict::accepted;
  }
  by_violation_ = new_violation >= base_.violation;
  return Verdict::refused;
}

bool BarrierMethod::correct(double step) {
  std::fill(right_b_.begin(), right_b_.end(), 0.0);
  for (const int r : equalities_) right_b_[at(r)] = problem_.row_lower()[at(r)] - trial_.rows[at(r)];
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const Side& side = sides_[k];
    const double off = side.violation(trial_.rows[at(side.index)]) + trial_.slack[k];
    right_b_[at(side.index)] -= softness_[at(side.index)] * side.sign * (force_[k] / slack_[k]) * off;
  }
  const std::vector<double> no_force(at(problem_.unknowns()), 0.0);
  solve_system(no_force, 1, fully_refined, corrected_delta_, correction_rows_);
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const Side& side = sides_[k];
    const double rate = side.sign * point_.row_rate(side.index, corrected_delta_);
    const double off = side.violation(trial_.rows[at(side.index)]) + trial_.slack[k];
    corrected_slack_[k] = step * direction_.slack[k] - off - rate;
    if (!(slack_[k] + corrected_slack_[k] > (1.0 - boundary) * slack_[k])) return false;
  }
  for (std::size_t u = 0; u < corrected_delta_.size(); ++u) corrected_delta_[u] += step * direction_.delta[u];
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const double change = -bounds_[k].sign * corrected_delta_[at(bounds_[k].index)];
    if (!(bound_slack_[k] + change > (1.0 - boundary) * bound_slack_[k])) return false;
  }
  return try_step(corrected_delta_, corrected_slack_, 1.0) == Verdict::accepted;
}

double BarrierMethod::search(double longest) {
  base_ = {violation(point_.rows, slack_), objective(point_.energy, slack_, bound_slack_), slope()};
  scaled_.resize(direction_.delta.size());
  trial_.slack.resize(sides_.size());
  trial_bound_slack_.resize(bounds_.size());
  corrected_delta_.resize(direction_.delta.size());
  corrected_slack_.resize(sides_.size());
  correction_rows_.resize(direction_.rows.size());
  double step = longest;
  bool whole = true;
  neutral_ = false;
  for (int shortenings = 0; shortenings < most_shortenings && step > shortest_step; ++shortenings) {
    const Verdict verdict = try_step(direction_.delta, direction_.slack, step);
    if (verdict == Verdict::accepted) return step;
    if (verdict == Verdict::refused && whole && by_violation_ && correct(step)) return step;
    if (verdict == Verdict::refused && whole && step == 1.0 && -base_.slope < progress_.limits().tolerance &&
        base_.violation > 0.0 && inertia_.shift() < progress_.limits().tolerance * most_neutral_shift) {
      neutral_ = true;
      return 0.0;
    }
    whole = false;
    step = verdict == Verdict::no_trial ? shortened(step, trial_failure_, problem_) : 0.5 * step;
  }
  return 0.0;
}

bool BarrierMethod::take(double primal, double dual, Ending& ending) {
  point_.q.swap(trial_.q);
  if (Status status = point_.arrive(); !status.ok()) {
    point_.q.swap(trial_.q);
    ending = {Claim::failed, status.text.empty() ? "an accepted point could not be evaluated" : status.text};
    return false;
  }
  slack_.swap(trial_.slack);
  const double mu = barrier_of_row();
  const auto keep_near_path = [&](double& force, double slack) {
    force = std::clamp(force, mu / (multiplier_spread * slack), multiplier_spread * mu / slack);
  };
  for (const int r : equalities_) multipliers_[at(r)] += primal * direction_.rows[at(r)];
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    force_[k] += dual * direction_.force[k];
    keep_near_path(force_[k], slack_[k]);
  }
  read_bounds();
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    bound_force_[k] += dual * direction_.bound_force[k];
    keep_near_path(bound_force_[k], bound_slack_[k]);
  }
  combine_multipliers();
  return true;
}

bool BarrierMethod::restore(const std::string& why, Ending& ending) {
  const double tolerance = progress_.limits().tolerance;
  if (!(penetration() > noticeable)) {
    const std::string rows = failing_rows(problem_, point_.rows, tolerance);
    ending = {Claim::stalled, why + (rows.empty() ? "" : "; " + rows)};
    return false;
  }
  if (restorations_ == most_restorations) {
    ending = {Claim::stalled, why + ", though the rows have been brought together " + std::to_string(restorations_) +
                                  " times; " + failing_rows(problem_, point_.rows, tolerance)};
    return false;
  }
  ++restorations_;
  double sum = 0.0;
  for (int r = 0; r < problem_.rows(); ++r) sum += newton::violation(problem_, point_.rows, r);
  Restoration restoration(point_, progress_);
  const Ending found = restoration.run(restored * sum, multipliers_);
  if (found.claim != Claim::optimal) {
    ending = found.claim == Claim::stalled && progress_.reason().empty()
                 ? Ending{found.claim, why + ": " + found.reason}
                 : found;
    return false;
  }
  point_.analyse_again();
  inertia_ = {};
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  barrier_ = std::max(barrier_, settings_.first_barrier);
  fill_slacks(false);
  fill_stationarity();
  filter_.reset(std::max(least_slack, 10.0 * violation(point_.rows, slack_)));
  return true;
}

Ending BarrierMethod::run(std::vector<double>& multipliers) {
  const auto finish = [&](Ending ending) {
    multipliers = multipliers_;
    // What is stuck while it grows has no bound to come to.
    std::string reason;
    const bool stuck = ending.claim == Claim::stalled && progress_.reason().empty();
    if (stuck && growth_.unbounded(problem_, point_.q, point_.energy, reason, true)) {
      ending = {Claim::diverged, reason + "; there " + ending.reason};
    }
    return ending;
  };
  keep_inside();
  Status status = point_.arrive();
  if (!status.ok())
    return {status.code == Code::failed ? Claim::failed : Claim::stalled,
            "the start cannot be evaluated: " + status.text};
  set_up(multipliers);
  largest_start_violation_ = violation(point_.rows, slack_);
  filter_.reset(1e4 * std::max(1.0, largest_start_violation_));
  fill_stationarity();

  const Limits& limits = progress_.limits();
  const double target = std::max(limits.tolerance, problem_.rounding_floor());
  growth_.start(problem_, point_.q, point_.energy);
  double best = infinity, least_violation = infinity;
  int waited = 0, waited_for_rows = 0;
  std::vector<double> best_q, best_multipliers;
  const auto finish_at_best = [&](const std::string& reason) {
    if (!best_q.empty()) {
      point_.q = best_q;
      multipliers_ = best_multipliers;
    }
    return finish({Claim::stalled, reason});
  };
  double step = 0.0;
  for (;;) {
    Errors of_problem = errors(0.0);
    if (!progress_.record(point_.energy, of_problem.stationarity, of_problem.violation, step)) {
      return finish_at_best(progress_.reason());
    }
    if (std::string reason; growth_.unbounded(problem_, point_.q, point_.energy, reason)) {
      return finish({Claim::diverged, reason});
    }
    const bool last_barrier = barrier_ <= settings_.last_barrier / row_share_;
    if (last_barrier && of_problem.stationarity <= target && of_problem.violation <= limits.tolerance &&
        of_problem.complementarity <= limits.tolerance) {
      return finish({Claim::optimal, "the first-order conditions hold to the tolerance"});
    }
    if (last_barrier) {
      const double worst = std::max({of_problem.stationarity / target, of_problem.violation / limits.tolerance,
                                     of_problem.complementarity / limits.tolerance});
      waited = worst < 0.5 * best ? 0 : waited + 1;
      if (worst < best) {
        best = worst;
        best_q = point_.q;
        best_multipliers = multipliers_;
      }
      if (waited >= patience) return finish_at_best("nothing improves any more");
    }
    // Solved subproblems lower the barrier, several times where the point allows it.
    for (;;) {
      const double mu = barrier_of_row();
      const Errors now = errors(mu);
      if (std::max(now.stationarity, now.violation) > subproblem * barrier_) break;
      if (now.complementarity > subproblem * mu) break;
      if (settings_.hand_over_barrier > 0.0 && barrier_ <= settings_.hand_over_barrier) {
        return finish({Claim::optimal, "handed over"});
      }
      if (!lower_barrier()) break;
      filter_.reset(1e4 * std::max(1.0, largest_start_violation_));
    }

    Ending ending;
    waited_for_rows = of_problem.violation > far_apart && !(of_problem.violation < progressing * least_violation)
                          ? waited_for_rows + 1
                          : 0;
    if (waited_for_rows == 0) least_violation = of_problem.violation;
    if (waited_for_rows > rows_patience) {
      if (!restore("rows that fail come no closer", ending)) return finish(ending);
      best = least_violation = infinity;
      best_q.clear();
      waited_for_rows = 0;
      continue;
    }
    double length = 0.0;
    Step longest;
    std::string why = "no step improves the point";
    bool renewed = false;
    for (int shifts = 0; shifts <= most_shifts && length == 0.0; ++shifts) {
      const double least_shift =
          shifts == 0 ? 0.0
                      : std::max(neutral_ ? neutral_shift * limits.tolerance : first_retry, 10.0 * inertia_.shift());
      trial_failure_ = {};
      if (!find_direction(least_shift, status)) {
        if (!status.ok()) return finish({Claim::failed, status.text});
        if (!renewed) {
          // What was eliminated where it stands may no longer be what moves its rows.
          renewed = true;
          point_.analyse_again();
          --shifts;
          continue;
        }
        const int row = inertia_.outcome().singular_row;
        why =
            row < 0 ? "no shift of the Hessian gives usable factors" : row_name(problem_, row) + " contradicts others";
        break;
      }
      longest = longest_step();
      length = search(longest.primal);
    }
    if (length == 0.0) {
      if (trial_failure_.code == Code::failed) return finish({Claim::failed, trial_failure_.text});
      if (trial_failure_.code == Code::refused) why = "every trial step was refused, however short";
      if (!restore(why, ending)) return finish(ending);
      best = least_violation = infinity;
      best_q.clear();
      step = 0.0;
      continue;
    }
    if (!take(length, longest.dual, ending)) return finish(ending);
    fill_stationarity();
    step = length;
  }
}

}  // namespace bowstring::newton
