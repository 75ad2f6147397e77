#include "losses/transport/sinkhorn/entropic_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "plugins/sdk/guard.hpp"

namespace bowstring::sinkhorn {
namespace {

/// The ladder of ε falls by this factor; each rung but the last is left at this error of the marginals. A loose one
/// costs more: Newton's method of the next rung needs potentials that are right to about ε.
constexpr double rung = 0.25;
constexpr double rung_tolerance = 1e-6;
constexpr long rung_iterations = 2000;

/// Scalings are absorbed into the potentials beyond this, far from overflow even of a sum of products.
constexpr double largest_scaling = 1e50;

/// −ε log Σ_j w_j exp(x_j/ε) of the numbers x, +∞ where no w_j counts.
double soft_minimum(const Eigen::Ref<const Vector>& x, const Vector& w, double epsilon) {
  double largest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (w[j] > 0.0) largest = std::max(largest, x[j]);
  }
  double sum = 0.0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (w[j] > 0.0) sum += w[j] * std::exp((x[j] - largest) / epsilon);
  }
  return -largest - epsilon * std::log(sum);
}

/// Zero below 1e-200: no scaling brings such an entry back, and processors are slow with denormal numbers.
double exponential(double exponent) { return exponent < -460.0 ? 0.0 : std::exp(exponent); }

bool usable(const Vector& scaling) { return scaling.allFinite() && scaling.minCoeff() > 0.0; }

bool within(const Vector& scaling, double limit) {
  return scaling.minCoeff() > 1.0 / limit && scaling.maxCoeff() < limit;
}

void refuse_forbidden(const Matrix& cost) {
  for (Eigen::Index i = 0; i < cost.rows(); ++i) {
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
      if (std::isfinite(cost(i, j))) continue;
      throw StatusError(Code::unsupported, "the pair of row " + std::to_string(i) + " and column " + std::to_string(j) +
                                               " is forbidden, and transport 'sinkhorn' gives every pair some mass; "
                                               "expected finite costs; choose transport 'exact', or a large cost");
    }
  }
}

/// A Newton step changes no exponent by more than this: along a direction in which the plan hardly couples places, the
/// quadratic model asks for steps without end.
constexpr double reach = 20.0;

/// Adds `damping` of the diagonal: directions in which the dual is flat below rounding stay where they are.
constexpr double damping = 1e-13;

/// Pairs with less mass than this couple nothing beside the damping, and products of their masses would be denormal.
constexpr double least_coupling = 1e-60;

}  // namespace

EntropicProblem::EntropicProblem(Matrix cost, Vector a, Vector b)
    : f(Vector::Zero(a.size())), g(Vector::Zero(b.size())), cost_(std::move(cost)), a_(std::move(a)), b_(std::move(b)) {
  refuse_forbidden(cost_);
}

void EntropicProblem::make_kernel() {
  kernel_ = ((-cost_).colwise() + f).rowwise() + g.transpose();
  kernel_ = (kernel_ / epsilon_).unaryExpr(&exponential);
}

void EntropicProblem::update_in_logarithms() {
  Vector x(std::max(f.size(), g.size()));
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    f[i] = soft_minimum(g - cost_.row(i).transpose(), b_, epsilon_);
  }
  for (Eigen::Index j = 0; j < g.size(); ++j) {
    g[j] = soft_minimum(f - cost_.col(j), a_, epsilon_);
  }
  ++iterations;
}

/// One step of Newton's method on the dual, which is concave: its Hessian is −1/ε [diag(P 1) P; Pᵀ diag(Pᵀ 1)],
/// singular along constants that f gains and g loses. Of the smaller side the Schur complement is factorized. Halved
/// until the dual grows; false where it does not.
bool EntropicProblem::newton_step() {
  const bool turned = f.size() < g.size();
  const Vector &a = turned ? b_ : a_, &b = turned ? a_ : b_;
  Vector &of_a = turned ? g : f, &of_b = turned ? f : g;
  const Matrix as_it_stands = plan();
  const Matrix here = turned ? Matrix(as_it_stands.transpose()) : as_it_stands;
  const Vector row = here.rowwise().sum(), column = here.colwise().sum().transpose();
  const Vector residual_a = a - row, residual_b = b - column;
  const Vector inverse_row = row.unaryExpr([](double sum) { return sum > 0.0 ? 1.0 / sum : 0.0; });
  const Matrix coupling = (here.array() < least_coupling).select(0.0, here);
  const Matrix scaled = inverse_row.cwiseSqrt().asDiagonal() * coupling;
  Eigen::MatrixXd schur = Eigen::MatrixXd::Zero(b.size(), b.size());
  schur.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose(), -1.0);
  for (Eigen::Index j = 0; j < schur.rows(); ++j) schur(j, j) += column[j] > 0.0 ? (1.0 + damping) * column[j] : 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(schur);
  if (factor.info() != Eigen::Success) return false;
  const Vector step_b =
      epsilon_ * factor.solve(residual_b - coupling.transpose() * inverse_row.cwiseProduct(residual_a));
  const Vector step_a = inverse_row.cwiseProduct(epsilon_ * residual_a - coupling * step_b);
  const Vector from_a = of_a, from_b = of_b;
  const double value = dual_value(as_it_stands);
  const double longest = std::max(step_a.lpNorm<Eigen::Infinity>(), step_b.lpNorm<Eigen::Infinity>());
  for (double share = std::min(1.0, reach * epsilon_ / longest), least = 1e-3 * share; share > least; share *= 0.5) {
    of_a = from_a + share * step_a;
    of_b = from_b + share * step_b;
    const double next = dual_value(plan());
    if (std::isfinite(next) && next >= value) return true;
  }
  of_a = from_a;
  of_b = from_b;
  return false;
}

/// Iterations until `tolerance`, the iteration `last`, or an absorption. An update in logarithms comes first: no row
/// of the kernel is then all zero.
void EntropicProblem::scale(double tolerance, long last) {
  update_in_logarithms();
  make_kernel();
  Vector u = Vector::Ones(f.size()), v = Vector::Ones(g.size());
  while (true) {
    const Vector row = kernel_ * b_.cwiseProduct(v);
    marginal_error = a_.cwiseProduct((u.cwiseProduct(row).array() - 1.0).matrix()).cwiseAbs().sum();
    if (marginal_error <= tolerance || iterations >= last) break;
    const Vector next_u = row.cwiseInverse();
    const Vector next_v = (kernel_.transpose() * a_.cwiseProduct(next_u)).cwiseInverse();
    ++iterations;
    if (!usable(next_u) || !usable(next_v)) break;
    u = next_u;
    v = next_v;
    if (!within(u, largest_scaling) || !within(v, largest_scaling)) break;
  }
  f.array() += epsilon_ * u.array().log();
  g.array() += epsilon_ * v.array().log();
}

/// At one ε. Scaling slows down where ε is small; a Newton step is worth as many iterations as it costs.
void EntropicProblem::descend(double epsilon, double tolerance, long most_iterations) {
  epsilon_ = epsilon;
  const long last = iterations + most_iterations;
  const long patience = std::max<long>(20, std::min(cost_.rows(), cost_.cols()) / 2);
  while (true) {
    scale(tolerance, std::min(last, iterations + patience));
    if (marginal_error <= tolerance || iterations >= last) return;
    newton_step();
  }
}

void EntropicProblem::solve(double epsilon, const Limits& limits, bool warm) {
  iterations = 0;
  if (!warm) {
    f.setZero();
    g.setZero();
    const double largest = cost_.cwiseAbs().maxCoeff();
    for (double step = largest; step > epsilon / rung; step *= rung) descend(step, rung_tolerance, rung_iterations);
  }
  descend(epsilon, limits.tolerance, limits.most_iterations);
}

void EntropicProblem::solve_symmetric(double epsilon, const Limits& limits) {
  iterations = 0;
  epsilon_ = epsilon;
  f.setZero();
  for (long k = 0; k < limits.most_iterations; ++k) {
    marginal_error = 0.0;
    Vector next(f.size());
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      next[i] = soft_minimum(f - cost_.row(i).transpose(), b_, epsilon);
      marginal_error += a_[i] * std::fabs(std::expm1((f[i] - next[i]) / epsilon));
    }
    ++iterations;
    if (marginal_error <= limits.tolerance) break;
    f = 0.5 * (f + next);
  }
  g = f;
}

Matrix EntropicProblem::plan() const {
  const Matrix exponent = (((-cost_).colwise() + f).rowwise() + g.transpose()) / epsilon_;
  return a_.asDiagonal() * exponent.unaryExpr(&exponential) * b_.asDiagonal();
}

double EntropicProblem::dual_value(const Matrix& plan) const {
  return f.dot(a_) + g.dot(b_) - epsilon_ * (plan.sum() - 1.0);
}

double EntropicProblem::transport_cost(const Matrix& plan) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) > 0.0) sum += plan(i, j) * cost_(i, j);
    }
  }
  return sum;
}

double EntropicProblem::primal_value(const Matrix& plan) const {
  double divergence = 1.0 - plan.sum();
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) > 0.0) divergence += plan(i, j) * std::log(plan(i, j) / (a_[i] * b_[j]));
    }
  }
  return transport_cost(plan) + epsilon_ * divergence;
}

std::size_t EntropicProblem::memory_bytes() const noexcept {
  return sizeof(double) * static_cast<std::size_t>(3 * cost_.size() + 6 * (a_.size() + b_.size()));
}

Matrix rounded(Matrix plan, const Vector& a, const Vector& b) {
  const auto scale = [](double wanted, double sum) { return sum > wanted ? wanted / sum : 1.0; };
  const Vector rows = plan.rowwise().sum();
  plan = rows.binaryExpr(a, [&](double sum, double wanted) { return scale(wanted, sum); }).asDiagonal() * plan;
  const Vector columns = plan.colwise().sum().transpose();
  plan = plan * columns.binaryExpr(b, [&](double sum, double wanted) { return scale(wanted, sum); }).asDiagonal();
  const Vector missing_a = a - plan.rowwise().sum(), missing_b = b - plan.colwise().sum().transpose();
  const double missing = missing_a.cwiseAbs().sum();
  if (missing > 0.0) plan += missing_a * missing_b.transpose() / missing;
  return plan.cwiseMax(0.0);
}

}  // namespace bowstring::sinkhorn
