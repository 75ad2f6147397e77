#pragma once

#include <cstdint>
#include <vector>

#include "core/interfaces/span.hpp"

namespace bowstring::simplex {

/// What rows have and columns get, in whole quanta, so that sums are exact.
struct Masses {
  std::vector<std::int64_t> supply, demand;  ///< one per row, one per column; not negative, of equal positive sums
  double quantum = 1.0;                      ///< weight of one
  std::int64_t noise = 0;                    ///< mass up to here on an arc is rounding of the weights
};

/// Weights as masses. Where those of each side are alike, apart from zeros, they are counts, and ties stay ties: the
/// common multiple of both numbers of places is the whole. Otherwise the whole is 2^60 quanta. Sums that differ by less
/// than `weight_sum_tolerance` are taken for their mean; others are a StatusError (`invalid_input`), as are weights
/// that are negative, not finite or all zero.
Masses masses_of(Span<const double> weight_a, Span<const double> weight_b);

}  // namespace bowstring::simplex
