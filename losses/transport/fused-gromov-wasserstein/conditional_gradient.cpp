#include "losses/transport/fused-gromov-wasserstein/conditional_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "plugins/sdk/guard.hpp"

namespace bowstring::gromov {
namespace {

struct Entry {
  Eigen::Index row, column;
  double mass;
};

std::vector<Entry> entries_of(const Matrix& plan) {
  std::vector<Entry> out;
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) > 0.0) out.push_back({i, j, plan(i, j)});
    }
  }
  return out;
}

double linear_part(const Problem& problem, const Matrix& plan) {
  return problem.alpha < 1.0 ? (1.0 - problem.alpha) * problem.cost.cwiseProduct(plan).sum() : 0.0;
}

/// Σ_k A_ik² a_k.
Vector second_moment(const Matrix& structure, const Vector& weight) {
  return (structure.cwiseAbs2() * weight.matrix()).array();
}

/// F's parts that do not change with the plan, and its gradient.
class Gradient {
 public:
  explicit Gradient(const Problem& problem)
      : problem_(problem),
        moment_a_(second_moment(problem.structure_a, problem.a)),
        moment_b_(second_moment(problem.structure_b, problem.b)) {}

  /// `crossed`: A γ B.
  Matrix operator()(const Matrix& crossed) const {
    Matrix out = -4.0 * problem_.alpha * crossed;
    out.array().colwise() += 2.0 * problem_.alpha * moment_a_;
    out.array().rowwise() += 2.0 * problem_.alpha * moment_b_.transpose();
    if (problem_.alpha < 1.0) out += (1.0 - problem_.alpha) * problem_.cost;
    return out;
  }
  double value(const Matrix& plan, const Matrix& crossed) const {
    const double apart = (problem_.a * moment_a_).sum() + (problem_.b * moment_b_).sum();
    return linear_part(problem_, plan) + problem_.alpha * (apart - 2.0 * crossed.cwiseProduct(plan).sum());
  }

 private:
  const Problem& problem_;
  Vector moment_a_, moment_b_;
};

/// Where linear τ + quadratic τ² is least in [0, 1].
double best_step(double linear, double quadratic) {
  if (quadratic > 0.0) return std::clamp(-linear / (2.0 * quadratic), 0.0, 1.0);
  return linear + quadratic < 0.0 ? 1.0 : 0.0;
}

[[noreturn]] void refuse(double gap, double scale, const Settings& settings) {
  char text[256];
  std::snprintf(text, sizeof text,
                "after %ld steps the Frank-Wolfe gap is %.3g of what a plan may cost; expected %.3g; raise "
                "max-iterations or tolerance",
                settings.max_iterations, gap / scale, settings.tolerance);
  throw StatusError(Code::failed, text);
}

}  // namespace

double scale_of(const Problem& problem) {
  const Gradient gradient(problem);
  const Matrix product = problem.a.matrix() * problem.b.matrix().transpose() / problem.b.sum();
  const double scale = linear_part(problem, product.cwiseAbs()) +
                       problem.alpha * ((problem.a * second_moment(problem.structure_a, problem.a)).sum() +
                                        (problem.b * second_moment(problem.structure_b, problem.b)).sum());
  return scale > 0.0 ? scale : 1.0;
}

/// Pair by pair where the plan is thin: then nothing cancels, and a plan that keeps all distances costs nothing.
double value_of(const Problem& problem, const Matrix& plan) {
  const std::vector<Entry> entries = entries_of(plan);
  if (entries.size() > static_cast<std::size_t>(8 * (plan.rows() + plan.cols()))) {
    return Gradient(problem).value(plan, problem.structure_a * plan * problem.structure_b);
  }
  double sum = 0.0;
  for (const Entry& one : entries) {
    for (const Entry& other : entries) {
      const double apart = problem.structure_a(one.row, other.row) - problem.structure_b(one.column, other.column);
      sum += one.mass * other.mass * apart * apart;
    }
  }
  return linear_part(problem, plan) + problem.alpha * sum;
}

Matrix vertex_of(const simplex::NetworkSimplex& simplex) {
  const simplex::Masses& masses = simplex.masses();
  Matrix out =
      Matrix::Zero(static_cast<Eigen::Index>(masses.supply.size()), static_cast<Eigen::Index>(masses.demand.size()));
  for (const simplex::Arc& arc : simplex.plan()) {
    out(arc.row, arc.column) = static_cast<double>(arc.mass) * masses.quantum;
  }
  return out;
}

Stationary descend(const Problem& problem, const Matrix& start, const Settings& settings,
                   simplex::NetworkSimplex& simplex) {
  constexpr double rounding = 1e-14;
  const Gradient gradient(problem);
  const double scale = scale_of(problem);
  Stationary out;
  out.plan = start;
  Matrix crossed = problem.structure_a * start * problem.structure_b;
  for (;; ++out.iterations) {
    const Matrix slope = gradient(crossed);
    if (!simplex.solve(slope.data())) throw StatusError(Code::failed, "a linear program of the method has no plan");
    out.pivots += simplex.pivots();
    const Matrix vertex = vertex_of(simplex), vertex_crossed = problem.structure_a * vertex * problem.structure_b;
    const Matrix change = vertex - out.plan, change_crossed = vertex_crossed - crossed;
    const double linear = slope.cwiseProduct(change).sum();
    const double quadratic = -2.0 * problem.alpha * change_crossed.cwiseProduct(change).sum();
    const double step = best_step(linear, quadratic);
    const double gain = -(linear * step + quadratic * step * step);
    out.gap = std::max(0.0, -linear);
    if (gain <= rounding * scale || (out.gap <= settings.tolerance * scale && quadratic >= 0.0)) break;
    if (out.iterations >= settings.max_iterations) refuse(out.gap, scale, settings);
    // A whole step is taken as such: the plan is then the vertex, with its zeros.
    out.plan = step == 1.0 ? vertex : Matrix(out.plan + step * change);
    crossed = step == 1.0 ? vertex_crossed : Matrix(crossed + step * change_crossed);
  }
  out.row = simplex.row_potential();
  out.column = simplex.column_potential();
  out.value = value_of(problem, out.plan);
  return out;
}

}  // namespace bowstring::gromov
