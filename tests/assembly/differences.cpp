#include "tests/assembly/differences.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/check/differences.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

void require(const Status& status) {
  REQUIRE_MESSAGE(status.ok(), "code " << static_cast<int>(status.code) << ": " << status.text);
}

/// The evaluations that tangent space and chart share; `Point` is q or x.
template <class Evaluate, class Hessian>
void claim(Problem& problem, const std::vector<double>& point, const Evaluate& evaluate, const Hessian& hessian,
           LocalProblem& out) {
  const int n = out.unknowns = problem.unknowns();
  const int m = out.rows = problem.rows();
  const SparsityPattern rows = problem.jacobian_pattern();
  const SparsityPattern triangle = problem.hessian_pattern();
  std::vector<double> jacobian(at(rows.entries()), 1e300), values(at(triangle.entries()), 1e300);
  out.gradient.assign(at(n), 1e300);
  ProblemEvaluation wanted;
  wanted.gradient = out.gradient;
  wanted.jacobian = jacobian;
  require(evaluate(point, wanted));
  out.multipliers = random_numbers(m, 91);
  out.factor = 0.7;
  require(hessian(point, out.factor, out.multipliers, values));
  out.jacobian = dense_rows(rows, jacobian, m, n);
  out.hessian = dense_symmetric(triangle, values, n);
}

/// Of f(t), t the step along a direction.
template <class Function>
double slope(const Function& f, double h) {
  return first_difference(f(-2.0 * h), f(-h), f(h), f(2.0 * h), h);
}
template <class Function>
double bend(const Function& f, double at_zero, double h) {
  return second_difference(f(-2.0 * h), f(-h), at_zero, f(h), f(2.0 * h), h);
}

double lagrangian(const LocalProblem& local, const std::vector<double>& delta) {
  double sum = local.factor * local.energy(delta);
  const std::vector<double> rows = local.row_values(delta);
  for (std::size_t r = 0; r < rows.size(); ++r) sum += local.multipliers[r] * rows[r];
  return sum;
}

}  // namespace

LocalProblem tangent_problem(Problem& problem, const std::vector<double>& q) {
  LocalProblem out;
  claim(
      problem, q, [&](Span<const double> p, const ProblemEvaluation& wanted) { return problem.evaluate(p, wanted); },
      [&](Span<const double> p, double factor, Span<const double> multipliers, Span<double> values) {
        return problem.lagrangian_hessian(p, factor, multipliers, values);
      },
      out);
  const auto moved = [&problem, q](const std::vector<double>& delta) {
    std::vector<double> p(q.size());
    problem.retract(q, delta, p);
    return p;
  };
  out.energy = [&problem, moved](const std::vector<double>& delta) {
    double energy = 0.0;
    ProblemEvaluation wanted;
    wanted.energy = &energy;
    require(problem.evaluate(moved(delta), wanted));
    return energy;
  };
  out.row_values = [&problem, moved](const std::vector<double>& delta) {
    std::vector<double> rows(at(problem.rows()));
    ProblemEvaluation wanted;
    wanted.rows = rows;
    require(problem.evaluate(moved(delta), wanted));
    return rows;
  };
  return out;
}

LocalProblem chart_problem(Problem& problem, EuclideanProblem& chart, const std::vector<double>& x) {
  LocalProblem out;
  claim(
      problem, x, [&](Span<const double> p, const ProblemEvaluation& wanted) { return chart.evaluate(p, wanted); },
      [&](Span<const double> p, double factor, Span<const double> multipliers, Span<double> values) {
        return chart.lagrangian_hessian(p, factor, multipliers, values);
      },
      out);
  const auto moved = [x](std::vector<double> delta) {
    for (std::size_t k = 0; k < x.size(); ++k) delta[k] += x[k];
    return delta;
  };
  out.energy = [&chart, moved](const std::vector<double>& delta) {
    double energy = 0.0;
    ProblemEvaluation wanted;
    wanted.energy = &energy;
    require(chart.evaluate(moved(delta), wanted));
    return energy;
  };
  out.row_values = [&problem, &chart, moved](const std::vector<double>& delta) {
    std::vector<double> rows(at(problem.rows()));
    ProblemEvaluation wanted;
    wanted.rows = rows;
    require(chart.evaluate(moved(delta), wanted));
    return rows;
  };
  return out;
}

void check_derivatives(const LocalProblem& local, DifferenceSteps steps, DifferenceTolerance tolerance) {
  const int n = local.unknowns;
  const int m = local.rows;
  std::vector<double> direction(at(n), 0.0), scaled(at(n));
  const auto along = [&](double t) -> const std::vector<double>& {
    for (int u = 0; u < n; ++u) scaled[at(u)] = t * direction[at(u)];
    return scaled;
  };

  std::vector<double> gradient(at(n)), jacobian(at(m * n));
  for (int u = 0; u < n; ++u) {
    direction.assign(at(n), 0.0);
    direction[at(u)] = 1.0;
    gradient[at(u)] = slope([&](double t) { return local.energy(along(t)); }, steps.first);
    std::vector<double> values[4];
    const double node[4] = {-2.0, -1.0, 1.0, 2.0};
    for (int k = 0; k < 4; ++k) values[k] = local.row_values(along(node[k] * steps.first));
    for (int r = 0; r < m; ++r) {
      const auto i = at(r);
      jacobian[at(r * n + u)] = first_difference(values[0][i], values[1][i], values[2][i], values[3][i], steps.first);
    }
  }
  REQUIRE(largest(gradient) > 1e-3);
  CHECK(largest_difference(local.gradient, gradient) <= tolerance.first * std::max(1.0, largest(gradient)));
  if (m > 0) {
    REQUIRE(largest(jacobian) > 1e-3);
    CHECK(largest_difference(local.jacobian, jacobian) <= tolerance.first * std::max(1.0, largest(jacobian)));
  }

  const double at_zero = lagrangian(local, std::vector<double>(at(n), 0.0));
  const auto second = [&] {
    return bend([&](double t) { return lagrangian(local, along(t)); }, at_zero, steps.second);
  };
  std::vector<double> hessian(at(n * n));
  for (int i = 0; i < n; ++i) {
    direction.assign(at(n), 0.0);
    direction[at(i)] = 1.0;
    hessian[at(i * n + i)] = second();
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      direction.assign(at(n), 0.0);
      direction[at(i)] = direction[at(j)] = 1.0;
      const double mixed = 0.5 * (second() - hessian[at(i * n + i)] - hessian[at(j * n + j)]);
      hessian[at(i * n + j)] = hessian[at(j * n + i)] = mixed;
    }
  }
  REQUIRE(largest(hessian) > 1e-3);
  const double difference = largest_difference(local.hessian, hessian);
  CHECK(difference <= tolerance.second * largest(hessian));
}

std::vector<double> dense_symmetric(const SparsityPattern& pattern, const std::vector<double>& values, int n) {
  std::vector<double> out(at(n * n), 0.0);
  for (int j = 0; j < n; ++j) {
    for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
      const int i = pattern.inner[at(k)];
      out[at(i * n + j)] = out[at(j * n + i)] = values[at(k)];
    }
  }
  return out;
}

std::vector<double> dense_rows(const SparsityPattern& pattern, const std::vector<double>& values, int rows,
                               int columns) {
  std::vector<double> out(at(rows * columns), 0.0);
  for (int r = 0; r < rows; ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      out[at(r * columns + pattern.inner[at(k)])] = values[at(k)];
    }
  }
  return out;
}

}  // namespace bowstring::testing
