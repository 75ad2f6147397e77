#include "solvers/trust-region/subproblem.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "solvers/newton/stopwatch.hpp"

namespace bowstring::trust_region {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int refinements = 3;
constexpr int most_factors = 25;         // of one subproblem
constexpr double boundary_width = 0.15;  // of Δ
constexpr double narrowest = 1e-10;      // bracket of σ, relative
constexpr double hard_share = 0.1;       // what a step in the hard case may lose of the model's decrease
constexpr double first_growth = 4.0;     // of a shift that was too small; squared each time, as nothing is known
constexpr double smallest_shift = 1e-14, largest_shift = 1e15;  // N/mm
constexpr double large_entry = 0.5;                             // of a direction's largest

double dot(Span<const double> a, Span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// A shift within a bracket that may span orders of magnitude, or begin at 0.
double between(double lower, double upper) {
  return std::max(std::sqrt(lower * upper), lower + 0.05 * (upper - lower));
}

}  // namespace

Subproblem::Subproblem(newton::Point& point, const Metric& metric, SolverResult& count)
    : point_(point), metric_(metric), count_(count) {}

void Subproblem::analyse() {
  const Problem& problem = point_.problem();
  system_.analyse(problem, point_.jacobian);
  no_softness_.assign(at(problem.rows()), infinity);
  zero_rows_.assign(at(problem.rows()), 0.0);
  multipliers_.resize(at(problem.rows()));
  right_.resize(at(problem.unknowns()));
  work_.resize(at(problem.unknowns()));
  product_.resize(at(problem.unknowns()));
  derivative_.resize(at(problem.unknowns()));
  if (direction_.size() == at(problem.unknowns())) return;
  // Every mode has a part of it: numbers between 0.5 and 1.5 of a fixed sequence.
  direction_.resize(at(problem.unknowns()));
  std::uint32_t state = 12345u;
  for (double& entry : direction_) {
    state = 1664525u * state + 1013904223u;
    entry = 0.5 + static_cast<double>(state >> 8) / 16777216.0;
  }
}

bool Subproblem::factor(double shift, int* negative) {
  const newton::Stopwatch watch(count_.factorization_seconds);
  shifted_ = point_.hessian;
  const SparsityPattern pattern = point_.problem().hessian_pattern();
  for (std::size_t u = 0; shift != 0.0 && u < metric_.weight().size(); ++u) {
    shifted_[at(pattern.begin[u])] += shift * metric_.weight()[u];
  }
  kkt::KktSystem::Values values;
  values.hessian = shifted_;
  values.jacobian = point_.jacobian;
  values.softness = no_softness_;
  ++count_.factorizations;
  const kkt::KktSystem::Outcome outcome = system_.factor(values);
  if (negative != nullptr) *negative = outcome.exists ? std::max(0, outcome.saddle_directions) : -1;
  return outcome.exists && outcome.saddle_directions == 0;
}

void Subproblem::solve(Span<const double> a, Span<const double> b, std::vector<double>& delta,
                       std::vector<double>& lambda) {
  const newton::Stopwatch watch(count_.factorization_seconds);
  delta.resize(a.size());
  lambda.resize(b.size());
  system_.solve(a, b, {}, refinements, delta, lambda);
}

void Subproblem::multiply(Span<const double> direction, std::vector<double>& out) const {
  const SparsityPattern pattern = point_.problem().hessian_pattern();
  out.assign(direction.size(), 0.0);
  for (std::size_t j = 0; j < direction.size(); ++j) {
    for (int k = pattern.begin[j]; k < pattern.begin[j + 1]; ++k) {
      const std::size_t i = at(pattern.inner[at(k)]);
      out[i] += point_.hessian[at(k)] * direction[j];
      if (i != j) out[j] += point_.hessian[at(k)] * direction[i];
    }
  }
}

double Subproblem::curvature(Span<const double> direction) const {
  std::vector<double> product;
  multiply(direction, product);
  return dot(direction, product);
}

double Subproblem::inverse_iteration(int steps) {
  for (int k = 0; k < steps; ++k) {
    for (std::size_t u = 0; u < direction_.size(); ++u) right_[u] = metric_.weight()[u] * direction_[u];
    solve(right_, zero_rows_, work_, multipliers_);
    const double norm = metric_.norm(work_);
    if (!(norm > 0.0) || !std::isfinite(norm)) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t u = 0; u < direction_.size(); ++u) direction_[u] = work_[u] / norm;
  }
  return curvature(direction_);
}

/// The sign of a direction: its first entry of more than half its largest one is positive.
void Subproblem::point_forward() {
  double largest = 0.0;
  for (const double entry : direction_) largest = std::max(largest, std::fabs(entry));
  for (const double entry : direction_) {
    if (std::fabs(entry) < large_entry * largest) continue;
    if (entry < 0.0) {
      for (double& number : direction_) number = -number;
    }
    return;
  }
}

/// Adds a direction of negative curvature to a step that ends inside the region, up to its boundary. False: there is
/// none, or the model would lose more than `share` of its decrease by it.
bool Subproblem::extend(Span<const double> right, double radius, double least_gradient, double shift, double share,
                        double leftmost, std::vector<double>& step) {
  if (!(leftmost < 0.0)) return false;
  const double slope = dot(right, direction_);
  if (std::fabs(slope) < least_gradient) {
    point_forward();
  } else if (slope < 0.0) {
    for (double& number : direction_) number = -number;
  }
  const double along = metric_.product(step, direction_);
  const double length =
      -along + std::sqrt(std::max(0.0, radius * radius - metric_.product(step, step) + along * along));
  const double decrease = dot(right, step) + shift * radius * radius;
  if (length * length * (leftmost + shift) > share * decrease) return false;
  for (std::size_t u = 0; u < step.size(); ++u) step[u] += length * direction_[u];
  return true;
}

Subproblem::Answer Subproblem::minimise(Span<const double> right, double radius, double least_gradient,
                                        std::vector<double>& step, std::vector<double>& multipliers) {
  Answer out;
  double lower = 0.0, upper = infinity, shift = 0.0, growth = first_growth;
  bool usable = factor(shift, &out.negative);
  out.full_norm = infinity;
  double next_up = std::max(last_shift_, smallest_shift);
  if (!usable && out.negative > 0) {
    // The curvature nearest to 0 is a measure of the leftmost one.
    if (const double nearest = inverse_iteration(3); std::isfinite(nearest)) {
      next_up = std::max(next_up, 1.5 * std::fabs(nearest));
      lower = std::max(lower, -nearest);
    }
  }
  for (int count = 0; count < most_factors; ++count) {
    double next = shift;
    if (usable) {
      solve(right, zero_rows_, step, multipliers);
      const double norm = metric_.norm(step);
      if (shift == 0.0) out.full_norm = norm;
      if ((shift == 0.0 && norm <= radius) || std::fabs(norm - radius) <= boundary_width * radius) {
        out.found = true;
        out.shift = shift;
        out.interior = shift == 0.0;
        if (shift > 0.0) last_shift_ = shift;
        return out;
      }
      if (norm > radius) {
        lower = std::max(lower, shift);
      } else if (norm < radius) {
        const double leftmost = inverse_iteration(2);
        if (extend(right, radius, least_gradient, shift, hard_share, leftmost, step)) {
          out.found = out.hard = true;
          out.shift = last_shift_ = shift;
          return out;
        }
        // Factors that are all but singular have no direction to tell: this is where the leftmost curvature is.
        usable = std::isfinite(leftmost);
        if (usable) {
          upper = std::min(upper, shift);
          lower = std::max(lower, -leftmost);
        }
      } else {
        usable = false;
      }
    }
    if (usable) {
      for (std::size_t u = 0; u < step.size(); ++u) right_[u] = metric_.weight()[u] * step[u];
      solve(right_, zero_rows_, derivative_, multipliers_);
      const double norm = metric_.norm(step), rate = metric_.product(step, derivative_);
      if (rate > 0.0) next = shift + norm * norm / rate * (norm - radius) / radius;
    } else {
      lower = std::max(lower, shift);
    }
    if (!(next > lower) || !(next < upper)) {
      if (std::isfinite(upper)) {
        if (upper - lower <= narrowest * upper) break;
        next = between(lower, upper);
      } else {
        next = std::max(next_up, growth * lower);
        growth = std::min(growth * growth, 1e4);
        if (next > largest_shift) return out;
      }
    }
    shift = next;
    usable = factor(shift);
  }
  // No boundary within the tries: the shortest usable step, and what negative curvature there is.
  if (!std::isfinite(upper)) return out;
  factor(upper);
  solve(right, zero_rows_, step, multipliers);
  out.shift = last_shift_ = upper;
  out.found = std::isfinite(metric_.norm(step));
  out.hard = out.found && extend(right, radius, least_gradient, upper, infinity, inverse_iteration(2), step);
  return out;
}

bool Subproblem::positive(double shift, int& negative) { return factor(shift, &negative); }

Leftmost Subproblem::leftmost(double accuracy) {
  Leftmost out;
  int negative = 0;
  double lower = 0.0, upper = infinity, shift = 0.0;
  bool usable = factor(0.0, &negative);
  double start = smallest_shift, growth = first_growth;
  if (negative >= 0) {
    const double nearest = inverse_iteration(4);
    if (std::isfinite(nearest)) start = std::max(start, 1.5 * std::fabs(nearest));
    if (!usable && nearest < 0.0) lower = -nearest;
  }
  for (int count = 0; count < most_factors; ++count) {
    if (usable) {
      // Inverse iteration from beyond the leftmost curvature converges to it, and bounds it from the other side.
      double before = infinity, now = inverse_iteration(3);
      if (!std::isfinite(now)) {
        shift *= 1.0 + 1e-3;
        usable = factor(shift);
        continue;
      }
      upper = shift;
      for (int k = 0; k < 10 && std::fabs(now - before) > 0.1 * accuracy * std::fabs(now); ++k) {
        before = now;
        now = inverse_iteration(2);
      }
      out.known = true;
      out.curvature = now;
      lower = std::max(lower, -now);
      if (upper - lower <= std::max(0.5, accuracy) * upper || now >= 0.0) break;
      shift = lower + 0.1 * (upper - lower);
    } else {
      lower = std::max(lower, shift);
      shift = std::isfinite(upper) ? 0.5 * (lower + upper) : std::max(start, growth * shift);
      growth = std::min(growth * growth, 1e4);
      if (shift > largest_shift) break;
    }
    usable = factor(shift);
  }
  point_forward();
  out.direction = direction_;
  return out;
}

}  // namespace bowstring::trust_region
