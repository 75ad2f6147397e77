#include "core/certificate/multipliers.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A row of the least-squares problem, its sign chosen so that its multiplier has to be ≥ 0 where it is signed.
struct Candidate {
  int row = 0;
  double sign = 1.0;
  bool is_signed = false;
  bool passive = true;
  double multiplier = 0.0;
};

using Matrix = Eigen::SparseMatrix<double>;

std::vector<Candidate> candidates(const Assembly& assembly, const std::vector<double>& residual, double reach) {
  std::vector<Candidate> chosen;
  for (int r = 0; r < assembly.rows(); ++r) {
    const double lower = assembly.row_lower()[at(r)];
    const double upper = assembly.row_upper()[at(r)];
    if (lower == upper) {
      chosen.push_back({r, 1.0, false});
    } else if (residual[at(r)] >= upper - reach) {
      chosen.push_back({r, 1.0, true});
    } else if (residual[at(r)] <= lower + reach) {
      chosen.push_back({r, -1.0, true});
    }
  }
  return chosen;
}

Eigen::VectorXd solve_passive(const Matrix& columns, const std::vector<Candidate>& chosen,
                              const Eigen::VectorXd& target) {
  std::vector<Eigen::Triplet<double>> entries;
  int count = 0;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (!chosen[c].passive) continue;
    for (Matrix::InnerIterator it(columns, static_cast<Eigen::Index>(c)); it; ++it) {
      entries.emplace_back(static_cast<int>(it.row()), count, it.value());
    }
    ++count;
  }
  Matrix passive(columns.rows(), count);
  passive.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseQR<Matrix, Eigen::COLAMDOrdering<int>> qr(passive);
  return qr.solve(target);
}

}  // namespace

Status estimate_multipliers(Assembly& assembly, Span<const double> q, double reach, std::vector<double>& out) {
  const int n = assembly.unknowns();
  const SparsityPattern pattern = assembly.jacobian_pattern();
  std::vector<double> gradient(at(n)), residual(at(assembly.rows())), jacobian(at(pattern.entries()));
  ProblemEvaluation evaluation;
  evaluation.gradient = gradient;
  evaluation.rows = residual;
  evaluation.jacobian = jacobian;
  if (Status status = assembly.evaluate(q, evaluation); !status.ok()) return status;

  out.assign(at(assembly.rows()), 0.0);
  std::vector<Candidate> chosen = candidates(assembly, residual, reach);
  if (chosen.empty()) return {};
  const Span<const double> scale = assembly.stationarity_scale();
  Eigen::VectorXd target(n);
  for (int u = 0; u < n; ++u) target[u] = -gradient[at(u)] / scale[at(u)];
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const int row = chosen[c].row;
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int u = pattern.inner[at(k)];
      entries.emplace_back(u, static_cast<int>(c), chosen[c].sign * jacobian[at(k)] / scale[at(u)]);
    }
  }
  Matrix columns(n, static_cast<Eigen::Index>(chosen.size()));
  columns.setFromTriplets(entries.begin(), entries.end());

  // Exchange all infeasible rows at once while that reduces their number, then one at a time, which cannot cycle.
  int fewest = static_cast<int>(chosen.size()) + 1;
  int patience = 3;
  const int limit = 10 * static_cast<int>(chosen.size()) + 20;
  for (int round = 0; round < limit; ++round) {
    const Eigen::VectorXd solution = solve_passive(columns, chosen, target);
    Eigen::VectorXd remainder = target;
    int index = 0;
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      chosen[c].multiplier = chosen[c].passive ? solution[index++] : 0.0;
      if (chosen[c].multiplier != 0.0) remainder -= chosen[c].multiplier * columns.col(static_cast<Eigen::Index>(c));
    }
    const Eigen::VectorXd slope = columns.transpose() * remainder;
    std::vector<std::size_t> infeasible;
    const double tolerance = 1e-12 * (1.0 + target.lpNorm<Eigen::Infinity>());
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      if (!chosen[c].is_signed) continue;
      const bool wrong =
          chosen[c].passive ? chosen[c].multiplier < 0.0 : slope[static_cast<Eigen::Index>(c)] > tolerance;
      if (wrong) infeasible.push_back(c);
    }
    if (infeasible.empty()) break;
    if (static_cast<int>(infeasible.size()) < fewest) {
      fewest = static_cast<int>(infeasible.size());
      patience = 3;
    } else if (patience > 0) {
      --patience;
    } else {
      infeasible.erase(infeasible.begin(), infeasible.end() - 1);
    }
    for (const std::size_t c : infeasible) chosen[c].passive = !chosen[c].passive;
  }
  for (const Candidate& candidate : chosen) {
    out[at(candidate.row)] =
        candidate.sign * (candidate.is_signed ? std::max(candidate.multiplier, 0.0) : candidate.multiplier);
  }
  return {};
}

}  // namespace bowstring
