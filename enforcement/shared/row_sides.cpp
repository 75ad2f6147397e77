#include "enforcement/shared/row_sides.hpp"

#include <algorithm>

namespace bowstring::softening {

RowSides::RowSides(const Problem& problem)
    : lower_(problem.row_lower().begin(), problem.row_lower().end()),
      upper_(problem.row_upper().begin(), problem.row_upper().end()) {}

double RowSides::violation(int row, double value) const noexcept {
  return std::max({0.0, value - upper(row), lower(row) - value});
}

double RowSides::excess(int row, double value, double multiplier) const noexcept {
  if (multiplier == 0.0) return violation(row, value);
  return multiplier > 0.0 ? value - upper(row) : lower(row) - value;
}

}  // namespace bowstring::softening
