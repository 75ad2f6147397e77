#include "enforcement/shared/least_squares.hpp"

#include "core/kkt/kkt_system.hpp"

namespace bowstring::softening {

namespace {

constexpr int refinements = 10;
constexpr double singular = 1e-6;  // relative residual

}  // namespace

Status least_squares_multipliers(Problem& problem, const std::vector<double>& q, std::vector<double>& out) {
  const auto n = static_cast<std::size_t>(problem.unknowns()), m = static_cast<std::size_t>(problem.rows());
  out.clear();
  std::vector<double> gradient(n), jacobian(static_cast<std::size_t>(problem.jacobian_pattern().entries()));
  ProblemEvaluation wanted;
  wanted.gradient = gradient;
  wanted.jacobian = jacobian;
  if (Status status = problem.evaluate(q, wanted); !status.ok()) return status;

  const SparsityPattern pattern = problem.hessian_pattern();
  std::vector<double> hessian(static_cast<std::size_t>(pattern.entries()), 0.0);
  for (std::size_t u = 0; u < n; ++u) {
    const double scale = problem.stationarity_scale()[u];
    hessian[static_cast<std::size_t>(pattern.begin[u])] = scale * scale;  // a column begins with its diagonal
    gradient[u] = -gradient[u];
  }
  const std::vector<double> softness(m, 0.0), no_gap(m, 0.0);
  kkt::KktSystem system;
  system.analyse(problem, jacobian);
  kkt::KktSystem::Values values;
  values.hessian = hessian;
  values.jacobian = jacobian;
  values.softness = softness;
  if (!system.factor(values).exists) return {};
  std::vector<double> delta(n), lambda(m);
  const double left = system.solve(gradient, no_gap, {}, refinements, delta, lambda);
  if (left <= singular) out = lambda;
  return {};
}

}  // namespace bowstring::softening
