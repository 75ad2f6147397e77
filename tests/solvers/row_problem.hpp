#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "tests/plugins/quadratic_problem.hpp"

namespace bowstring::testing {

/// lower ≤ coefficient · x + square |x|² ≤ upper.
struct QuadraticRow {
  std::vector<double> coefficient;
  double lower = -std::numeric_limits<double>::infinity(), upper = 0.0;
  double square = 0.0;
};

/// A quadratic energy with such rows and with bounds, whose chart is Rⁿ itself, and that answers as the test wants.
class RowProblem final : public Problem {
 public:
  RowProblem(std::vector<double> stiffness, std::vector<double> rest, std::vector<QuadraticRow> rows = {})
      : rows_(std::move(rows)), quadratic_(std::move(stiffness), std::move(rest)) {
    const auto n = static_cast<std::size_t>(unknowns());
    lower_bounds.assign(n, -std::numeric_limits<double>::infinity());
    upper_bounds.assign(n, std::numeric_limits<double>::infinity());
    summary_.unknowns = unknowns();
    begin_.push_back(0);
    for (int k = 0; k < unknowns() + static_cast<int>(rows_.size()); ++k) order_.push_back(k);
    for (const QuadraticRow& row : rows_) {
      (row.lower == row.upper ? summary_.equalities : summary_.inequalities) += 1;
      row_lower_.push_back(row.lower);
      row_upper_.push_back(row.upper);
      for (int u = 0; u < unknowns(); ++u) inner_.push_back(u);
      begin_.push_back(static_cast<int>(inner_.size()));
    }
    if (!rows_.empty()) summary_.row_groups.push_back({"rows", "", 0, static_cast<int>(rows_.size()), false});
  }

  /// Asked before every evaluation; anything but ok is passed on.
  std::function<Status(const RowProblem&, const std::vector<double>&)> answer;
  std::function<bool(const RowProblem&)> wants_epoch;
  std::vector<double> lower_bounds, upper_bounds;
  std::vector<double> reference;  ///< the last accepted point
  std::vector<double> guards;     ///< all that were set
  int epochs_begun = 0;
  double row_shift = 0.0;  ///< added to every row

  const ProblemSummary& summary() const noexcept override { return summary_; }
  int unknowns() const noexcept override { return quadratic_.unknowns(); }
  int coordinates() const noexcept override { return quadratic_.unknowns(); }
  int rows() const noexcept override { return static_cast<int>(rows_.size()); }
  Span<const double> row_lower() const noexcept override { return row_lower_; }
  Span<const double> row_upper() const noexcept override { return row_upper_; }
  Span<const double> lower() const noexcept override { return lower_bounds; }
  Span<const double> upper() const noexcept override { return upper_bounds; }
  SparsityPattern jacobian_pattern() const noexcept override { return {begin_, inner_}; }
  SparsityPattern hessian_pattern() const noexcept override { return quadratic_.hessian_pattern(); }
  Span<const int> order() const noexcept override { return order_; }
  Span<const double> stationarity_scale() const noexcept override { return quadratic_.stationarity_scale(); }

  Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept override {
    if (answer) {
      if (Status status = answer(*this, {q.begin(), q.end()}); !status.ok()) return status;
    }
    double squared = 0.0;
    for (const double x : q) squared += x * x;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double value = row_shift + rows_[r].square * squared;
      for (std::size_t u = 0; u < q.size(); ++u) {
        value += rows_[r].coefficient[u] * q[u];
        if (evaluation.jacobian.empty()) continue;
        evaluation.jacobian[r * q.size() + u] = rows_[r].coefficient[u] + 2.0 * rows_[r].square * q[u];
      }
      if (!evaluation.rows.empty()) evaluation.rows[r] = value;
    }
    return quadratic_.evaluate(q, evaluation);
  }
  Status lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override {
    Status status = quadratic_.lagrangian_hessian(q, energy_factor, multipliers, values);
    for (std::size_t r = 0; r < rows_.size() && !multipliers.empty(); ++r) {
      for (double& value : values) value += 2.0 * rows_[r].square * multipliers[r];
    }
    return status;
  }
  void values(Span<const double> q, Span<double> out) const noexcept override { quadratic_.values(q, out); }
  void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept override {
    quadratic_.retract(q, delta, out);
  }
  Status accept(Span<const double> q) noexcept override {
    reference.assign(q.begin(), q.end());
    return {};
  }
  void set_guard(double fraction) noexcept override { guards.push_back(fraction); }
  bool epoch_due() const noexcept override { return wants_epoch && wants_epoch(*this); }
  Status new_epoch() noexcept override {
    ++epochs_begun;
    return {};
  }
  int epochs() const noexcept override { return 1 + epochs_begun; }

  std::unique_ptr<EuclideanProblem> chart(Span<const double> base) override {
    return std::make_unique<Chart>(*this, std::vector<double>(base.begin(), base.end()));
  }

 private:
  class Chart final : public EuclideanProblem {
   public:
    Chart(RowProblem& problem, std::vector<double> base) : problem_(problem), base_(std::move(base)) {}
    void start(Span<double> x) const noexcept override { std::copy(base_.begin(), base_.end(), x.begin()); }
    void state(Span<const double> x, Span<double> q) const noexcept override {
      std::copy(x.begin(), x.end(), q.begin());
    }
    Status evaluate(Span<const double> x, const ProblemEvaluation& evaluation) noexcept override {
      return problem_.evaluate(x, evaluation);
    }
    Status lagrangian_hessian(Span<const double> x, double energy_factor, Span<const double> multipliers,
                              Span<double> values) noexcept override {
      return problem_.lagrangian_hessian(x, energy_factor, multipliers, values);
    }
    bool recentre_due(Span<const double>) const noexcept override { return false; }

   private:
    RowProblem& problem_;
    std::vector<double> base_;
  };

  std::vector<QuadraticRow> rows_;
  QuadraticProblem quadratic_;
  std::vector<double> row_lower_, row_upper_;
  std::vector<int> begin_, inner_, order_;
  ProblemSummary summary_;
};

}  // namespace bowstring::testing
