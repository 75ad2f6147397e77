#include "losses/transport/unbalanced/kullback_leibler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "losses/transport/network-simplex/dense_costs.hpp"
#include "losses/transport/unbalanced/divergence.hpp"
#include "losses/transport/unbalanced/entropic.hpp"
#include "losses/transport/unbalanced/interior_point.hpp"

namespace bowstring::unbalanced {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Places = std::vector<int>;

Places with_mass(Span<const double> weight) {
  Places out;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (weight[k] > 0.0) out.push_back(static_cast<int>(k));
  }
  return out;
}

Eigen::Map<const Vector> mapped(Span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// The method of ε, with the shorter side as rows.
Iterate solve(const Problem& problem) {
  const auto method = problem.epsilon > 0.0 ? solve_by_scaling : solve_by_interior_point;
  if (problem.cost.rows() <= problem.cost.cols()) return method(problem);
  Iterate out = method({problem.b, problem.a, problem.cost.transpose(), problem.weight, problem.epsilon});
  out.plan = Matrix(out.plan.transpose());
  out.u.swap(out.v);
  return out;
}

/// The largest u that v leaves: min_j c_ij − v_j over columns that may have mass, or where it makes no difference.
double tight_dual(const Eigen::Ref<const Vector>& cost, const Vector& v, double most) {
  return std::min((cost - v).minCoeff(), most);
}

/// Duals without slack, on costs as they are.
void tighten(const Problem& problem, Iterate& found) {
  const double most = far * problem.weight;
  for (Eigen::Index i = 0; i < found.u.size(); ++i) {
    found.u[i] = tight_dual(problem.cost.row(i).transpose(), found.v, most);
  }
  for (Eigen::Index j = 0; j < found.v.size(); ++j) found.v[j] = tight_dual(problem.cost.col(j), found.u, most);
}

double penalty_gap(const Problem& problem, const Iterate& found) {
  return problem.weight *
         (divergence(found.plan.rowwise().sum(), problem.a * (-found.u / problem.weight).exp()) +
          divergence(found.plan.colwise().sum().transpose(), problem.b * (-found.v / problem.weight).exp()));
}

double plan_times(const Matrix& plan, const Matrix& factor) { return (plan > 0.0).select(plan * factor, 0.0).sum(); }

double gap_without_entropy(const Problem& problem, const Iterate& found) {
  const Matrix slack = (problem.cost.colwise() - found.u).rowwise() - found.v.transpose();
  return plan_times(found.plan, slack) + penalty_gap(problem, found);
}

/// At the end γ s = μ for all pairs: an entry is one of the plan where γ is large beside its slack, and zero where it
/// is small, both relative to what they could be.
void leave_out_zeros(const Problem& problem, Iterate& found) {
  const Vector sum_a = found.plan.rowwise().sum(), sum_b = found.plan.colwise().sum().transpose();
  const double scale = cost_scale(problem.cost, problem.weight);
  for (Eigen::Index i = 0; i < found.plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < found.plan.cols(); ++j) {
      const double slack = problem.cost(i, j) - found.u[i] - found.v[j];
      if (found.plan(i, j) * scale <= std::min(sum_a[i], sum_b[j]) * slack) found.plan(i, j) = 0.0;
    }
  }
}

/// A vertex-like plan of the interior point's, where that proves as much.
void finish_interior_point(const Problem& problem, Iterate& found) {
  tighten(problem, found);
  found.plan = (problem.cost < far * problem.weight).select(found.plan, 0.0);
  const double before = gap_without_entropy(problem, found);
  const Matrix full = found.plan;
  leave_out_zeros(problem, found);
  const double rounding = 1e-15 * problem.weight * (problem.a.sum() + problem.b.sum());
  if (!(gap_without_entropy(problem, found) <= 2.0 * before + rounding)) found.plan = full;
}

/// Entries whose mass no sum in doubles would feel; they are given back to the gap.
double leave_out_small(const Problem& problem, Iterate& found) {
  const double small = 1e-20 * found.plan.sum();
  const double left_out = (found.plan > small).select(0.0, found.plan).sum();
  found.plan = (found.plan > small).select(found.plan, 0.0);
  return problem.epsilon * left_out;
}

/// ε KL(γ, a bᵀ).
double entropy(const Problem& problem, const Matrix& plan) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) sum += divergence(plan(i, j), problem.a[i] * problem.b[j]);
  }
  return problem.epsilon * sum;
}

/// −ρε/(ρ + ε) log Σ_j b_j e^{(v_j − c_ij)/ε}, or its limit for ε = 0.
double dual_without_mass(const Problem& problem, const Vector& cost, const Vector& v, const Vector& b) {
  const double most = far * problem.weight;
  if (problem.epsilon == 0.0) return tight_dual(cost, v, most);
  const Vector exponent = (v - cost) / problem.epsilon;
  const double top = exponent.maxCoeff();
  if (std::isinf(top)) return most;
  const double log = top + std::log((b * (exponent - top).exp()).sum());
  return std::min(-problem.weight * problem.epsilon / (problem.weight + problem.epsilon) * log, most);
}

struct Sides {
  Places row, column;  ///< with mass
};

Problem reduced(const TransportProblem& problem, const double* cost, const Sides& sides, double weight,
                double epsilon) {
  const Eigen::Map<const Matrix> all(cost, static_cast<Eigen::Index>(problem.weight_a.size()),
                                     static_cast<Eigen::Index>(problem.weight_b.size()));
  return {mapped(problem.weight_a)(sides.row), mapped(problem.weight_b)(sides.column), all(sides.row, sides.column),
          weight, epsilon};
}

/// Duals of all places; those without mass get what a little mass there would have.
void write_duals(const TransportProblem& problem, const double* cost, const Sides& sides, const Problem& reduced,
                 const Iterate& found, TransportAnswer& out) {
  const auto rows = static_cast<Eigen::Index>(problem.weight_a.size());
  const auto columns = static_cast<Eigen::Index>(problem.weight_b.size());
  const Eigen::Map<const Matrix> all(cost, rows, columns);
  out.dual_a.assign(problem.weight_a.size(), 0.0);
  out.dual_b.assign(problem.weight_b.size(), 0.0);
  Eigen::Map<Vector> u(out.dual_a.data(), rows), v(out.dual_b.data(), columns);
  u(sides.row) = found.u;
  v(sides.column) = found.v;
  for (Eigen::Index j = 0; j < columns; ++j) {
    if (problem.weight_b[static_cast<std::size_t>(j)] > 0.0) continue;
    v[j] = dual_without_mass(reduced, all.col(j)(sides.row), found.u, reduced.a);
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (problem.weight_a[static_cast<std::size_t>(i)] > 0.0) continue;
    u[i] = reduced.epsilon > 0.0 ? dual_without_mass(reduced, all.row(i).transpose()(sides.column), found.v, reduced.b)
                                 : tight_dual(all.row(i).transpose(), v, far * reduced.weight);
  }
}

std::vector<double> weight_gradient(const std::vector<double>& dual, double other_sum, double weight, double epsilon) {
  std::vector<double> out(dual.size());
  std::transform(dual.begin(), dual.end(), out.begin(), [&](double u) {
    const double lost = -std::expm1(-u / weight);
    return weight * lost + epsilon * (other_sum - 1.0 + lost);
  });
  return out;
}

void write_plan(const Sides& sides, const Matrix& plan, TransportAnswer& out) {
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) <= 0.0) continue;
      out.plan.row.push_back(sides.row[static_cast<std::size_t>(i)]);
      out.plan.column.push_back(sides.column[static_cast<std::size_t>(j)]);
      out.plan.value.push_back(plan(i, j));
    }
  }
}

void write_certificate(const Problem& problem, const Iterate& found, double gap, TransportAnswer& out) {
  TransportCertificate& certificate = out.certificate;
  const Vector of_a = problem.a * (-found.u / problem.weight).exp(),
               of_b = problem.b * (-found.v / problem.weight).exp();
  certificate.marginal_a = (found.plan.rowwise().sum() - of_a).abs().maxCoeff();
  certificate.marginal_b = (found.plan.colwise().sum().transpose() - of_b).abs().maxCoeff();
  if (problem.epsilon == 0.0) {
    const Matrix slack = (problem.cost.colwise() - found.u).rowwise() - found.v.transpose();
    certificate.dual_violation = std::max(0.0, -slack.minCoeff());
  }
  certificate.cost_scale = std::max(problem.weight, problem.cost.isInf().select(0.0, problem.cost).abs().maxCoeff());
  certificate.gap = out.gap = gap;
  out.certified = true;
}

}  // namespace

void solve_kullback_leibler(const TransportProblem& problem, double weight, double epsilon, TransportAnswer& out) {
  simplex::DenseCosts costs;
  costs.load(*problem.between);
  const Sides sides{with_mass(problem.weight_a), with_mass(problem.weight_b)};
  const Problem own = reduced(problem, costs.data(), sides, weight, epsilon);
  Iterate found = solve(own);
  double gap = 0.0;
  if (epsilon > 0.0) {
    gap = leave_out_small(own, found);
    gap += penalty_gap(own, found);
  } else {
    finish_interior_point(own, found);
    gap = gap_without_entropy(own, found);
  }
  out = {};
  write_plan(sides, found.plan, out);
  write_duals(problem, costs.data(), sides, own, found, out);
  write_certificate(own, found, gap, out);
  const Vector sum_a = found.plan.rowwise().sum(), sum_b = found.plan.colwise().sum().transpose();
  const double penalty_a = weight * divergence(sum_a, own.a), penalty_b = weight * divergence(sum_b, own.b);
  out.transport_cost = plan_times(found.plan, own.cost);
  out.value = out.transport_cost + penalty_a + penalty_b + (epsilon > 0.0 ? entropy(own, found.plan) : 0.0);
  const double total_a = own.a.sum(), total_b = own.b.sum();
  out.weight_gradient_a = weight_gradient(out.dual_a, total_b, weight, epsilon);
  out.weight_gradient_b = weight_gradient(out.dual_b, total_a, weight, epsilon);
  out.iterations = found.iterations;
  out.memory_bytes = found.memory_bytes + costs.memory_bytes();
  out.figures = {{"mass", found.plan.sum()}, {"penalty_a", penalty_a}, {"penalty_b", penalty_b}};
}

}  // namespace bowstring::unbalanced
