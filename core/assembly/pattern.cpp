#include "core/assembly/pattern.hpp"

#include <algorithm>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Adds first … end − 1 to disjoint runs that do not touch each other, in increasing order. Rows come in order along
/// the curves, so that the place is most often the last one.
void unite(std::vector<RowBlocks::Run>& runs, int first, int end) {
  std::size_t after = runs.size();
  while (after > 0 && runs[after - 1].first > end) --after;
  if (after == 0 || runs[after - 1].end < first) {
    runs.insert(runs.begin() + static_cast<std::ptrdiff_t>(after), {first, end});
    return;
  }
  const std::size_t last = after - 1;
  std::size_t lowest = last;
  while (lowest > 0 && runs[lowest - 1].end >= first) --lowest;
  runs[lowest] = {std::min(runs[lowest].first, first), std::max(runs[last].end, end)};
  runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(lowest + 1), runs.begin() + static_cast<std::ptrdiff_t>(after));
}

}  // namespace

void RowBlocks::clear() {
  runs.clear();
  begin.assign(1, 0);
}

void RowBlocks::add_row(const int* blocks, int count) {
  for (int k = 0; k < count; ++k) {
    if (k > 0 && blocks[k] == blocks[k - 1] + 1) {
      ++runs.back().end;
    } else {
      runs.push_back({blocks[k], blocks[k] + 1});
    }
  }
  begin.push_back(static_cast<int>(runs.size()));
}

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
  pair_begin_.assign(1, 0);
  auto key = keys_.begin();
  for (int column = 0; column < blocks; ++column) {
    int before = 0;
    for (; key != keys_.end() && static_cast<int>(*key >> 32U) == column; ++key) {
      add_pair(layout, static_cast<int>(*key & 0xffffffffU), column, before);
    }
    pair_begin_.push_back(static_cast<int>(pairs_.size()));
  }
  keys_.clear();
  keys_.shrink_to_fit();
  fill_entries(layout);
}

void HessianPattern::add_pair(const BlockLayout& layout, int row_block, int column_block, int& before) {
  pairs_.push_back({row_block, column_block});
  pair_offset_.push_back(before);
  if (row_block != column_block) before += layout.size(row_block);
}

void HessianPattern::fill_entries(const BlockLayout& layout) {
  begin_.resize(layout.block_of_unknown.size() + 1);
  std::size_t entries = 0;
  for (int block = 0; block < layout.blocks(); ++block) {
    const int last = pair_begin_[at(block) + 1] - 1;
    const int row_block = pairs_[at(last)].row;
    const int below = row_block == block ? 0 : pair_offset_[at(last)] + layout.size(row_block);
    const int end = layout.begin[at(block) + 1];
    for (int j = layout.begin[at(block)]; j < end; ++j) {
      begin_[at(j)] = static_cast<int>(entries);
      entries += at(end - j + below);
    }
  }
  begin_.back() = static_cast<int>(entries);
  inner_.resize(entries);

  for (int block = 0; block < layout.blocks(); ++block) {
    int* out = inner_.data() + begin_[at(layout.begin[at(block)])];
    for (int p = pair_begin_[at(block)]; p < pair_begin_[at(block) + 1]; ++p) {
      const int row_block = pairs_[at(p)].row;
      for (int i = layout.begin[at(row_block)]; i < layout.begin[at(row_block) + 1]; ++i) *out++ = i;
    }
    for (int j = layout.begin[at(block)] + 1; j < layout.begin[at(block) + 1]; ++j) {
      const int* before = inner_.data() + begin_[at(j) - 1] + 1;
      std::copy(before, before + (begin_[at(j) + 1] - begin_[at(j)]), inner_.data() + begin_[at(j)]);
    }
  }
}

void HessianPattern::assign(const BlockLayout& layout, const HessianPattern& lasting, const RowBlocks& rows,
                            std::vector<int>& position) {
  const int blocks = layout.blocks();
  find_readers(rows, blocks);
  pairs_.clear();
  pair_offset_.clear();
  pair_begin_.assign(1, 0);
  lasting_offset_.resize(lasting.pairs_.size());
  for (int block = 0; block < blocks; ++block) {
    merge_column(layout, lasting, rows, block);
    pair_begin_.push_back(static_cast<int>(pairs_.size()));
  }
  fill_entries(layout);
  place_entries(layout, lasting, position);
}

void HessianPattern::find_readers(const RowBlocks& rows, int blocks) {
  next_reader_.assign(at(blocks) + 1, 0);  // first by how much the number of readers changes at a block
  for (const RowBlocks::Run& run : rows.runs) {
    ++next_reader_[at(run.first)];
    --next_reader_[at(run.end)];
  }
  reader_begin_.assign(1, 0);
  for (int block = 0, readers = 0; block < blocks; ++block) {
    readers += next_reader_[at(block)];
    next_reader_[at(block)] = reader_begin_.back();
    reader_begin_.push_back(reader_begin_.back() + readers);
  }
  readers_.resize(at(reader_begin_.back()));
  for (int r = 0; r < rows.rows(); ++r) {
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) {
      const RowBlocks::Run& run = rows.runs[at(k)];
      for (int block = run.first; block < run.end; ++block) readers_[at(next_reader_[at(block)]++)] = r;
    }
  }
}

void HessianPattern::merge_column(const BlockLayout& layout, const HessianPattern& lasting, const RowBlocks& rows,
                                  int column_block) {
  column_.clear();
  for (int k = reader_begin_[at(column_block)]; k < reader_begin_[at(column_block) + 1]; ++k) {
    const int row = readers_[at(k)];
    for (int j = rows.begin[at(row)]; j < rows.begin[at(row) + 1]; ++j) {
      const RowBlocks::Run& run = rows.runs[at(j)];
      if (run.end > column_block) unite(column_, std::max(run.first, column_block), run.end);
    }
  }
  int before = 0;
  int k = lasting.pair_begin_[at(column_block)];
  const int end = lasting.pair_begin_[at(column_block) + 1];
  const auto next = [&] { return lasting.pairs_[at(k)].row; };
  for (const RowBlocks::Run& run : column_) {
    while (k < end && next() < run.first) {
      lasting_offset_[at(k)] = before;
      add_pair(layout, next(), column_block, before);
      ++k;
    }
    for (int row = run.first; row < run.end; ++row) {
      if (k < end && next() == row) lasting_offset_[at(k++)] = before;
      add_pair(layout, row, column_block, before);
    }
  }
  for (; k < end; ++k) {
    lasting_offset_[at(k)] = before;
    add_pair(layout, next(), column_block, before);
  }
}

void HessianPattern::place_entries(const BlockLayout& layout, const HessianPattern& lasting,
                                   std::vector<int>& position) const {
  position.resize(lasting.inner_.size());
  int* out = position.data();
  for (int block = 0; block < layout.blocks(); ++block) {
    const int end = layout.begin[at(block) + 1];
    for (int j = layout.begin[at(block)]; j < end; ++j) {
      const int below = begin_[at(j)] + end - j;
      for (int to = begin_[at(j)]; to < below; ++to) *out++ = to;
      for (int p = lasting.pair_begin_[at(block)] + 1; p < lasting.pair_begin_[at(block) + 1]; ++p) {
        const int first = below + lasting_offset_[at(p)];
        const int size = layout.size(lasting.pairs_[at(p)].row);
        for (int i = 0; i < size; ++i) *out++ = first + i;
      }
    }
  }
}

int HessianPattern::find_pair(int row_block, int column_block, int guess) const noexcept {
  int low = pair_begin_[at(column_block)];
  int high = pair_begin_[at(column_block) + 1];
  if (guess >= low && guess < high && pairs_[at(guess)].row == row_block) return guess;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (pairs_[at(middle)].row <= row_block ? low : high) = middle;
  }
  return low;
}

int HessianPattern::position(const BlockLayout& layout, int i, int j) const noexcept {
  const int row = std::max(i, j);
  const int column = std::min(i, j);
  const int row_block = layout.block_of_unknown[at(row)];
  const int column_block = layout.block_of_unknown[at(column)];
  if (row_block == column_block) return begin_[at(column)] + row - column;
  const int diagonal = layout.begin[at(column_block) + 1] - column;
  return begin_[at(column)] + diagonal + pair_offset(find_pair(row_block, column_block, -1)) + row -
         layout.begin[at(row_block)];
}

void JacobianPattern::keep(int rows) {
  begin_.resize(at(rows) + 1);
  inner_.resize(at(begin_.back()));
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

int JacobianPattern::add_run(int first, int count) {
  const int position = static_cast<int>(inner_.size());
  for (int k = 0; k < count; ++k) inner_.push_back(first + k);
  return position;
}

int JacobianPattern::position(int row, int unknown) const noexcept {
  const auto first = inner_.begin() + begin_[at(row)];
  const auto last = inner_.begin() + begin_[at(row) + 1];
  return static_cast<int>(std::lower_bound(first, last, unknown) - inner_.begin());
}

}  // namespace bowstring
