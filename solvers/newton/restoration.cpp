#include "solvers/newton/restoration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "solvers/newton/diagnosis.hpp"
#include "solvers/newton/step_length.hpp"

namespace bowstring::newton {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tightness = 1e-4;      // e of equality rows, of that of sides: what fails are the walls
constexpr double first_pull = 10.0;     // of the energy's forces: what violated rows push with at the start
constexpr double least_force = 1.0;     // N
constexpr double decade = 0.1;          // by which e falls
constexpr int least_decades = 5;        // before the end: a stiff curve, still straight, may yet give way
constexpr double smallest = 1e-11;      // mm/N
constexpr double bound_barrier = 1e-4;  // ν, N mm
constexpr double nearly_solved = 0.1;   // of the largest force: stationarity of Φ that lets e fall
constexpr double solved = 5e-4;         // of the largest force: stationarity of Φ that lets e fall
constexpr double stationary = 1e-3;     // of a unit of violation
constexpr double stays = 0.9;           // of a violation, over a decade of e: it does not fall
constexpr double little = 10.0;         // tolerances: rows that hold
constexpr double boundary = 0.9;        // of the way to a bound
constexpr double armijo = 1e-4;
constexpr double shortest_step = 1e-9;
constexpr int most_steps = 200, most_shortenings = 40, most_shifts = 6, most_saddles = 10;
constexpr int most_sets = 4;  // of rows that a step would violate, at one point
constexpr int refinements = 2, inverse_iterations = 10;
constexpr double least_shift = 1e-9;  // N/mm: less curvature is none
constexpr double off_saddle = 1.0;    // mm, the first trial along negative curvature

/// The same problem, of which no row is held exactly and no unknown belongs to a row.
class Relaxed final : public Problem {
 public:
  explicit Relaxed(Problem& problem) : problem_(problem), lower_(at(problem.rows()), -infinity) {}
  const ProblemSummary& summary() const noexcept override { return problem_.summary(); }
  int unknowns() const noexcept override { return problem_.unknowns(); }
  int coordinates() const noexcept override { return problem_.coordinates(); }
  int rows() const noexcept override { return problem_.rows(); }
  Span<const double> row_lower() const noexcept override { return lower_; }
  Span<const double> row_upper() const noexcept override { return problem_.row_upper(); }
  Span<const double> lower() const noexcept override { return problem_.lower(); }
  Span<const double> upper() const noexcept override { return problem_.upper(); }
  SparsityPattern jacobian_pattern() const noexcept override { return problem_.jacobian_pattern(); }
  SparsityPattern hessian_pattern() const noexcept override { return problem_.hessian_pattern(); }
  Span<const int> order() const noexcept override { return problem_.order(); }
  int border() const noexcept override { return problem_.border(); }
  Span<const double> stationarity_scale() const noexcept override { return problem_.stationarity_scale(); }
  Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept override {
    return problem_.evaluate(q, evaluation);
  }
  Status lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override {
    return problem_.lagrangian_hessian(q, energy_factor, multipliers, values);
  }
  void values(Span<const double> q, Span<double> out) const noexcept override { problem_.values(q, out); }
  void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept override {
    problem_.retract(q, delta, out);
  }
  Status accept(Span<const double> q) noexcept override { return problem_.accept(q); }
  void set_guard(double fraction) noexcept override { problem_.set_guard(fraction); }
  double travelled() const noexcept override { return problem_.travelled(); }
  bool epoch_due() const noexcept override { return problem_.epoch_due(); }
  Status new_epoch() noexcept override { return problem_.new_epoch(); }
  int epochs() const noexcept override { return problem_.epochs(); }
  std::unique_ptr<EuclideanProblem> chart(Span<const double> base) override { return problem_.chart(base); }

 private:
  Problem& problem_;
  std::vector<double> lower_;
};

}  // namespace

Restoration::Restoration(Point& point, Progress& progress)
    : point_(point),
      progress_(progress),
      problem_(point.problem()),
      relaxed_(std::make_unique<Relaxed>(problem_)),
      sides_(sides_of_rows(problem_)),
      bounds_(sides_of_unknowns(problem_)),
      equalities_(equality_rows(problem_)) {
  const std::size_t n = at(problem_.unknowns()), m = at(problem_.rows());
  force_.resize(m);
  soft_.resize(m);
  right_a_.resize(n);
  right_b_.resize(m);
  delta_.resize(n);
  lambda_.resize(m);
  trial_q_.resize(point.q.size());
  trial_rows_.resize(m);
}

void Restoration::read_bounds(const std::vector<double>& q, std::vector<double>& room) const {
  std::vector<double> number;
  read_room(problem_, bounds_, q, number, room);
}

double Restoration::summed(const std::vector<double>& rows) const {
  double sum = 0.0;
  for (int r = 0; r < problem_.rows(); ++r) sum += violation(problem_, rows, r);
  return sum;
}

double Restoration::value(double energy, const std::vector<double>& rows, const std::vector<double>& room) const {
  double sum = 0.0;
  for (const int r : equalities_) {
    const double off = rows[at(r)] - problem_.row_lower()[at(r)];
    sum += off * off / (equality_softness_);
  }
  for (const Side& side : sides_) {
    const double off = std::max(0.0, side.violation(rows[at(side.index)]));
    sum += off * off / softness_;
  }
  double out = energy + 0.5 * sum;
  for (const double number : room) out -= bound_barrier * std::log(number);
  return out;
}

/// λ = violation/e, with the sign of the side.
void Restoration::find_forces() {
  std::fill(force_.begin(), force_.end(), 0.0);
  for (const int r : equalities_) {
    force_[at(r)] = (point_.rows[at(r)] - problem_.row_lower()[at(r)]) / (equality_softness_);
  }
  for (const Side& side : sides_) {
    force_[at(side.index)] += side.sign * std::max(0.0, side.violation(point_.rows[at(side.index)])) / softness_;
  }
  largest_force_ = 0.0;
  for (const double force : force_) largest_force_ = std::max(largest_force_, std::fabs(force));
}

void Restoration::find_gradient() {
  find_forces();
  point_.lagrangian_gradient(force_, gradient_);
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    gradient_[at(bounds_[k].index)] += bounds_[k].sign * bound_barrier / room_[k];
  }
}

double Restoration::pull_of_violation() {
  std::vector<double> sum;
  point_.lagrangian_gradient(force_, sum);
  for (std::size_t u = 0; u < sum.size(); ++u) sum[u] -= point_.gradient[u];
  return point_.in_newtons(sum) / largest_force_;
}

/// Newton's direction on Φ; rows that it would violate take part.
bool Restoration::direction() {
  const SparsityPattern pattern = problem_.hessian_pattern();
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    point_.hessian[at(pattern.begin[at(bounds_[k].index)])] += bound_barrier / (room_[k] * room_[k]);
  }
  for (std::size_t u = 0; u < right_a_.size(); ++u) right_a_[u] = -point_.gradient[u];
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    right_a_[at(bounds_[k].index)] -= bounds_[k].sign * bound_barrier / room_[k];
  }
  std::fill(soft_.begin(), soft_.end(), infinity);
  std::fill(right_b_.begin(), right_b_.end(), 0.0);
  for (const int r : equalities_) {
    soft_[at(r)] = equality_softness_;
    right_b_[at(r)] = problem_.row_lower()[at(r)] - point_.rows[at(r)];
  }
  const auto take_in = [&](const Side& side) {
    soft_[at(side.index)] = softness_;
    right_b_[at(side.index)] = side.bound - point_.rows[at(side.index)];
  };
  const auto violated = [&](const Side& side) { return side.violation(point_.rows[at(side.index)]) > 0.0; };
  for (const Side& side : sides_) {
    if (violated(side)) take_in(side);
  }
  kkt::KktSystem::Values values;
  values.hessian = point_.hessian;
  values.jacobian = point_.jacobian;
  values.softness = soft_;
  const auto step = [&] {
    if (!inertia_.factor(system_, values, 0.0, progress_.result())) return false;
    system_.solve(right_a_, right_b_, {}, refinements, delta_, lambda_);
    return true;
  };
  // Rows that the step would violate push against it, and those that only pull are let go.
  bool changed = true;
  for (int k = 0; changed && k < most_sets; ++k) {
    if (!step()) return false;
    changed = false;
    for (const Side& side : sides_) {
      if (violated(side)) continue;
      if (!std::isfinite(soft_[at(side.index)])) {
        const double gap = side.violation(point_.rows[at(side.index)]);
        if (gap + side.sign * point_.row_rate(side.index, delta_) <= 0.0) continue;
        take_in(side);
      } else {
        if (side.sign * lambda_[at(side.index)] >= 0.0) continue;
        soft_[at(side.index)] = infinity;
        right_b_[at(side.index)] = 0.0;
      }
      changed = true;
    }
  }
  double slope = 0.0;
  for (std::size_t u = 0; u < delta_.size(); ++u) slope += gradient_[u] * delta_[u];
  if (slope < 0.0) return true;
  for (const Side& side : sides_) {
    if (violated(side)) continue;
    soft_[at(side.index)] = infinity;
    right_b_[at(side.index)] = 0.0;
  }
  for (const Side& side : sides_) {
    if (violated(side)) take_in(side);
  }
  return step();
}

/// Next to the leftmost eigenvector of the Hessian, by inverse iteration with the factors of a shift not far beyond it.
/// False: it has no negative eigenvalue that matters.
bool Restoration::leftmost_direction() {
  kkt::KktSystem::Values values;
  values.hessian = point_.hessian;
  values.jacobian = point_.jacobian;
  values.softness = soft_;
  const auto positive = [&](double shift) {
    values.shift = shift;
    ++progress_.result().factorizations;
    const kkt::KktSystem::Outcome outcome = system_.factor(values);
    return outcome.exists && outcome.saddle_directions == 0;
  };
  double good = inertia_.shift();
  while (good > least_shift && positive(good / 3.0)) good /= 3.0;
  if (good <= least_shift || !positive(good)) return false;
  const Span<const double> scale = problem_.stationarity_scale();
  std::vector<double> right(delta_.size());
  const std::vector<double> nothing(at(problem_.rows()), 0.0);
  for (std::size_t u = 0; u < delta_.size(); ++u)
    delta_[u] = (1.0 + 0.5 * std::sin(1.7 * static_cast<double>(u))) / scale[u];
  double along = 0.0;
  for (int k = 0; k < inverse_iterations; ++k) {
    double longest = 0.0;
    for (std::size_t u = 0; u < delta_.size(); ++u) longest = std::max(longest, std::fabs(delta_[u]) * scale[u]);
    for (std::size_t u = 0; u < delta_.size(); ++u) right[u] = delta_[u] / longest * scale[u] * scale[u];
    system_.solve(right, nothing, {}, 0, delta_, lambda_);
  }
  double longest = 0.0;
  for (std::size_t u = 0; u < delta_.size(); ++u) longest = std::max(longest, std::fabs(delta_[u]) * scale[u]);
  for (std::size_t u = 0; u < delta_.size(); ++u) along += gradient_[u] * delta_[u];
  for (double& number : delta_) number *= (along > 0.0 ? -off_saddle : off_saddle) / longest;
  return true;
}

/// Equality rows become tighter than the sides by and by: at once they would buckle a curve into its shortest waves.
void Restoration::tighten() {
  softness_ *= decade;
  equality_softness_ =
      std::min(decade * equality_softness_, std::max(tightness * softness_, decade * decade * equality_softness_));
}

double Restoration::longest_step() const {
  double longest = 1.0;
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const double rate = bounds_[k].sign * delta_[at(bounds_[k].index)];
    if (rate > 0.0) longest = std::min(longest, boundary * room_[k] / rate);
  }
  return longest;
}

bool Restoration::search(double longest, bool along_curvature) {
  const double here = value(point_.energy, point_.rows, room_);
  double slope = 0.0;
  for (std::size_t u = 0; u < delta_.size(); ++u) slope += gradient_[u] * delta_[u];
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * std::fabs(here);
  std::vector<double> scaled(delta_.size());
  double step = longest;
  trial_failure_ = {};
  for (int k = 0; k < most_shortenings && step > shortest_step; ++k) {
    for (std::size_t u = 0; u < scaled.size(); ++u) scaled[u] = step * delta_[u];
    problem_.retract(point_.q, scaled, trial_q_);
    const Status status = point_.try_out(trial_q_, trial_energy_, trial_rows_);
    if (!status.ok()) {
      trial_failure_ = status;
      step = shortened(step, status, problem_);
      continue;
    }
    trial_failure_ = {};
    read_bounds(trial_q_, trial_room_);
    const bool inside = std::all_of(trial_room_.begin(), trial_room_.end(), [](double room) { return room > 0.0; });
    const double there = inside ? value(trial_energy_, trial_rows_, trial_room_) : infinity;
    if (along_curvature ? there < here - rounding : there <= here + armijo * step * slope + rounding) return true;
    step *= 0.5;
  }
  return false;
}

Status Restoration::take() {
  std::vector<double> before = trial_q_;
  point_.q.swap(before);
  bool new_epoch = false;
  Status status = point_.arrive(&new_epoch);
  if (!status.ok()) {
    point_.q.swap(before);
    return status;
  }
  if (new_epoch) system_.analyse(*relaxed_, point_.jacobian);
  read_bounds(point_.q, room_);
  return status;
}

Ending Restoration::run(double goal, std::vector<double>& multipliers) {
  const auto finish = [&](Claim claim, const std::string& reason) {
    // Those of rows that cannot hold together grow with every decade, and say nothing.
    multipliers = claim == Claim::infeasible ? std::vector<double>() : force_;
    return Ending{claim, reason};
  };
  const double tolerance = progress_.limits().tolerance;
  read_bounds(point_.q, room_);
  system_.analyse(*relaxed_, point_.jacobian);
  const double pull = std::max(least_force, first_pull * point_.in_newtons(point_.gradient));
  double sides = 0.0, equalities = 0.0;
  for (const Side& side : sides_) sides = std::max(sides, side.violation(point_.rows[at(side.index)]));
  for (const int r : equalities_) equalities = std::max(equalities, violation(problem_, point_.rows, r));
  softness_ = std::max(sides, sides > tolerance ? 0.0 : equalities) / pull;
  equality_softness_ = std::max(tightness * softness_, equalities / pull);
  double before_decade = infinity;
  int saddles = 0, decades = 0;
  for (int steps = 0;; ++steps) {
    find_gradient();
    const double off = summed(point_.rows), worst = largest_violation(problem_, point_.rows);
    if (off <= goal) return finish(Claim::optimal, "restored");
    const std::string rows = failing_rows(problem_, point_.rows, tolerance);
    if (steps == most_steps || softness_ < smallest) {
      return finish(Claim::stalled, "many steps towards the rows have not reached them; " + rows);
    }
    const double error = point_.in_newtons(gradient_);
    if (Status status = point_.find_hessian(force_); !status.ok()) return finish(Claim::failed, status.text);
    if (!direction()) return finish(Claim::stalled, "no shift of the Hessian gives usable factors; " + rows);
    const bool curved = inertia_.shift() > 0.0;
    bool along_curvature = false;
    const bool settled = error <= solved * largest_force_;
    if (settled && curved && saddles < most_saddles && leftmost_direction()) {
      along_curvature = true;
      ++saddles;
    } else if (settled || (!curved && error <= nearly_solved * largest_force_)) {
      const bool final = decades >= least_decades && worst > stays * before_decade;
      if (final && settled) {
        const double left = pull_of_violation();
        if (left <= stationary && worst > little * tolerance) {
          char text[160];
          std::snprintf(text, sizeof text, "no direction brings them closer (a share of %.0e of what they fail by)",
                        left);
          return finish(Claim::infeasible, std::string("the rows cannot hold together: ") + text + "; " + rows);
        }
      }
      if (!final || settled) {
        before_decade = worst;
        tighten();
        ++decades;
        continue;
      }
    }
    bool found = search(longest_step(), along_curvature);
    if (!found && along_curvature) {
      saddles = most_saddles;
      continue;
    }
    if (!found) {
      if (trial_failure_.code == Code::failed) return finish(Claim::failed, trial_failure_.text);
      if (error > stationary * largest_force_) {
        const bool refused = trial_failure_.code == Code::refused;
        return finish(Claim::stalled, (refused ? "every trial step towards the rows was refused, however short; "
                                               : "no step brings the rows closer; ") +
                                          rows);
      }
      before_decade = worst;
      tighten();
      continue;
    }
    if (Status status = take(); !status.ok()) return finish(Claim::failed, status.text);
    if (!progress_.record(point_.energy, error, worst, 1.0)) {
      find_forces();
      return finish(Claim::stalled, progress_.reason());
    }
  }
}

}  // namespace bowstring::newton
