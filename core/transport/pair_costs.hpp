#pragma once

#include <string>

#include "core/interfaces/ground_cost.hpp"
#include "core/interfaces/transport.hpp"

namespace bowstring {

/// Costs that were given as a matrix, row major, which outlives this.
class MatrixCosts final : public PairCosts {
 public:
  MatrixCosts(Span<const double> matrix, int rows, int columns) noexcept;

  int row_count() const noexcept override { return rows_; }
  int column_count() const noexcept override { return columns_; }
  bool dear() const noexcept override { return false; }
  const double* matrix() const noexcept override { return matrix_.data(); }
  Status rows(int begin, int end, Span<double> value) noexcept override;
  Status lower_bounds(int begin, int end, Span<double> value) noexcept override;
  Status evaluate(Span<const int> pairs, Span<double> value) noexcept override;

 private:
  Span<const double> matrix_;
  int rows_, columns_;
};

/// The costs between two measures, which outlive this as the ground cost does. It counts what it evaluates, and
/// refuses what is not finite by the indices of the pair.
class MeasureCosts final : public PairCosts {
 public:
  MeasureCosts(const GroundCost& cost, const Measure& a, const Measure& b) noexcept : cost_(cost), a_(a), b_(b) {}

  int row_count() const noexcept override { return static_cast<int>(a_.count()); }
  int column_count() const noexcept override { return static_cast<int>(b_.count()); }
  bool dear() const noexcept override { return cost_.dear(); }
  const double* matrix() const noexcept override { return nullptr; }
  Status rows(int begin, int end, Span<double> value) noexcept override;
  Status lower_bounds(int begin, int end, Span<double> value) noexcept override;
  Status evaluate(Span<const int> pairs, Span<double> value) noexcept override;

  long evaluated() const noexcept { return evaluated_; }
  double seconds() const noexcept { return seconds_; }

 private:
  const GroundCost& cost_;
  const Measure &a_, &b_;
  long evaluated_ = 0;
  double seconds_ = 0.0;
};

}  // namespace bowstring
