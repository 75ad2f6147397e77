#pragma once

namespace bowstring {

/// f'(0) from f(−2h), f(−h), f(h), f(2h); the error is of order h⁴.
constexpr double first_difference(double f_minus2, double f_minus1, double f_plus1, double f_plus2, double h) noexcept {
  return (f_minus2 - f_plus2 + 8.0 * (f_plus1 - f_minus1)) / (12.0 * h);
}

/// f''(0), likewise, with f(0) in the middle.
constexpr double second_difference(double f_minus2, double f_minus1, double f_zero, double f_plus1, double f_plus2,
                                   double h) noexcept {
  return (16.0 * (f_plus1 + f_minus1) - f_plus2 - f_minus2 - 30.0 * f_zero) / (12.0 * h * h);
}

}  // namespace bowstring
