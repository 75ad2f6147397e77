#include "solvers/trust-region/normal_step.hpp"

#include <chrono>
#include <cmath>
#include <limits>

namespace bowstring::trust_region {

namespace {
constexpr int refinements = 3;
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

NormalStep::NormalStep(newton::Point& point, const Metric& metric, SolverResult& count)
    : point_(point), metric_(metric), count_(count) {}

void NormalStep::analyse() {
  const Problem& problem = point_.problem();
  system_.analyse(problem, point_.jacobian);
  const SparsityPattern pattern = problem.hessian_pattern();
  weights_.assign(at(pattern.entries()), 0.0);
  for (std::size_t u = 0; u < metric_.weight().size(); ++u) weights_[at(pattern.begin[u])] = metric_.weight()[u];
  no_softness_.assign(at(problem.rows()), std::numeric_limits<double>::infinity());
  a_.resize(at(problem.unknowns()));
  b_.resize(at(problem.rows()));
}

bool NormalStep::factor() {
  const auto begin = std::chrono::steady_clock::now();
  kkt::KktSystem::Values values;
  values.hessian = weights_;
  values.jacobian = point_.jacobian;
  values.softness = no_softness_;
  ++count_.factorizations;
  const bool exists = system_.factor(values).exists;
  count_.factorization_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return exists;
}

void NormalStep::solve(Span<const double> a, Span<const double> b, std::vector<double>& delta,
                       std::vector<double>& lambda) {
  const auto begin = std::chrono::steady_clock::now();
  delta.resize(a.size());
  lambda.resize(b.size());
  system_.solve(a, b, {}, refinements, delta, lambda);
  count_.factorization_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
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
