#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

namespace bowstring {

/// Two numbers side by side (GCC and Clang).
using TwoNumbers [[gnu::vector_size(2 * sizeof(double))]] = double;

/// Whether all numbers are finite: 0·x is 0 for these and not a number for the others, in sums that do not wait for
/// each other.
inline bool all_finite(const double* numbers, std::size_t count) noexcept {
  constexpr std::size_t lanes = 8;
  TwoNumbers a{}, b{}, c{}, d{};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    TwoNumbers x[lanes / 2];
    std::memcpy(x, numbers + i, sizeof x);
    a += 0.0 * x[0];
    b += 0.0 * x[1];
    c += 0.0 * x[2];
    d += 0.0 * x[3];
  }
  double sum = 0.0;
  for (; i < count; ++i) sum += 0.0 * numbers[i];
  a += b + (c + d);
  return sum + a[0] + a[1] == 0.0;
}

}  // namespace bowstring
