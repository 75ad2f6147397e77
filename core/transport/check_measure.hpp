#pragma once

#include <string>
#include <vector>

#include "core/interfaces/measure.hpp"

namespace bowstring {

/// How far two sums of weights may be apart, relative to the larger, and still be taken for equal.
inline constexpr double weight_sum_tolerance = 1e-9;

/// What is wrong with one place of a measure, or with all of it.
struct MeasureFlaw {
  long index = -1;  ///< from 0; −1: the measure as a whole
  std::string found, expected, mend;
};

/// No places, numbers that are not finite, weights that are negative or all zero, orientations that are no rotations
/// (|q| off 1 by more than 1e-6), sizes that do not fit. Empty where all is well.
std::vector<MeasureFlaw> flaws_of(const Measure& measure);

/// Whether sums of weights differ by more than the tolerance; "" where they do not.
std::string sum_mismatch(const std::vector<double>& weight_a, const std::vector<double>& weight_b);

/// 1/count each.
std::vector<double> uniform_weights(std::size_t count);

}  // namespace bowstring
