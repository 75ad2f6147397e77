#include "solvers/nlopt/first_order.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace bowstring::nlopt_solver {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double bound_reach = 1e-9;  // relative, of an unknown that lies on its bound

/// A row whose multiplier may differ from zero, its sign chosen so that the multiplier has to be ≥ 0 where it is
/// signed.
struct Candidate {
  int row = 0;
  double sign = 1.0;
  bool is_signed = false;
  double distance = 0.0;  // mm, from the bound
  bool passive = true;
  double multiplier = 0.0;
};

std::vector<Candidate> candidates_of(const Problem& problem, const Point& point, double reach) {
  std::vector<Candidate> candidates;
  for (int r = 0; r < problem.rows(); ++r) {
    const double above = point.rows[at(r)] - problem.row_upper()[at(r)];
    const double below = problem.row_lower()[at(r)] - point.rows[at(r)];
    if (problem.row_lower()[at(r)] == problem.row_upper()[at(r)]) {
      candidates.push_back({r, 1.0, false, 0.0});
    } else if (above >= -reach) {
      candidates.push_back({r, 1.0, true, std::fabs(above)});
    } else if (below >= -reach) {
      candidates.push_back({r, -1.0, true, std::fabs(below)});
    }
  }
  return candidates;
}

/// Gradients of the candidates' rows, in units of force per multiplier.
Eigen::MatrixXd columns_of(const Problem& problem, const Point& point, const std::vector<Candidate>& candidates) {
  const SparsityPattern pattern = problem.jacobian_pattern();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(problem.unknowns(), static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const int row = candidates[c].row;
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int u = pattern.inner[at(k)];
      columns(u, static_cast<Eigen::Index>(c)) +=
          candidates[c].sign * point.jacobian[at(k)] / problem.stationarity_scale()[at(u)];
    }
  }
  return columns;
}

/// An unknown that lies on a bound moves only away from it.
struct Held {
  bool lower = false, upper = false;
  bool any() const { return lower || upper; }
};

Held held(const Problem& problem, const Point& point, int u) {
  const double x = point.x[at(u)];
  const double lower = problem.lower()[at(u)];
  const double upper = problem.upper()[at(u)];
  return {std::isfinite(lower) && x - lower <= bound_reach * (1.0 + std::fabs(lower)),
          std::isfinite(upper) && upper - x <= bound_reach * (1.0 + std::fabs(upper))};
}

void solve_passive(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target, std::vector<Candidate>& candidates) {
  Eigen::MatrixXd passive(columns.rows(), columns.cols());
  Eigen::Index count = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (candidates[c].passive) passive.col(count++) = columns.col(static_cast<Eigen::Index>(c));
  }
  Eigen::VectorXd solution;
  if (count > 0) solution = passive.leftCols(count).colPivHouseholderQr().solve(target);
  count = 0;
  for (Candidate& candidate : candidates) candidate.multiplier = candidate.passive ? solution[count++] : 0.0;
}

Eigen::VectorXd multipliers_of(const std::vector<Candidate>& candidates) {
  Eigen::VectorXd multipliers(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    multipliers[static_cast<Eigen::Index>(c)] = candidates[c].multiplier;
  }
  return multipliers;
}

/// Non-negative least squares, columns · λ ≈ target: all infeasible rows change sides at once while that makes them
/// fewer, then one at a time, which cannot cycle.
void fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target, std::vector<Candidate>& candidates) {
  constexpr int patience_at_first = 3;
  const int count = static_cast<int>(candidates.size());
  const double tolerance = 1e-12 * (1.0 + target.lpNorm<Eigen::Infinity>());
  int fewest = count + 1;
  int patience = patience_at_first;
  for (int round = 0; round < 10 * count + 20; ++round) {
    solve_passive(columns, target, candidates);
    const Eigen::VectorXd slope = columns.transpose() * (target - columns * multipliers_of(candidates));
    std::vector<std::size_t> infeasible;
    for (int c = 0; c < count; ++c) {
      const Candidate& candidate = candidates[at(c)];
      if (!candidate.is_signed) continue;
      if (candidate.passive ? candidate.multiplier < 0.0 : slope[c] > tolerance) infeasible.push_back(at(c));
    }
    if (infeasible.empty()) return;
    if (static_cast<int>(infeasible.size()) < fewest) {
      fewest = static_cast<int>(infeasible.size());
      patience = patience_at_first;
    } else if (patience > 0) {
      --patience;
    } else {
      infeasible.erase(infeasible.begin(), infeasible.end() - 1);
    }
    for (const std::size_t c : infeasible) candidates[c].passive = !candidates[c].passive;
  }
}

}  // namespace

double FirstOrderError::largest() const noexcept { return std::max({stationarity, violation, complementarity}); }

FirstOrderError first_order_error(const Problem& problem, const Point& point, double reach) {
  FirstOrderError error;
  for (int r = 0; r < problem.rows(); ++r) {
    const double row = point.rows[at(r)];
    error.violation = std::max({error.violation, row - problem.row_upper()[at(r)], problem.row_lower()[at(r)] - row});
  }
  const int n = problem.unknowns();
  Eigen::VectorXd force(n);
  for (int u = 0; u < n; ++u) force[u] = point.gradient[at(u)] / problem.stationarity_scale()[at(u)];
  std::vector<Candidate> candidates = candidates_of(problem, point, reach);
  if (!candidates.empty()) {
    const Eigen::MatrixXd columns = columns_of(problem, point, candidates);
    Eigen::MatrixXd free_columns = columns;
    Eigen::VectorXd target = -force;
    for (int u = 0; u < n; ++u) {
      if (!held(problem, point, u).any()) continue;
      free_columns.row(u).setZero();
      target[u] = 0.0;
    }
    fit(free_columns, target, candidates);
    force += columns * multipliers_of(candidates);
  }
  for (int u = 0; u < n; ++u) {
    const Held at_bound = held(problem, point, u);
    if (at_bound.lower) force[u] = std::min(force[u], 0.0);
    if (at_bound.upper) force[u] = std::max(force[u], 0.0);
    error.stationarity = std::max(error.stationarity, std::fabs(force[u]));
  }
  for (const Candidate& candidate : candidates) {
    error.complementarity = std::max(error.complementarity, std::fabs(candidate.multiplier) * candidate.distance);
  }
  return error;
}

}  // namespace bowstring::nlopt_solver
