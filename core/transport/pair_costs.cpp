#include "core/transport/pair_costs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

namespace bowstring {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Status not_finite(int row, int column, double value) {
  return Status::failure(Code::failed, "the ground cost between place " + std::to_string(row) +
                                           " of the first measure and place " + std::to_string(column) +
                                           " of the second is " + (value < 0.0 ? "negative" : "not finite"));
}

bool usable(double cost) { return cost >= 0.0 && cost < HUGE_VAL; }

}  // namespace

MatrixCosts::MatrixCosts(Span<const double> matrix, int rows, int columns) noexcept
    : matrix_(matrix), rows_(rows), columns_(columns) {}

Status MatrixCosts::rows(int begin, int end, Span<double> value) noexcept {
  const auto columns = static_cast<std::size_t>(columns_);
  std::copy(matrix_.data() + static_cast<std::size_t>(begin) * columns,
            matrix_.data() + static_cast<std::size_t>(end) * columns, value.data());
  return {};
}

Status MatrixCosts::lower_bounds(int begin, int end, Span<double> value) noexcept { return rows(begin, end, value); }

Status MatrixCosts::evaluate(Span<const int> pairs, Span<double> value) noexcept {
  for (std::size_t k = 0; k < value.size(); ++k) {
    value[k] = matrix_[static_cast<std::size_t>(pairs[2 * k]) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(pairs[2 * k + 1])];
  }
  return {};
}

Status MeasureCosts::rows(int begin, int end, Span<double> value) noexcept {
  const Clock::time_point start = Clock::now();
  const Status status = cost_.rows(a_, b_, begin, end, value);
  seconds_ += since(start);
  evaluated_ += static_cast<long>(value.size());
  if (!status.ok()) return status;
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (usable(value[k])) continue;
    const int columns = column_count(), at = static_cast<int>(k);
    return not_finite(begin + at / columns, at % columns, value[k]);
  }
  return {};
}

Status MeasureCosts::lower_bounds(int begin, int end, Span<double> value) noexcept {
  const Clock::time_point start = Clock::now();
  const Status status = cost_.lower_bounds(a_, b_, begin, end, value);
  seconds_ += since(start);
  return status;
}

Status MeasureCosts::evaluate(Span<const int> pairs, Span<double> value) noexcept {
  const Clock::time_point start = Clock::now();
  const Status status = cost_.evaluate(a_, b_, pairs, value, {});
  seconds_ += since(start);
  evaluated_ += static_cast<long>(value.size());
  if (!status.ok()) return status;
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (!usable(value[k])) return not_finite(pairs[2 * k], pairs[2 * k + 1], value[k]);
  }
  return {};
}

}  // namespace bowstring
