#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::newton {

/// One finite side of an inequality row or of a bounded unknown: sign·(value − bound) ≤ 0.
struct Side {
  int index = 0;  ///< row, or unknown
  double sign = 1.0;
  double bound = 0.0;
  double violation(double value) const noexcept { return sign * (value - bound); }
};

std::vector<Side> sides_of_rows(const Problem& problem);
std::vector<Side> sides_of_unknowns(const Problem& problem);
std::vector<int> equality_rows(const Problem& problem);

}  // namespace bowstring::newton
