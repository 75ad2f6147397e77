#pragma once

#include <cstdint>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring {

/// The free unknowns grouped into blocks, one per entry of a field, so that sparsity is found block by block and a
/// chart can transform whole blocks.
struct BlockLayout {
  std::vector<int> begin;             ///< blocks + 1: first free unknown of each block
  std::vector<int> block_of_unknown;  ///< per free unknown
  int blocks() const noexcept { return static_cast<int>(begin.size()) - 1; }
  int size(int block) const noexcept {
    return begin[static_cast<std::size_t>(block) + 1] - begin[static_cast<std::size_t>(block)];
  }
};

/// Lower triangle of a symmetric matrix, compressed by columns, dense within pairs of blocks.
class HessianPattern {
 public:
  /// Declares that all the given free unknowns (−1 ignored) are coupled with each other.
  void couple(const BlockLayout& layout, const int* unknowns, int count);
  void finish(const BlockLayout& layout);

  SparsityPattern view() const noexcept { return {begin_, inner_}; }
  /// Position of entry (i, j) or (j, i), whichever lies in the lower triangle. The pair has been coupled.
  int position(const BlockLayout& layout, int i, int j) const noexcept;

  /// Blocks (row ≥ column) that are stored.
  struct Pair {
    int row, column;
  };
  const std::vector<Pair>& pairs() const noexcept { return pairs_; }

 private:
  int offset(const BlockLayout& layout, int row_block, int column_block) const noexcept;

  std::vector<std::uint64_t> keys_;
  std::vector<Pair> pairs_;       // sorted by (column, row)
  std::vector<int> pair_begin_;   // per column block
  std::vector<int> pair_offset_;  // entries before this pair in a column of its column block, diagonal apart
  std::vector<int> begin_, inner_;
};

/// Rows of a Jacobian, each with its free unknowns in increasing order.
class JacobianPattern {
 public:
  void clear();
  /// Appends a row that reads the given free unknowns (−1 and repetitions ignored).
  void add_row(const int* unknowns, int count);
  SparsityPattern view() const noexcept { return {begin_, inner_}; }
  int position(int row, int unknown) const noexcept;

 private:
  std::vector<int> begin_{0}, inner_;
};

}  // namespace bowstring
