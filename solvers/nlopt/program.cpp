#include "solvers/nlopt/program.hpp"

#include <algorithm>
#include <cmath>

#include "plugins/sdk/guard.hpp"

namespace bowstring::nlopt_solver {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int most_refusals = 25;          // in a row; by then a step has been shortened past rounding
constexpr std::size_t references = 32;     // iterates that a trial of MMA and CCSAQ may start from
constexpr double contact_reach = 1e-6;     // mm: rows so near their bound may carry a multiplier
constexpr double feasible = 1e-6;          // mm: what counts as feasible when points are compared
constexpr double same_energy = 1e-5;       // relative: where the first-order error tells which of two points is better
constexpr double energy_rounding = 1e-13;  // relative, of a sum of many terms
constexpr int most_quiet = 50;             // iterates without progress
constexpr double inner_tolerance = 1e-12;  // relative, of the augmented Lagrangian's energy
constexpr int inner_evaluations = 5000;

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double squared = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squared += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squared);
}

/// Rows and complementarity weigh more than forces, as in the certificate's thresholds.
double rank(const FirstOrderError& error) {
  return std::max({error.stationarity, 100.0 * error.violation, 100.0 * error.complementarity});
}

nlopt::algorithm nlopt_algorithm_of(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::mma:
      return nlopt::LD_MMA;
    case Algorithm::ccsaq:
      return nlopt::LD_CCSAQ;
    case Algorithm::slsqp:
      break;
  }
  return nlopt::LD_SLSQP;
}

}  // namespace

Program::Program(Problem& problem, EuclideanProblem& chart, const Settings& settings, const SolverContext& context,
                 SolverResult& result, Progress& progress)
    : problem_(problem),
      chart_(chart),
      settings_(settings),
      context_(context),
      result_(result),
      progress_(progress),
      line_search_(settings.algorithm == Algorithm::slsqp),
      scale_(problem.stationarity_scale().begin(), problem.stationarity_scale().end()) {
  trial_.x.resize(at(problem.unknowns()));
  trial_.gradient.resize(at(problem.unknowns()));
  trial_.rows.resize(at(problem.rows()));
  trial_.jacobian.resize(at(problem.jacobian_pattern().entries()));
  for (int r = 0; r < problem_.rows(); ++r) {
    const double lower = problem_.row_lower()[at(r)];
    const double upper = problem_.row_upper()[at(r)];
    if (lower == upper) {
      equalities_.push_back({r, 1.0, upper});
      continue;
    }
    if (std::isfinite(upper)) inequalities_.push_back({r, 1.0, upper});
    if (std::isfinite(lower)) inequalities_.push_back({r, -1.0, lower});
  }
}

double Program::seconds() const { return std::chrono::duration<double>(Clock::now() - progress_.begin).count(); }

nlopt::opt Program::make_optimizer() {
  const auto n = static_cast<unsigned>(problem_.unknowns());
  const nlopt::algorithm algorithm = nlopt_algorithm_of(settings_.algorithm);
  const bool wrapped = !line_search_ && !equalities_.empty();
  nlopt::opt optimizer(wrapped ? nlopt::AUGLAG : algorithm, n);
  if (wrapped) {
    nlopt::opt inner(algorithm, n);
    inner.set_ftol_rel(inner_tolerance);
    inner.set_maxeval(inner_evaluations);
    optimizer.set_local_optimizer(inner);
    optimizer.set_ftol_rel(inner_tolerance);
  }
  std::vector<double> lower(n), upper(n);
  for (std::size_t u = 0; u < n; ++u) {
    lower[u] = problem_.lower()[u] * scale_[u];
    upper[u] = problem_.upper()[u] * scale_[u];
  }
  optimizer.set_lower_bounds(lower);
  optimizer.set_upper_bounds(upper);
  optimizer.set_min_objective(&objective_callback, this);
  const auto tolerances = [&](const std::vector<Side>& sides) {
    return std::vector<double>(sides.size(), settings_.tolerance);
  };
  if (!equalities_.empty()) optimizer.add_equality_mconstraint(&equality_callback, this, tolerances(equalities_));
  if (!inequalities_.empty()) {
    optimizer.add_inequality_mconstraint(&inequality_callback, this, tolerances(inequalities_));
  }
  // NLopt looks at the clock where no callback of this class does: while it solves its subproblems.
  if (std::isfinite(settings_.time_limit)) optimizer.set_maxtime(std::max(settings_.time_limit - seconds(), 1e-3));
  return optimizer;
}

nlopt::result Program::run() {
  nlopt::opt optimizer = make_optimizer();
  optimizer_ = &optimizer;
  std::vector<double> x(at(problem_.unknowns()));
  chart_.start(x);
  for (std::size_t u = 0; u < x.size(); ++u) x[u] *= scale_[u];
  double energy = 0.0;
  try {
    optimizer.optimize(x, energy);
  } catch (const std::exception&) {
    // Its text says no more than the code that is returned.
  }
  if (stop_ == Stop::none && pending_) guarded([&] { accept(candidate_); });
  if (const char* text = optimizer.get_errmsg(); text != nullptr) message_ = text;
  optimizer_ = nullptr;
  if (exception_) std::rethrow_exception(exception_);
  return optimizer.last_optimize_result();
}

template <class Body>
void Program::guarded(Body&& body) noexcept {
  try {
    body();
  } catch (...) {
    if (!exception_) exception_ = std::current_exception();
    end(Stop::error);
  }
}

double Program::objective_callback(unsigned, const double* x, double* gradient, void* self) {
  auto* program = static_cast<Program*>(self);
  double energy = HUGE_VAL;
  program->guarded([&] {
    energy = program->objective(x, gradient != nullptr);
    if (gradient == nullptr) return;
    for (std::size_t u = 0; u < program->scale_.size(); ++u) {
      gradient[u] = program->admissible_ ? program->trial_.gradient[u] / program->scale_[u] : 0.0;
    }
  });
  return energy;
}

void Program::equality_callback(unsigned, double* values, unsigned, const double* x, double* gradient, void* self) {
  auto* program = static_cast<Program*>(self);
  program->guarded([&] {
    program->evaluate(x);
    program->constraint(program->equalities_, 0.0, values, gradient);
  });
}

void Program::inequality_callback(unsigned, double* values, unsigned, const double* x, double* gradient, void* self) {
  auto* program = static_cast<Program*>(self);
  program->guarded([&] {
    program->evaluate(x);
    // An infinite row keeps MMA and CCSAQ from taking the trial for one that is nearer to the feasible set.
    program->constraint(program->inequalities_, program->equalities_.empty() ? HUGE_VAL : 0.0, values, gradient);
  });
}

/// SLSQP asks for the gradient with the first trial of a line search, again without it for further trials, and once
/// more with it at the trial that it takes, unless that was the first one.
double Program::objective(const double* scaled, bool with_gradient) {
  const bool repeated = is_last_trial(scaled);
  const bool first_trial_taken = pending_ && with_gradient;
  pending_ = false;
  if (first_trial_taken) accept(candidate_);
  if (stop_ != Stop::none || !evaluate(scaled)) return HUGE_VAL;
  if (iterates_ == 0) {
    accept(trial_);
  } else if (!line_search_) {
    if (!repeated) accept(trial_);
  } else if (with_gradient && !repeated) {
    candidate_ = trial_;
    pending_ = true;
  } else if (with_gradient && !first_trial_taken) {
    accept(trial_);
  }
  return energy_without_rounding();
}

/// Close to a solution the decrease that SLSQP's line search asks for is smaller than the rounding of the energy, and
/// steps shrink to nothing. There a first trial that leaves the energy as it is counts as a decrease, as in the
/// approximate conditions of Hager and Zhang (2005), and the Newton-like steps go on.
double Program::energy_without_rounding() {
  const double rounding = energy_rounding * std::fabs(energy_);
  if (pending_ && std::fabs(trial_.energy - energy_) <= rounding) drift_ += rounding;
  return trial_.energy - drift_;
}

void Program::constraint(const std::vector<Side>& sides, double refused_value, double* values, double* gradient) const {
  const std::size_t n = scale_.size();
  if (gradient != nullptr) std::fill(gradient, gradient + sides.size() * n, 0.0);
  if (!admissible_) return std::fill(values, values + sides.size(), refused_value);
  const SparsityPattern pattern = problem_.jacobian_pattern();
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const Side& side = sides[s];
    values[s] = side.sign * (trial_.rows[at(side.row)] - side.bound);
    if (gradient == nullptr) continue;
    for (int k = pattern.begin[at(side.row)]; k < pattern.begin[at(side.row) + 1]; ++k) {
      const std::size_t u = at(pattern.inner[at(k)]);
      gradient[s * n + u] += side.sign * trial_.jacobian[at(k)] / scale_[u];
    }
  }
}

bool Program::is_last_trial(const double* scaled) const {
  return !scaled_.empty() && std::equal(scaled_.begin(), scaled_.end(), scaled);
}

/// The energy, the rows and all their derivatives at once: assembly is cheap beside NLopt's dense algebra.
bool Program::evaluate(const double* scaled) {
  if (is_last_trial(scaled)) return admissible_;
  scaled_.assign(scaled, scaled + scale_.size());
  for (std::size_t u = 0; u < scale_.size(); ++u) trial_.x[u] = scaled[u] / scale_[u];
  if (iterates_ > 0 && full_step_ == 0.0) full_step_ = distance(trial_.x, x_);
  if (seconds() > settings_.time_limit) end(Stop::time);
  const bool finite = std::all_of(scaled, scaled + scale_.size(), [](double x) { return std::isfinite(x); });
  const Status status = finite ? evaluate_chart() : Status{Code::refused, {}};
  admissible_ = status.ok();
  if (admissible_) {
    refusals_ = 0;
  } else {
    count_refusal(status);
  }
  return admissible_;
}

/// A trial may be taken from any of the last iterates: MMA and CCSAQ go back to one that they do not name.
Status Program::evaluate_chart() {
  ProblemEvaluation evaluation;
  evaluation.energy = &trial_.energy;
  evaluation.gradient = trial_.gradient;
  evaluation.rows = trial_.rows;
  evaluation.jacobian = trial_.jacobian;
  const auto begin = Clock::now();
  ++result_.evaluations;
  Status status = chart_.evaluate(trial_.x, evaluation);
  for (auto q = references_.rbegin(); q != references_.rend() && status.code == Code::refused; ++q) {
    if (const Status moved = problem_.accept(*q); !moved.ok()) throw StatusError(moved);
    status = chart_.evaluate(trial_.x, evaluation);
  }
  result_.evaluation_seconds += std::chrono::duration<double>(Clock::now() - begin).count();
  return status;
}

void Program::count_refusal(const Status& status) {
  const bool passing = status.code == Code::refused || status.code == Code::left_window || status.code == Code::failed;
  if (!passing) throw StatusError(status);
  if (iterates_ == 0) {
    throw StatusError(status.code, "the point that it starts from cannot be evaluated" +
                                       (status.text.empty() ? std::string() : ": " + status.text));
  }
  left_window_ = left_window_ || status.code == Code::left_window;
  if (status.code == Code::failed && progress_.failure.ok()) progress_.failure = status;
  if (++refusals_ >= most_refusals) end(Stop::refused);
}

void Program::accept(const Point& point) {
  chart_.state(point.x, result_.q);
  if (const Status status = problem_.accept(result_.q); !status.ok()) throw StatusError(status);
  if (!line_search_) {
    references_.push_back(result_.q);
    if (references_.size() > references) references_.pop_front();
  }
  const FirstOrderError error = first_order_error(problem_, point, contact_reach);
  record(point, error);
  watch_progress(point, error);
  keep_best(point, error);
  x_ = point.x;
  energy_ = point.energy;
  full_step_ = 0.0;
  ++iterates_;
  if (error.largest() <= settings_.tolerance) end(Stop::converged);
  if (result_.iterations >= settings_.max_iterations) end(Stop::iterations);
  if (seconds() > settings_.time_limit) end(Stop::time);
  if (iterates_ > 1 && (problem_.epoch_due() || chart_.recentre_due(point.x))) end(Stop::epoch);
  if (quiet_ >= most_quiet) end(Stop::quiet);
}

void Program::record(const Point& point, const FirstOrderError& error) {
  // The first iterate of a further run is the last one of the run before.
  if (iterates_ == 0 && !result_.history.empty()) return;
  result_.iterations = result_.history.empty() ? 0 : result_.history.back().iteration + 1;
  double step = iterates_ == 0 ? 0.0 : 1.0;
  if (line_search_ && full_step_ > 0.0) step = distance(point.x, x_) / full_step_;
  result_.history.push_back({result_.iterations, point.energy, error.stationarity, error.violation, step});
  if (context_.on_iteration && !context_.on_iteration(result_.history.back())) end(Stop::user);
}

void Program::watch_progress(const Point& point, const FirstOrderError& error) {
  const bool moved = iterates_ == 0 || std::fabs(point.energy - energy_) > energy_rounding * std::fabs(energy_);
  const bool closer = error.largest() < 0.5 * watched_error_;
  quiet_ = moved || closer ? 0 : quiet_ + 1;
  if (quiet_ == 0) watched_error_ = std::min(watched_error_, error.largest());
  progress_.least_error = std::min(progress_.least_error, error.largest());
}

void Program::keep_best(const Point& point, const FirstOrderError& error) {
  const bool is_feasible = error.violation <= feasible;
  const bool best_is_feasible = progress_.best_error.violation <= feasible;
  const double gain = progress_.best_energy - point.energy;
  bool better = is_feasible;
  if (is_feasible == best_is_feasible) {
    if (!is_feasible) {
      better = error.violation < progress_.best_error.violation;
    } else if (std::fabs(gain) <= same_energy * std::fabs(progress_.best_energy)) {
      better = rank(error) < rank(progress_.best_error);
    } else {
      better = gain > 0.0;
    }
  }
  if (!better && !progress_.best.empty()) return;
  progress_.best = result_.q;
  progress_.best_energy = point.energy;
  progress_.best_error = error;
}

void Program::end(Stop reason) noexcept {
  if (stop_ == Stop::none) stop_ = reason;
  if (optimizer_ != nullptr) optimizer_->force_stop();
}

}  // namespace bowstring::nlopt_solver
