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

/// The blocks that rows read: each row's as runs of consecutive blocks, in increasing order.
struct RowBlocks {
  struct Run {
    int first = 0, end = 0;
  };
  std::vector<Run> runs;
  std::vector<int> begin{0};  ///< rows + 1

  int rows() const noexcept { return static_cast<int>(begin.size()) - 1; }
  void clear();
  /// `blocks` increase.
  void add_row(const int* blocks, int count);
};

/// Lower triangle of a symmetric matrix, compressed by columns, dense within pairs of blocks.
class HessianPattern {
 public:
  /// Declares that all the given free unknowns (−1 ignored) are coupled with each other.
  void couple(const BlockLayout& layout, const int* unknowns, int count);
  void finish(const BlockLayout& layout);
  /// The pairs of `lasting`, and all pairs of blocks that a row reads, in time that grows with what is stored; where
  /// this has held as much before, nothing is allocated. `position` becomes, per entry of `lasting`, its position here.
  void assign(const BlockLayout& layout, const HessianPattern& lasting, const RowBlocks& rows,
              std::vector<int>& position);

  SparsityPattern view() const noexcept { return {begin_, inner_}; }
  /// Position of entry (i, j) or (j, i), whichever lies in the lower triangle. The pair has been coupled.
  int position(const BlockLayout& layout, int i, int j) const noexcept;

  /// Blocks (row ≥ column) that are stored.
  struct Pair {
    int row, column;
  };
  const std::vector<Pair>& pairs() const noexcept { return pairs_; }
  /// Index of the pair of a column block with itself, which is its first; the others follow by increasing row.
  int diagonal_pair(int column_block) const noexcept { return pair_begin_[static_cast<std::size_t>(column_block)]; }
  /// Index of a stored pair; found at once where it is `guess`.
  int find_pair(int row_block, int column_block, int guess) const noexcept;
  /// Entries before a pair in a column of its column block, those of the diagonal pair apart.
  int pair_offset(int pair) const noexcept { return pair_offset_[static_cast<std::size_t>(pair)]; }

 private:
  void add_pair(const BlockLayout& layout, int row_block, int column_block, int& before);
  void merge_column(const BlockLayout& layout, const HessianPattern& lasting, const RowBlocks& rows, int column_block);
  void find_readers(const RowBlocks& rows, int blocks);
  void fill_entries(const BlockLayout& layout);
  void place_entries(const BlockLayout& layout, const HessianPattern& lasting, std::vector<int>& position) const;

  std::vector<std::uint64_t> keys_;
  std::vector<Pair> pairs_;       // sorted by (column, row)
  std::vector<int> pair_begin_;   // per column block
  std::vector<int> pair_offset_;  // entries before this pair in a column of its column block, diagonal apart
  std::vector<int> begin_, inner_;
  // Of `assign`: the rows that read each block, the rows of one column, and where lasting pairs have come to stand.
  std::vector<int> reader_begin_, readers_, next_reader_;
  std::vector<RowBlocks::Run> column_;
  std::vector<int> lasting_offset_;
};

/// Rows of a Jacobian, each with its free unknowns in increasing order.
class JacobianPattern {
 public:
  void clear() { keep(0); }
  /// Leaves the first rows alone.
  void keep(int rows);
  /// Appends a row that reads the given free unknowns (−1 and repetitions ignored).
  void add_row(const int* unknowns, int count);
  /// Appends consecutive unknowns, larger than those before, to the row that `end_row` will end; answers the position
  /// of the first one.
  int add_run(int first, int count);
  void end_row() { begin_.push_back(static_cast<int>(inner_.size())); }
  int rows() const noexcept { return static_cast<int>(begin_.size()) - 1; }
  SparsityPattern view() const noexcept { return {begin_, inner_}; }
  int position(int row, int unknown) const noexcept;

 private:
  std::vector<int> begin_{0}, inner_;
};

}  // namespace bowstring
