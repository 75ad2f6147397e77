#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::softening {

/// lower ≤ r ≤ upper of every row of a problem.
class RowSides {
 public:
  explicit RowSides(const Problem& problem);

  double lower(int row) const noexcept { return lower_[static_cast<std::size_t>(row)]; }
  double upper(int row) const noexcept { return upper_[static_cast<std::size_t>(row)]; }
  bool is_equality(int row) const noexcept { return lower(row) == upper(row); }

  /// mm, ≥ 0: by how much a row misses its bounds.
  double violation(int row, double value) const noexcept;
  /// mm, of the bound that a multiplier belongs to: positive where the row is beyond it. Of an equality as its
  /// multiplier counts it.
  double excess(int row, double value, double multiplier) const noexcept;

 private:
  std::vector<double> lower_, upper_;
};

}  // namespace bowstring::softening
