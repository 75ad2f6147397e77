#pragma once

#include <cstddef>

namespace bowstring::simplex {

// What is done to every row of a matrix of costs, at the processor's width. No sum depends on that width, so that the
// bits are the same everywhere. No number is NaN.

struct Minimum {
  double value;  ///< +∞ where there is none that is finite
  int from;      ///< it stands here or a little farther on
};

/// min over j < count of cost[j] + add[j], where add is not −∞.
Minimum row_minimum(const double* cost, const double* add, int count) noexcept;

/// The first place of a minimum that is finite.
int place_of(const Minimum& minimum, const double* cost, const double* add) noexcept;

/// The largest |cost[j]| below `barrier`, or 0.
double largest_below(const double* cost, std::size_t count, double barrier) noexcept;

/// What one row of reduced costs cost[j] + add[j] − of_row tells.
struct RowLook {
  double least;  ///< of all
  double slack;  ///< least of those above the tolerance
  long within;   ///< how many are not above it
};
RowLook look_at_row(const double* cost, const double* add, double of_row, double tolerance, int count) noexcept;

}  // namespace bowstring::simplex
