#include "solvers/trust-region/method.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "plugins/sdk/guard.hpp"
#include "solvers/newton/step_length.hpp"

namespace bowstring::trust_region {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double first_share = 0.05;      // of the scene's length: the first radius
constexpr double smallest_share = 1e-13;  // of it: no step is found
constexpr double normal_share = 0.8;      // of the radius that the normal step may take
constexpr double boundary = 0.9;          // share of the way to a bound that a step may go
constexpr double held = 1e-6;             // of a step: it goes nowhere
constexpr double bound_push = 1e-2;       // of a bound's size: how far inside an unknown starts
constexpr double least_ratio = 1e-2, poor_ratio = 0.25, good_ratio = 0.75, excellent_ratio = 0.95;
constexpr double largest_violation_share = 0.2;  // of the scene's length, summed over rows
constexpr double switching = 1e-4;               // N/mm: decrease against violation²
constexpr double rounding_steps = 100.0;         // what sums leave of an energy, in units of its last place
constexpr double newton_share = 1e-6;            // of the energy: a decrease so small may be lost in it
constexpr double hopeless = 1e-10;               // of the violation: what is no decrease of it
constexpr double little = 1e-3;                  // the same, where no step was found either
constexpr double far = 100.0;                    // lengths of the scene, to where rows are linearly satisfied
constexpr double sign_share = 1e-5;              // of the target: a gradient that is none
constexpr int corrections = 2;
constexpr double longest_correction = 0.5;  // of its step: beyond it another way back is tried
constexpr double noticed = 0.99;            // of a violation: less is progress
constexpr int restoring_patience = 40;      // iterations without it
constexpr int polishing = 2;                // iterations for rows that hold to the tolerance
constexpr int patience = 10;                // iterations without progress next to the targets

double dot(Span<const double> a, Span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char out[400];
  std::snprintf(out, sizeof out, format, numbers...);
  return out;
}

}  // namespace

Method::Method(newton::Point& point, newton::Progress& progress, const Settings& settings)
    : point_(point),
      progress_(progress),
      settings_(settings),
      problem_(point.problem()),
      normal_(point, metric_, progress.result()),
      subproblem_(point, metric_, progress.result()) {}

void Method::pull_inside_bounds() {
  newton::pull_inside(problem_, bounds_, point_.q,
                      [](const newton::Side& side) { return bound_push * std::max(1e-3, std::fabs(side.bound)); });
}

Status Method::begin(std::vector<double>& multipliers) {
  const std::size_t n = at(problem_.unknowns()), m = at(problem_.rows());
  unknown_value_.resize(n);
  bounds_ = newton::sides_of_unknowns(problem_);
  pull_inside_bounds();
  if (Status status = point_.arrive(); !status.ok()) return status;
  metric_.set_up(problem_, point_.q);
  normal_.analyse();
  subproblem_.analyse();
  radius_ = settings_.first_radius > 0.0 ? settings_.first_radius : first_share * metric_.length();
  start_energy_ = point_.energy;
  growth_.start(problem_, point_.q, point_.energy);
  target_ = std::max(progress_.limits().tolerance, problem_.rounding_floor());
  filter_.reset(std::max(largest_violation_share * metric_.length(), 1.1 * violation(point_.rows)));
  newton_multipliers_ = multipliers.size() == m ? multipliers : std::vector<double>();
  multipliers_.assign(m, 0.0);
  right_.resize(n);
  wanted_rows_.resize(m);
  trial_.q.resize(point_.q.size());
  trial_.rows.resize(m);
  corrected_ = trial_;
  return {};
}

double Method::violation(const std::vector<double>& rows) const noexcept {
  double sum = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) sum += std::fabs(rows[r] - problem_.row_lower()[r]);
  return sum;
}

double Method::largest_violation() const noexcept {
  double largest = 0.0;
  for (std::size_t r = 0; r < point_.rows.size(); ++r) {
    largest = std::max(largest, std::fabs(point_.rows[r] - problem_.row_lower()[r]));
  }
  return largest;
}

void Method::judge() {
  normal_.multipliers(multipliers_);
  point_.lagrangian_gradient(multipliers_, residual_);
  stationarity_ = point_.in_newtons(residual_);
  if (newton_multipliers_.size() == multipliers_.size() && !multipliers_.empty()) {
    point_.lagrangian_gradient(newton_multipliers_, right_);
    const double other = point_.in_newtons(right_);
    if (other < stationarity_ || !std::isfinite(stationarity_)) {
      stationarity_ = other;
      multipliers_ = newton_multipliers_;
    }
  }
  violation_ = largest_violation();
}

double Method::energy_of_rows() const noexcept {
  double sum = 0.0;
  for (std::size_t r = 0; r < multipliers_.size(); ++r) {
    sum += std::fabs(multipliers_[r] * (point_.rows[r] - problem_.row_lower()[r]));
  }
  return sum;
}

bool Method::errors_within_targets() const noexcept {
  return stationarity_ <= target_ && violation_ <= progress_.limits().tolerance;
}

double Method::worst_error() const noexcept {
  return std::max(stationarity_ / target_, violation_ / progress_.limits().tolerance);
}

/// The step that the region allows; false: there is none.
bool Method::compose(Step& step) {
  const double normal = metric_.norm(normal_delta_);
  step = {};
  if (normal > normal_share * radius_) {
    step.share = step.fraction = normal_share * radius_ / normal;
    step.restoring = true;
    step.delta = normal_delta_;
    for (double& number : step.delta) number *= step.share;
  } else {
    const SparsityPattern pattern = problem_.hessian_pattern();
    for (std::size_t u = 0; u < right_.size(); ++u) right_[u] = -point_.gradient[u];
    for (std::size_t j = 0; j < right_.size(); ++j) {
      for (int k = pattern.begin[j]; k < pattern.begin[j + 1]; ++k) {
        const std::size_t i = at(pattern.inner[at(k)]);
        right_[i] -= point_.hessian[at(k)] * normal_delta_[j];
        if (i != j) right_[j] -= point_.hessian[at(k)] * normal_delta_[i];
      }
    }
    const double radius = std::sqrt(radius_ * radius_ - normal * normal);
    double least_gradient = 0.0;
    for (const double scale : problem_.stationarity_scale()) least_gradient += scale;
    least_gradient *= sign_share * target_;
    const Subproblem::Answer answer =
        subproblem_.minimise(right_, radius, least_gradient, tangential_, newton_multipliers_);
    if (!answer.found) return false;
    step.newton = answer.interior;
    const double tangential = metric_.norm(tangential_);
    step.fraction = answer.interior ? 1.0 : std::min(1.0, tangential / answer.full_norm);
    step.delta = normal_delta_;
    for (std::size_t u = 0; u < step.delta.size(); ++u) step.delta[u] += tangential_[u];
  }
  keep_bounds(step);
  step.norm = metric_.norm(step.delta);
  held_by_bound_ = step.bound_share;
  // q(δ) = ∇Eᵀδ + ½ δᵀWδ.
  double curved = 0.0;
  const SparsityPattern pattern = problem_.hessian_pattern();
  for (std::size_t j = 0; j < step.delta.size(); ++j) {
    for (int k = pattern.begin[j]; k < pattern.begin[j + 1]; ++k) {
      const std::size_t i = at(pattern.inner[at(k)]);
      curved += (i == j ? 0.5 : 1.0) * point_.hessian[at(k)] * step.delta[i] * step.delta[j];
    }
  }
  step.decrease = -(dot(point_.gradient, step.delta) + curved);
  return std::isfinite(step.decrease) && std::isfinite(step.norm);
}

void Method::keep_bounds(Step& step) {
  if (bounds_.empty()) return;
  std::vector<double>& value = unknown_value_;
  problem_.values(point_.q, value);
  double share = 1.0;
  for (const newton::Side& side : bounds_) {
    const double change = side.sign * step.delta[at(side.index)];
    const double slack = -side.violation(value[at(side.index)]);
    if (!(share * change > boundary * slack)) continue;
    share = boundary * std::max(0.0, slack) / change;
    holding_unknown_ = side.index;
  }
  if (share == 1.0) return;
  for (double& number : step.delta) number *= share;
  step.bound_share = share;
  step.share *= share;
  step.fraction *= share;
  step.newton = false;
}

bool Method::within_bounds(const std::vector<double>& q) const {
  if (bounds_.empty()) return true;
  std::vector<double> value(at(problem_.unknowns()));
  problem_.values(q, value);
  return std::all_of(bounds_.begin(), bounds_.end(),
                     [&](const newton::Side& side) { return side.violation(value[at(side.index)]) < 0.0; });
}

void Method::correct(const Step& step) {
  std::vector<double> delta = step.delta, off(at(problem_.rows()));
  const std::vector<double> no_force(at(problem_.unknowns()), 0.0);
  for (int r = 0; r < problem_.rows(); ++r) {
    wanted_rows_[at(r)] =
        step.share < 1.0 ? point_.rows[at(r)] + point_.row_rate(r, step.delta) : problem_.row_lower()[at(r)];
  }
  const auto misses = [&](const std::vector<double>& rows, double& largest) {
    double sum = 0.0;
    largest = 0.0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      off[r] = wanted_rows_[r] - rows[r];
      sum += std::fabs(off[r]);
      largest = std::max(largest, std::fabs(off[r]));
    }
    return sum;
  };
  double largest = 0.0;
  double missed = misses(trial_.rows, largest);
  for (int k = 0; k < corrections && largest > 0.1 * progress_.limits().tolerance; ++k) {
    // The way back of the step's own factors; where curvature that has just been shifted away makes that a long one,
    // the normal step's.
    if (!step.restoring) subproblem_.solve(no_force, off, back_, back_multipliers_);
    if (step.restoring || !(metric_.norm(back_) <= longest_correction * step.norm)) {
      normal_.solve(no_force, off, back_, back_multipliers_);
    }
    if (!(metric_.norm(back_) <= step.norm)) return;
    for (std::size_t u = 0; u < delta.size(); ++u) delta[u] += back_[u];
    problem_.retract(point_.q, delta, corrected_.q);
    if (!within_bounds(corrected_.q)) return;
    if (!point_.try_out(corrected_.q, corrected_.energy, corrected_.rows).ok()) return;
    if (!std::isfinite(corrected_.energy)) return;
    const double now = misses(corrected_.rows, largest);
    if (!(now < missed)) return;
    corrected_.violation = violation(corrected_.rows);
    std::swap(trial_, corrected_);
    if (now > 0.5 * missed) return;
    missed = now;
  }
}

bool Method::acceptable(const Step& step) {
  const double here = violation(point_.rows);
  if (step.restoring) {
    const double predicted = here - normal_.left(step.delta), won = here - trial_.violation;
    if (!(won > least_ratio * predicted) || !(won > 0.0)) return false;
    filter_.add(here, point_.energy);
    const double ratio = predicted > 0.0 ? won / predicted : 1.0;
    if (ratio < poor_ratio) radius_ = 0.5 * step.norm;
    if (ratio > good_ratio) radius_ = std::max(radius_, 2.0 * step.norm);
    return true;
  }
  if (!filter_.accepts(trial_.violation, trial_.energy)) return false;
  const double won = point_.energy - trial_.energy;
  if (step.decrease > 0.0 && step.decrease >= switching * here * here) {
    const double ratio = won / step.decrease;
    if (!(ratio >= least_ratio)) return false;
    if (ratio < poor_ratio) radius_ = 0.5 * step.norm;
    if (ratio > good_ratio && !step.newton) {
      radius_ = std::max(radius_, (ratio > excellent_ratio ? 3.0 : 2.0) * step.norm);
    }
    return true;
  }
  if (!newton::Filter::improves(trial_.violation, trial_.energy, here, point_.energy)) return false;
  filter_.add(here, point_.energy);
  if (!step.newton && trial_.violation < 0.5 * here) radius_ = std::max(radius_, 2.0 * step.norm);
  return true;
}

bool Method::improves_errors() {
  const double before = worst_error(), stationarity = stationarity_, largest = violation_, energy = point_.energy;
  const std::vector<double> q = point_.q, gradient = point_.gradient, rows = point_.rows, jacobian = point_.jacobian;
  const std::vector<double> multipliers = multipliers_;
  point_.q = trial_.q;
  if (point_.expand().ok()) {
    point_.lagrangian_gradient(newton_multipliers_, residual_);
    stationarity_ = point_.in_newtons(residual_);
    violation_ = largest_violation();
    if (worst_error() <= 0.5 * before) {
      trial_.energy = point_.energy;
      return true;
    }
  }
  point_.q = q, point_.gradient = gradient, point_.rows = rows, point_.jacobian = jacobian, point_.energy = energy;
  stationarity_ = stationarity, violation_ = largest, multipliers_ = multipliers;
  return false;
}

Method::Verdict Method::try_step(Step& step) {
  problem_.retract(point_.q, step.delta, trial_.q);
  const Status status = point_.try_out(trial_.q, trial_.energy, trial_.rows);
  if (status.code == Code::interrupted || status.code == Code::unsupported || status.code == Code::invalid_input) {
    throw StatusError(status);
  }
  if (!status.ok() || !std::isfinite(trial_.energy)) {
    trial_failure_ = status.code == Code::failed ? status.text : "";
    radius_ = newton::shortened(std::min(radius_, step.norm), status, problem_);
    return Verdict::shorten;
  }
  trials_refused_ = false;
  trial_failure_.clear();
  trial_.violation = violation(trial_.rows);
  correct(step);
  if (acceptable(step)) return Verdict::accepted;
  const double energy = std::max(std::fabs(point_.energy), std::fabs(start_energy_));
  const double noise = rounding_steps * std::numeric_limits<double>::epsilon() * energy;
  if (!step.restoring && step.decrease <= std::max(noise, newton_share * energy)) {
    if (step.newton && improves_errors()) return Verdict::accepted;
    if (step.decrease <= noise && violation_ <= progress_.limits().tolerance) return Verdict::rounding;
  }
  radius_ = 0.3 * std::min(radius_, step.norm);
  return Verdict::shorten;
}

Status Method::take() {
  point_.q.swap(trial_.q);
  bool new_epoch = false;
  Status status = point_.arrive(&new_epoch);
  if (!status.ok() || !new_epoch) return status;
  normal_.analyse();
  subproblem_.analyse();
  filter_.reset(std::max(largest_violation_share * metric_.length(), 1.1 * violation(point_.rows)));
  return status;
}

/// N/mm: a curvature so small changes no force by more than the tolerance over 1 mm, and counts as none.
double Method::least_curvature() const noexcept {
  return static_cast<double>(problem_.unknowns()) * progress_.limits().tolerance;
}

newton::Ending Method::at_stationary_point(bool& go_on) {
  go_on = false;
  int negative = 0;
  if (subproblem_.positive(0.0, negative)) {
    return {Claim::optimal,
            "the first-order conditions hold to the tolerance, and the curvature is positive in every "
            "direction that the rows leave"};
  }
  const double least = least_curvature();
  int below = 0;
  if (subproblem_.positive(least, below)) {
    return {Claim::optimal,
            text("the first-order conditions hold to the tolerance, and no curvature is below -%.1e N/mm", least)};
  }
  if (settings_.leave_saddles) {
    go_on = leaving_saddle_ = true;
    return {};
  }
  const Leftmost leftmost = subproblem_.leftmost();
  return {Claim::optimal,
          text("the first-order conditions hold to the tolerance at a saddle: %d direction%s of negative "
               "curvature, the leftmost %.6g N/mm for a displacement of 1 mm rms over all unknowns",
               negative > 0 ? negative : below, (negative > 0 ? negative : below) == 1 ? "" : "s",
               leftmost.known ? leftmost.curvature : 0.0)};
}

newton::Ending Method::infeasible(const char* why) const {
  return {Claim::infeasible, std::string("the rows cannot hold together: ") + why + "; " +
                                 newton::failing_rows(problem_, point_.rows, progress_.limits().tolerance)};
}

newton::Ending Method::without_step() const {
  if (held_by_bound_ < held) {
    return {Claim::stalled,
            text("a bound on an unknown, an edge's or a wire's length, holds every step back: unknown %d is "
                 "%.6g; stationarity %.2e N, rows to %.2e mm",
                 holding_unknown_, unknown_value_[at(holding_unknown_)], stationarity_, violation_)};
  }
  if (!trial_failure_.empty()) return {Claim::failed, trial_failure_};
  if (trials_refused_) return {Claim::stalled, "every trial step was refused, however short"};
  std::string reason =
      text("no step improves the point: stationarity %.2e N, rows to %.2e mm", stationarity_, violation_);
  if (violation_ > progress_.limits().tolerance) {
    const double here = violation(point_.rows), left = normal_.left(normal_delta_);
    if (!(here - left > little * here) || metric_.norm(normal_delta_) > far * metric_.length()) {
      return infeasible("no step brings them closer");
    }
    reason += "; " + newton::failing_rows(problem_, point_.rows, progress_.limits().tolerance);
  }
  if (leaving_saddle_) reason += "; it is a saddle";
  return {Claim::stalled, reason};
}

newton::Ending Method::run(std::vector<double>& multipliers) {
  const auto finish = [&](newton::Ending ending) {
    multipliers = multipliers_;
    return ending;
  };
  Status status = begin(multipliers);
  if (!status.ok()) {
    multipliers_ = multipliers;
    return finish({status.code == Code::failed ? Claim::failed : Claim::stalled,
                   "the start cannot be evaluated: " + status.text});
  }
  const double smallest = smallest_share * metric_.length();
  double fraction = 0.0, best = std::numeric_limits<double>::infinity();
  double least_violation = std::numeric_limits<double>::infinity();
  int waited = 0, polished = 0, unrestored = 0;
  for (;;) {
    bool usable = false;
    status = normal_.factor(usable);
    if (!status.ok()) return finish({Claim::failed, status.text});
    if (!usable) {
      return finish({Claim::stalled, "the rows' Jacobian has no usable factors; " +
                                         newton::failing_rows(problem_, point_.rows, progress_.limits().tolerance)});
    }
    judge();
    if (!progress_.record(point_.energy, stationarity_, violation_, fraction)) {
      return finish({Claim::stalled, progress_.reason()});
    }
    if (std::string reason; growth_.unbounded(problem_, point_.q, point_.energy, reason))
      return finish({Claim::diverged, reason});
    status = point_.find_hessian(multipliers_);
    if (!status.ok()) return finish({Claim::failed, status.text});
    // Rows within the tolerance may still cost an energy that is not: Newton's steps soon mend that.
    const bool settled = polished >= polishing || energy_of_rows() <= progress_.limits().tolerance;
    if (errors_within_targets() && !settled) ++polished;
    if (errors_within_targets() && settled) {
      bool go_on = false;
      const newton::Ending ending = at_stationary_point(go_on);
      if (!go_on) return finish(ending);
    } else if (!errors_within_targets()) {
      leaving_saddle_ = false;
      polished = 0;
    }
    if (worst_error() < 1e3 && !leaving_saddle_) {
      waited = worst_error() < 0.5 * best ? 0 : waited + 1;
      best = std::min(best, worst_error());
      if (waited >= patience) return finish({Claim::stalled, "nothing improves any more"});
    } else {
      waited = 0;
      best = std::numeric_limits<double>::infinity();
    }
    normal_.step(normal_delta_);
    if (violation_ <= progress_.limits().tolerance || violation(point_.rows) < noticed * least_violation) {
      least_violation = violation(point_.rows);
      unrestored = 0;
    } else if (++unrestored >= restoring_patience) {
      return finish(infeasible("many steps have not brought them closer"));
    }
    if (violation_ > progress_.limits().tolerance) {
      const double here = violation(point_.rows), share = (here - normal_.left(normal_delta_)) / here;
      if (!(share > hopeless)) {
        return finish(infeasible("to first order no step brings them closer, as their Jacobian is singular here"));
      }
      // Next to a singular Jacobian factors give the direction, and too short a step.
      if (share < 0.5) {
        for (double& number : normal_delta_) number /= share;
      }
    }
    trials_refused_ = true;
    trial_failure_.clear();
    Step step;
    Verdict verdict = Verdict::shorten;
    while (verdict == Verdict::shorten) {
      if (radius_ < smallest) return finish(without_step());
      if (!compose(step)) {
        return finish(
            {Claim::stalled, text("no shift of the Hessian gives usable factors: stationarity %.2e N, rows to "
                                  "%.2e mm",
                                  stationarity_, violation_)});
      }
      if (step.bound_share < held) return finish(without_step());
      verdict = try_step(step);
    }
    if (verdict == Verdict::rounding && errors_within_targets() && polished < polishing) {
      polished = polishing;
      continue;
    }
    if (verdict == Verdict::rounding) {
      int negative = 0;
      const bool minimum = subproblem_.positive(least_curvature(), negative);
      return finish(
          {Claim::stalled,
           text("rounding hides any further improvement: stationarity %.2e N, rows to %.2e mm; %s", stationarity_,
                violation_, minimum ? "no curvature is negative" : "there is negative curvature here")});
    }
    fraction = step.fraction;
    if (!step.restoring) least_violation = std::numeric_limits<double>::infinity();
    status = take();
    if (!status.ok()) {
      return finish({Claim::failed, status.text.empty() ? "an accepted point could not be evaluated" : status.text});
    }
  }
}

}  // namespace bowstring::trust_region
