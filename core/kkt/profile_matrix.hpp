#pragma once

#include <cstddef>
#include <vector>

#include "core/interfaces/span.hpp"

namespace bowstring::kkt {

/// What a factorization without pivoting tells of itself.
struct PivotReport {
  int negative = 0;          ///< pivots below zero
  int vanishing = 0;         ///< pivots that rounding alone decides: 0 where the factor exists
  int first_vanishing = -1;  ///< where the first of them stands
  double growth = 1.0;       ///< largest |L_ij² d_j| over the largest diagonal entry that went in
};

/// A symmetric matrix whose column c is stored from its diagonal down to row last(c), and its LDLᵀ factors in the same
/// place. No pivoting: made for matrices that have a factor in the order given (quasi-definite ones, Vanderbei 1995;
/// R. S. Martin and J. H. Wilkinson, Numer. Math. 7 (1965) 355 for the storage). Work is Σ (last(c) − c)².
class ProfileMatrix {
 public:
  /// Zeros that stand behind each column, so that four numbers can be taken at a time.
  static constexpr int padding = 3;

  /// last[c] ≥ c: the last row that column c may ever have an entry in. It is widened until it never decreases from one
  /// column to the next, so that factors fit in. Allocates.
  void shape(std::vector<int> last);
  int size() const noexcept { return static_cast<int>(last_.size()); }
  /// Numbers that are stored.
  std::size_t stored() const noexcept { return values_.size(); }
  /// Index of a column's diagonal entry; the column's others follow.
  int begin(int column) const noexcept { return begin_[static_cast<std::size_t>(column)]; }
  int last(int column) const noexcept { return last_[static_cast<std::size_t>(column)]; }

  /// Index of entry (row ≥ column) in `values`, −1 where it is not stored.
  int index(int row, int column) const noexcept {
    return row <= last(column) ? begin_[static_cast<std::size_t>(column)] + row - column : -1;
  }
  std::vector<double>& values() noexcept { return values_; }
  const std::vector<double>& values() const noexcept { return values_; }
  void clear() noexcept;

  /// Replaces the matrix by its factors. Entries that are zero at the lower end of a column cost nothing.
  PivotReport factor() noexcept;
  /// x ← A⁻¹ x, with the factors. `padding` finite numbers behind x are read, and stay as they are.
  void solve(double* x) const noexcept;

 private:
  std::vector<int> last_, begin_;
  std::vector<double> values_;
  std::vector<int> reach_;  // of the factor: last row of a column
  std::vector<double> pivot_;
};

}  // namespace bowstring::kkt
