#pragma once

#include <string>
#include <vector>

namespace bowstring::study {

/// What a sequence f(x) = f∞ + C x^−p goes to, x a resolution: a number of segments, or one over a mesh width.
struct Extrapolation {
  double limit = 0.0;   ///< f∞
  double order = 0.0;   ///< p; NaN where the finest values are equal to rounding
  double error = 0.0;   ///< estimate of |limit − f∞|
  std::string refusal;  ///< why there is no limit; "" where there is one

  bool ok() const noexcept { return refusal.empty(); }
};

/// Richardson's extrapolation from the three finest values, whose ratios of refinement may differ: p solves
/// (f₁ − f₂)/(f₂ − f₃) = (x₁^−p − x₂^−p)/(x₂^−p − x₃^−p) (Roache, J. Fluids Eng. 116:405, 1994). The error is how far
/// the limit from the three values before the finest is off, where there are four that give one, else what the
/// extrapolation adds to the finest value. Refused: fewer than three values, equal resolutions, a sequence that is not
/// monotone, p outside 0.3 … 6. `resolution` in any order, above 0; values that are not finite are left out.
Extrapolation extrapolate(const std::vector<double>& resolution, const std::vector<double>& value);

/// |f(a) − f(b)| at two resolutions, b the finer one; b infinite for |f(a) − f∞|.
struct Difference {
  double a, b, size;
};

/// ln |(a^−p − b^−p)/p|, what ln size is up to a constant.
double difference_shape(const Difference& difference, double order);

/// p from two differences, the fine one beyond the coarse one; held to −20 … 40.
double order_of_two(const Difference& coarse, const Difference& fine);

}  // namespace bowstring::study
