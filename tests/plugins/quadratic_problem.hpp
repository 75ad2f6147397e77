#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::testing {

/// E(q) = ½ Σ k_i (q_i − a_i)² over Rⁿ, without rows.
class QuadraticProblem final : public Problem {
 public:
  QuadraticProblem(std::vector<double> stiffness, std::vector<double> rest)
      : stiffness_(std::move(stiffness)), rest_(std::move(rest)), unbounded_(rest_.size()), scale_(rest_.size(), 1.0) {
    summary_.unknowns = unknowns();
    for (int i = 0; i < unknowns(); ++i) {
      diagonal_.push_back(i);
      begin_.push_back(i);
    }
    begin_.push_back(unknowns());
  }

  const ProblemSummary& summary() const noexcept override { return summary_; }
  int unknowns() const noexcept override { return static_cast<int>(rest_.size()); }
  int coordinates() const noexcept override { return unknowns(); }
  int rows() const noexcept override { return 0; }
  Span<const double> row_lower() const noexcept override { return {}; }
  Span<const double> row_upper() const noexcept override { return {}; }
  Span<const double> lower() const noexcept override { return unbounded_; }
  Span<const double> upper() const noexcept override { return unbounded_; }
  SparsityPattern jacobian_pattern() const noexcept override { return {}; }
  SparsityPattern hessian_pattern() const noexcept override { return {begin_, diagonal_}; }
  Span<const int> order() const noexcept override { return diagonal_; }
  Span<const double> stationarity_scale() const noexcept override { return scale_; }

  Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept override {
    double energy = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double difference = q[i] - rest_[i];
      energy += 0.5 * stiffness_[i] * difference * difference;
      if (!evaluation.gradient.empty()) evaluation.gradient[i] = stiffness_[i] * difference;
    }
    if (evaluation.energy != nullptr) *evaluation.energy = energy;
    return {};
  }
  Status lagrangian_hessian(Span<const double>, double energy_factor, Span<const double>,
                            Span<double> values) noexcept override {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = energy_factor * stiffness_[i];
    return {};
  }
  void values(Span<const double> q, Span<double> out) const noexcept override {
    std::copy(q.begin(), q.end(), out.begin());
  }
  void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept override {
    for (std::size_t i = 0; i < q.size(); ++i) out[i] = q[i] + delta[i];
  }
  Status accept(Span<const double>) noexcept override { return {}; }
  void set_guard(double) noexcept override {}
  bool epoch_due() const noexcept override { return false; }
  Status new_epoch() noexcept override { return {}; }
  int epochs() const noexcept override { return 1; }
  std::unique_ptr<EuclideanProblem> chart(Span<const double>) override { return nullptr; }

 private:
  std::vector<double> stiffness_, rest_, unbounded_, scale_;
  std::vector<int> begin_, diagonal_;
  ProblemSummary summary_;
};

}  // namespace bowstring::testing
