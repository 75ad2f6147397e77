#pragma once

#include <cmath>
#include <cstddef>

namespace bowstring {

/// Whether all numbers are finite: 0·x is 0 for these and not a number for the others, in sums that do not wait for
/// each other.
inline bool all_finite(const double* numbers, std::size_t count) noexcept {
  constexpr std::size_t lanes = 8;
  double sum[lanes] = {};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sum[k] += 0.0 * numbers[i + k];
  }
  for (; i < count; ++i) sum[0] += 0.0 * numbers[i];
  double total = 0.0;
  for (const double lane : sum) total += lane;
  return total == 0.0;
}

}  // namespace bowstring
