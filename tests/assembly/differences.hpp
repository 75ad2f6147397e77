#pragma once

#include <functional>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::testing {

/// A function of n numbers around zero, and what is claimed of its derivatives there. Dense, row major.
struct LocalProblem {
  int unknowns = 0, rows = 0;
  std::function<double(const std::vector<double>&)> energy;
  std::function<std::vector<double>(const std::vector<double>&)> row_values;
  std::vector<double> multipliers;  ///< of the Lagrangian factor·E + λᵀr
  double factor = 1.0;
  std::vector<double> gradient, jacobian, hessian;
};

/// δ ↦ (E, r)(q · Exp δ).
LocalProblem tangent_problem(Problem& problem, const std::vector<double>& q);
/// δ ↦ (E, r)(x + δ) on a chart.
LocalProblem chart_problem(Problem& problem, EuclideanProblem& chart, const std::vector<double>& x);

struct DifferenceSteps {
  double first = 1e-4, second = 2e-3;
};
/// Relative to the largest entry.
struct DifferenceTolerance {
  double first = 1e-8, second = 1e-6;
};

/// Central differences of fourth order against the claimed derivatives, each with a nonzero norm first.
void check_derivatives(const LocalProblem& local, DifferenceSteps steps = {}, DifferenceTolerance tolerance = {});

/// Lower triangle by columns → dense, and rows → dense.
std::vector<double> dense_symmetric(const SparsityPattern& pattern, const std::vector<double>& values, int n);
std::vector<double> dense_rows(const SparsityPattern& pattern, const std::vector<double>& values, int rows,
                               int columns);

}  // namespace bowstring::testing
