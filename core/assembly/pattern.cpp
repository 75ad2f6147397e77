#include "core/assembly/pattern.hpp"

#include <algorithm>

namespace bowstring {

namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void HessianPattern::couple(const BlockLayout& layout, const int* unknowns, int count) {
  for (int a = 0; a < count; ++a) {
    if (unknowns[a] < 0) continue;
    const int block_a = layout.block_of_unknown[at(unknowns[a])];
    if (a > 0 && unknowns[a - 1] >= 0 && layout.block_of_unknown[at(unknowns[a - 1])] == block_a) continue;
    for (int b = 0; b <= a; ++b) {
      if (unknowns[b] < 0) continue;
      const int block_b = layout.block_of_unknown[at(unknowns[b])];
      const auto column = static_cast<std::uint64_t>(std::min(block_a, block_b));
      const auto row = static_cast<std::uint64_t>(std::max(block_a, block_b));
      const std::uint64_t key = (column << 32U) | row;
      if (keys_.empty() || keys_.back() != key) keys_.push_back(key);
    }
  }
}

void HessianPattern::finish(const BlockLayout& layout) {
  const int blocks = layout.blocks();
  for (int b = 0; b < blocks; ++b)
    keys_.push_back((static_cast<std::uint64_t>(b) << 32U) | static_cast<std::uint64_t>(b));
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());

  pairs_.clear();
  pair_offset_.clear();
  pair_begin_.assign(at(blocks) + 1, 0);
  int before = 0;
  int last_column = -1;
  for (const std::uint64_t key : keys_) {
    const int column = static_cast<int>(key >> 32U);
    const int row = static_cast<int>(key & 0xffffffffU);
    if (column != last_column) before = 0;
    last_column = column;
    pairs_.push_back({row, column});
    pair_offset_.push_back(before);
    if (row != column) before += layout.size(row);
    pair_begin_[at(column) + 1] = static_cast<int>(pairs_.size());
  }
  keys_.clear();
  keys_.shrink_to_fit();

  begin_.assign(1, 0);
  inner_.clear();
  for (int block = 0; block < blocks; ++block) {
    for (int j = layout.begin[at(block)]; j < layout.begin[at(block) + 1]; ++j) {
      for (int p = pair_begin_[at(block)]; p < pair_begin_[at(block) + 1]; ++p) {
        const int row_block = pairs_[at(p)].row;
        const int first = row_block == block ? j : layout.begin[at(row_block)];
        for (int i = first; i < layout.begin[at(row_block) + 1]; ++i) inner_.push_back(i);
      }
      begin_.push_back(static_cast<int>(inner_.size()));
    }
  }
}

int HessianPattern::offset(const BlockLayout& layout, int row_block, int column_block) const noexcept {
  (void)layout;
  int low = pair_begin_[at(column_block)];
  int high = pair_begin_[at(column_block) + 1];
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (pairs_[at(middle)].row <= row_block ? low : high) = middle;
  }
  return pair_offset_[at(low)];
}

int HessianPattern::position(const BlockLayout& layout, int i, int j) const noexcept {
  const int row = std::max(i, j);
  const int column = std::min(i, j);
  const int row_block = layout.block_of_unknown[at(row)];
  const int column_block = layout.block_of_unknown[at(column)];
  if (row_block == column_block) return begin_[at(column)] + row - column;
  const int diagonal = layout.begin[at(column_block) + 1] - column;
  return begin_[at(column)] + diagonal + offset(layout, row_block, column_block) + row - layout.begin[at(row_block)];
}

void JacobianPattern::clear() {
  begin_.assign(1, 0);
  inner_.clear();
}

void JacobianPattern::add_row(const int* unknowns, int count) {
  const auto first = inner_.size();
  for (int k = 0; k < count; ++k) {
    if (unknowns[k] >= 0) inner_.push_back(unknowns[k]);
  }
  const auto start = inner_.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(start, inner_.end());
  inner_.erase(std::unique(start, inner_.end()), inner_.end());
  begin_.push_back(static_cast<int>(inner_.size()));
}

int JacobianPattern::position(int row, int unknown) const noexcept {
  const auto first = inner_.begin() + begin_[at(row)];
  const auto last = inner_.begin() + begin_[at(row) + 1];
  return static_cast<int>(std::lower_bound(first, last, unknown) - inner_.begin());
}

}  // namespace bowstring
