#include "solvers/trust-region/normal_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/newton/stopwatch.hpp"

namespace bowstring::trust_region {

namespace {
constexpr int refinements = 3;
constexpr double smallest_shift = 1e-8, largest_shift = 1e15;  // N/mm
constexpr double growth = 100.0, relax = 1e-2;
constexpr double smooth_share = 0.1;  // of the curvature for a smooth displacement
constexpr double two_pi = 6.283185307179586;
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

NormalStep::NormalStep(newton::Point& point, const Metric& metric, SolverResult& count)
    : point_(point), metric_(metric), count_(count) {}

void NormalStep::analyse() {
  const Problem& problem = point_.problem();
  system_.analyse(problem, point_.jacobian);
  no_multipliers_.assign(at(problem.rows()), 0.0);
  no_softness_.assign(at(problem.rows()), std::numeric_limits<double>::infinity());
  a_.resize(at(problem.unknowns()));
  b_.resize(at(problem.rows()));
}

/// |δᵀHδ|/|δ|² for a wave as long as everything, along the problem's order.
double NormalStep::smooth_curvature() const {
  const Problem& problem = point_.problem();
  const Span<const int> order = problem.order();
  std::vector<double> wave(at(problem.unknowns()), 0.0);
  const double step = two_pi / static_cast<double>(std::max<std::size_t>(1, order.size()));
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] < problem.unknowns()) wave[at(order[k])] = std::sin(step * static_cast<double>(k));
  }
  const double norm = metric_.norm(wave);
  if (!(norm > 0.0)) return 0.0;
  const SparsityPattern pattern = problem.hessian_pattern();
  double sum = 0.0;
  for (std::size_t j = 0; j < wave.size(); ++j) {
    for (int k = pattern.begin[j]; k < pattern.begin[j + 1]; ++k) {
      const std::size_t i = at(pattern.inner[at(k)]);
      sum += (i == j ? 1.0 : 2.0) * point_.hessian[at(k)] * wave[i] * wave[j];
    }
  }
  return std::fabs(sum) / (norm * norm);
}

Status NormalStep::factor(bool& usable) {
  usable = false;
  if (Status status = point_.find_hessian(no_multipliers_); !status.ok()) return status;
  const newton::Stopwatch watch(count_.factorization_seconds);
  const SparsityPattern pattern = point_.problem().hessian_pattern();
  const auto attempt = [&](double shift) {
    energy_hessian_ = point_.hessian;
    for (std::size_t u = 0; u < metric_.weight().size(); ++u) {
      energy_hessian_[at(pattern.begin[u])] += shift * metric_.weight()[u];
    }
    kkt::KktSystem::Values values;
    values.hessian = energy_hessian_;
    values.jacobian = point_.jacobian;
    values.softness = no_softness_;
    ++count_.factorizations;
    const kkt::KktSystem::Outcome outcome = system_.factor(values);
    return outcome.exists && outcome.saddle_directions == 0;
  };
  const double least = std::max(smallest_shift, smooth_share * smooth_curvature());
  double shift = std::max(least, relax * shift_);
  usable = attempt(shift);
  while (!usable && shift < largest_shift) {
    shift *= growth;
    usable = attempt(shift);
  }
  if (usable) shift_ = shift;
  return {};
}

void NormalStep::solve(Span<const double> a, Span<const double> b, std::vector<double>& delta,
                       std::vector<double>& lambda) {
  const newton::Stopwatch watch(count_.factorization_seconds);
  delta.resize(a.size());
  lambda.resize(b.size());
  system_.solve(a, b, {}, refinements, delta, lambda);
}

void NormalStep::multipliers(std::vector<double>& out) {
  for (std::size_t u = 0; u < a_.size(); ++u) a_[u] = -point_.gradient[u];
  b_.assign(b_.size(), 0.0);
  solve(a_, b_, delta_, out);
}

void NormalStep::step(std::vector<double>& delta) {
  const Problem& problem = point_.problem();
  a_.assign(a_.size(), 0.0);
  for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = problem.row_lower()[r] - point_.rows[r];
  solve(a_, b_, delta, lambda_);
}

double NormalStep::left(Span<const double> delta) const {
  const Problem& problem = point_.problem();
  double sum = 0.0;
  for (int r = 0; r < problem.rows(); ++r) {
    sum += std::fabs(point_.rows[at(r)] - problem.row_lower()[at(r)] + point_.row_rate(r, delta));
  }
  return sum;
}

}  // namespace bowstring::trust_region
