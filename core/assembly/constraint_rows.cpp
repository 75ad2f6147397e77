#include "core/assembly/constraint_rows.hpp"

#include <algorithm>
#include <limits>

#include "core/assembly/finite.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int rows_per_part = 8;                          // whose second derivatives stay in the nearest cache
constexpr int max_block = 32;                             // unknowns of a place
constexpr int no_base = std::numeric_limits<int>::min();  // of a pair with a held place

/// B of one place that a row reads; null where B = I.
const double* place_jacobian(const std::vector<SiteTable>& tables, const ConstraintRows::Read& read) noexcept {
  if (read.identity) return nullptr;
  return tables[at(read.table)].jacobian.data() + at(read.index * read.values * read.width);
}

double entry(const double* b, int value, int unknown, int width) noexcept {
  if (b == nullptr) return value == unknown ? 1.0 : 0.0;
  return b[value * width + unknown];
}

/// (BₐᵀHBᵦ)ᵢⱼ where the places' y begin at `row_y` and `column_y` of the packed H.
double congruence(const double* h, const ConstraintRows::Read& a, const double* ba, int row_y, int i,
                  const ConstraintRows::Read& b, const double* bb, int column_y, int j) noexcept {
  double sum = 0.0;
  for (int y = 0; y < a.values; ++y) {
    const double left = entry(ba, y, i, a.width);
    if (left == 0.0) continue;
    for (int z = 0; z < b.values; ++z) {
      const int row = row_y + y;
      const int column = column_y + z;
      const double second = h[row >= column ? packed_index(row, column) : packed_index(column, row)];
      sum += left * entry(bb, z, j, b.width) * second;
    }
  }
  return sum;
}

}  // namespace

int ConstraintRows::part_end(int row) const noexcept {
  return in_parts ? std::min(row + rows_per_part, rows()) : rows();
}

bool ConstraintRows::reads_as(const RowDeclaration& declaration, const std::vector<int>& table_of) const noexcept {
  if (read_begin != declaration.place_begin) return false;
  for (std::size_t k = 0; k < reads.size(); ++k) {
    const Place& place = declaration.places[k];
    const int table = table_of[at(place.curve * site_count + static_cast<int>(place.site))];
    if (reads[k].index != place.index || reads[k].table != table) return false;
  }
  return true;
}

int ConstraintRows::bind(const RowDeclaration& declaration, const std::vector<int>& table_of,
                         std::vector<SiteTable>& tables) {
  in_parts = declaration.in_parts;
  identity = true;
  read_begin = declaration.place_begin;
  reads.resize(declaration.places.size());
  unknown.clear();
  jacobian_begin.assign(1, 0);
  hessian_begin.assign(1, 0);
  unknown_begin.assign(1, 0);
  for (int r = 0; r < rows(); ++r) {
    int numbers = 0, unknowns = 0;
    for (int p = read_begin[at(r)]; p < read_begin[at(r) + 1]; ++p) {
      const Place& place = declaration.places[at(p)];
      const int index = table_of[at(place.curve * site_count + static_cast<int>(place.site))];
      if (index < 0 || place.index < 0 || place.index >= tables[at(index)].count()) return r;
      SiteTable& table = tables[at(index)];
      table.read = true;
      const int width = table.width();
      reads[at(p)] = {index,
                      place.index,
                      table.values(),
                      width,
                      numbers,
                      unknowns,
                      table.block[at(place.index)],
                      table.declaration->identity};
      identity = identity && table.declaration->identity;
      numbers += table.values();
      unknowns += width;
      const int* of_place = table.free_unknown.data() + place.index * width;
      unknown.insert(unknown.end(), of_place, of_place + width);
    }
    jacobian_begin.push_back(jacobian_begin.back() + numbers);
    hessian_begin.push_back(hessian_begin.back() + packed_size(numbers));
    unknown_begin.push_back(static_cast<int>(unknown.size()));
  }
  reserve_derivatives();
  return -1;
}

void ConstraintRows::reserve_derivatives() {
  jacobian.resize(at(jacobian_begin.back()));
  int largest = 0;
  for (int r = 0; r < rows(); r = part_end(r)) {
    largest = std::max(largest, hessian_begin[at(part_end(r))] - hessian_begin[at(r)]);
  }
  hessian.resize(at(largest));
  all_places.resize(at(rows()));
  for (int r = 0; r < rows(); ++r) all_places[at(r)] = {0, 0, read_begin[at(r) + 1] - read_begin[at(r)]};
  jacobian_support = hessian_support = all_places;
}

void ConstraintRows::sort_places(int row) noexcept {
  const Read* of_row = reads.data() + read_begin[at(row)];
  int* sorted = by_block.data() + read_begin[at(row)];
  for (int p = 0; p < all_places[at(row)].count; ++p) {
    int k = p;
    for (; k > 0 && of_row[sorted[k - 1]].block > of_row[p].block; --k) sorted[k] = sorted[k - 1];
    sorted[k] = p;
  }
}

/// The number of unknowns of each place of a row as `Blocks` has them; 0 of other rows.
int ConstraintRows::block_of(int row) const noexcept {
  const int first = read_begin[at(row)], end = read_begin[at(row) + 1];
  for (int k = first; k < end; ++k) {
    const Read& read = reads[at(first + by_block[at(k)])];
    if (!read.identity || read.width != reads[at(first)].width || read.block == SiteTable::mixed) return 0;
    const bool shared = k > first && read.block >= 0 && reads[at(first + by_block[at(k - 1)])].block == read.block;
    if (shared) return 0;
  }
  return first == end ? 0 : reads[at(first)].width;
}

void ConstraintRows::add_patterns(const BlockLayout& layout, RowBlocks& row_blocks, JacobianPattern& jacobian_pattern) {
  blocks.resize(at(rows()));
  by_block.resize(reads.size());
  jacobian_position.resize(unknown.size());
  for (int r = 0; r < rows(); ++r) {
    const int* u = unknown.data() + unknown_begin[at(r)];
    const int count = unknown_begin[at(r) + 1] - unknown_begin[at(r)];
    int* position = jacobian_position.data() + unknown_begin[at(r)];
    sort_places(r);
    const int block = block_of(r);
    blocks[at(r)] = {block, 0, 0};
    row_blocks_.clear();
    if (block == 0) {
      for (int a = 0; a < count; ++a) {
        if (u[a] >= 0) row_blocks_.push_back(layout.block_of_unknown[at(u[a])]);
      }
      std::sort(row_blocks_.begin(), row_blocks_.end());
      row_blocks_.erase(std::unique(row_blocks_.begin(), row_blocks_.end()), row_blocks_.end());
      jacobian_pattern.add_row(u, count);
      const int row = jacobian_pattern.rows() - 1;
      for (int a = 0; a < count; ++a) position[a] = u[a] < 0 ? -1 : jacobian_pattern.position(row, u[a]);
    } else {
      const int* sorted = by_block.data() + read_begin[at(r)];
      for (int k = 0; k < all_places[at(r)].count; ++k) {
        const int of_block = reads[at(read_begin[at(r)] + sorted[k])].block;
        const int first = sorted[k] * block;
        const bool free = of_block >= 0;
        const int start = free ? jacobian_pattern.add_run(u[first], block) : 0;
        for (int a = 0; a < block; ++a) position[first + a] = free ? start + a : -1;
        if (free) row_blocks_.push_back(of_block);
      }
      jacobian_pattern.end_row();
    }
    row_blocks.add_row(row_blocks_.data(), static_cast<int>(row_blocks_.size()));
  }
}

/// Whether a row reads the places of the one before it, as those do that hold one place along several axes.
bool ConstraintRows::repeats(int row) const noexcept {
  if (row == 0 || all_places[at(row)].count != all_places[at(row - 1)].count) return false;
  const Read* now = reads.data() + read_begin[at(row)];
  const Read* before = reads.data() + read_begin[at(row - 1)];
  for (int p = 0; p < all_places[at(row)].count; ++p) {
    if (now[p].index != before[p].index || now[p].table != before[p].table) return false;
  }
  return true;
}

void ConstraintRows::locate_blocks(int row, const BlockLayout& layout, const HessianPattern& pattern) {
  Blocks& found = blocks[at(row)];
  if (repeats(row)) {
    found = blocks[at(row - 1)];
    return;
  }
  found.first_base = static_cast<int>(base.size());
  found.first_length = static_cast<int>(length.size());
  const int places = all_places[at(row)].count;
  base.resize(base.size() + at(packed_size(places)));
  length.resize(length.size() + at(places));
  int* of_pair = base.data() + found.first_base;
  int* of_place = length.data() + found.first_length;
  const Read* of_row = reads.data() + read_begin[at(row)];
  const int* u = unknown.data() + unknown_begin[at(row)];
  const int* sorted = by_block.data() + read_begin[at(row)];
  const int* begin = pattern.view().begin.data();
  int first_free = 0;
  while (first_free < places && of_row[sorted[first_free]].block < 0) of_place[sorted[first_free++]] = 0;
  if (first_free > 0) std::fill(of_pair, of_pair + packed_size(places), no_base);
  for (int a = first_free; a < places; ++a) {
    const int s = sorted[a];
    const int column_block = of_row[s].block, column = u[s * found.block];
    const int below = begin[column] + layout.begin[at(column_block) + 1] - column;
    of_place[s] = begin[column + 1] - begin[column];
    of_pair[packed_index(s, s)] = begin[column];
    int pair = pattern.diagonal_pair(column_block);
    for (int b = a + 1, before = column_block; b < places; ++b) {
      const int p = sorted[b];
      const int row_block = of_row[p].block;
      if (row_block == before + 1) {
        ++pair;
      } else {
        int& last = last_pair_[at(column_block)];
        last = pair = pattern.find_pair(row_block, column_block, last + 1);
      }
      before = row_block;
      const int first = below + pattern.pair_offset(pair) + u[p * found.block] - layout.begin[at(row_block)];
      of_pair[p > s ? packed_index(p, s) : packed_index(s, p)] = p > s ? first : ~first;
    }
  }
}

void ConstraintRows::locate_entries(int row, const BlockLayout& layout, const HessianPattern& pattern) {
  const int* u = unknown.data() + unknown_begin[at(row)];
  const int count = unknown_begin[at(row) + 1] - unknown_begin[at(row)];
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b <= a; ++b) {
      hessian_position.push_back(u[a] < 0 || u[b] < 0 ? -1 : pattern.position(layout, u[a], u[b]));
    }
  }
}

void ConstraintRows::locate(const BlockLayout& layout, const HessianPattern& hessian_pattern) {
  last_pair_.resize(at(layout.blocks()), -1);
  hessian_position.clear();
  base.clear();
  length.clear();
  hessian_position_begin.assign(1, 0);
  for (int r = 0; r < rows(); ++r) {
    if (blocks[at(r)].block != 0) {
      locate_blocks(r, layout, hessian_pattern);
    } else {
      locate_entries(r, layout, hessian_pattern);
    }
    hessian_position_begin.push_back(static_cast<int>(hessian_position.size()));
  }
}

void ConstraintRows::take_positions(const ConstraintRows& other) {
  jacobian_position = other.jacobian_position;
  hessian_position = other.hessian_position;
  hessian_position_begin = other.hessian_position_begin;
  blocks = other.blocks;
  base = other.base;
  length = other.length;
}

const ConstraintRows::Read& ConstraintRows::read_of(int row, const RowSupport& support, int k) const noexcept {
  return reads[at(read_begin[at(row)] + support.place(k))];
}

int ConstraintRows::values_of(int row, const RowSupport& support) const noexcept {
  if (blocks[at(row)].block != 0) return blocks[at(row)].block * support.places();
  int values = 0;
  for (int k = 0; k < support.places(); ++k) values += read_of(row, support, k).values;
  return values;
}

bool ConstraintRows::fits(int row, const RowSupport& support) const noexcept {
  const int places = all_places[at(row)].count;
  return support.lead >= 0 && support.count >= 0 && support.first >= support.lead &&
         support.first <= places - support.count;
}

int ConstraintRows::flawed_jacobian_row() const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const auto count = at(values_of(r, jacobian_support[at(r)]));
    if (!all_finite(jacobian.data() + jacobian_begin[at(r)], count)) return r;
  }
  return -1;
}

int ConstraintRows::flawed_hessian_row(int first, int end) const noexcept {
  for (int r = first; r < end; ++r) {
    const auto count = at(packed_size(values_of(r, hessian_support[at(r)])));
    if (!all_finite(hessian.data() + hessian_begin[at(r)] - hessian_begin[at(first)], count)) return r;
  }
  return -1;
}

void ConstraintRows::add_jacobian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const RowSupport& support = jacobian_support[at(r)];
    const double* r_y = jacobian.data() + jacobian_begin[at(r)];
    const int* row_position = jacobian_position.data() + unknown_begin[at(r)];
    if (const int block = blocks[at(r)].block; block != 0) {
      for (int p = 0; p < support.places(); ++p, r_y += block) {
        const int position = row_position[support.place(p) * block];
        if (position < 0) continue;
        for (int k = 0; k < block; ++k) out[at(position + k)] += r_y[k];
      }
      continue;
    }
    for (int p = 0; p < support.places(); ++p) {
      const Read& read = read_of(r, support, p);
      const double* b = place_jacobian(tables, read);
      const int* position = row_position + read.first_unknown;
      for (int k = 0; k < read.width; ++k) {
        if (position[k] < 0) continue;
        double sum = b == nullptr ? r_y[k] : 0.0;
        for (int a = 0; b != nullptr && a < read.values; ++a) sum += r_y[a] * b[a * read.width + k];
        out[at(position[k])] += sum;
      }
      r_y += read.values;
    }
  }
}

void ConstraintRows::add_hessian(int first, int end, const std::vector<SiteTable>& tables,
                                 Span<double> out) const noexcept {
  for (int r = first; r < end; ++r) {
    const double* h = hessian.data() + hessian_begin[at(r)] - hessian_begin[at(first)];
    switch (blocks[at(r)].block) {
      case 0:
        add_row_hessian(r, h, tables, out);
        break;
      case 2:
        add_block_hessian<2>(r, h, out.data());
        break;
      case 3:
        add_block_hessian<3>(r, h, out.data());
        break;
      default:
        add_block_hessian<0>(r, h, out.data());
    }
  }
}

/// In a large matrix a row's entries are far apart: those of the next row, whose support is likely the same, are asked
/// for while this one is added.
void ConstraintRows::fetch_ahead(int row, const RowSupport& support, const double* out) const noexcept {
  if (blocks[at(row)].block == 0 || !fits(row, support)) return;
  const int* of_pair = base.data() + blocks[at(row)].first_base;
  for (int p = 0; p < support.places(); ++p) {
    for (int s = 0; s <= p; ++s) {
      const int first = of_pair[packed_index(support.place(p), support.place(s))];
      if (first != no_base) __builtin_prefetch(out + (first < 0 ? ~first : first), 1);
    }
  }
}

template <int fixed_block>
void ConstraintRows::add_block_hessian(int row, const double* h, double* out) const noexcept {
  const Blocks& found = blocks[at(row)];
  const int block = fixed_block == 0 ? found.block : fixed_block;
  const RowSupport& support = hessian_support[at(row)];
  const int* of_pair = base.data() + found.first_base;
  const int* of_place = length.data() + found.first_length;
  if (row + 1 < rows()) fetch_ahead(row + 1, support, out);
  for (int p = 0; p < support.places(); ++p) {
    const int place = support.place(p);
    const double* from[fixed_block == 0 ? max_block : fixed_block];  // the rows of h
    for (int i = 0; i < block; ++i) {
      from[i] = h;
      h += p * block + i + 1;
    }
    for (int s = 0; s <= p; ++s) {
      const int other = support.place(s);
      const int first = of_pair[packed_index(place, other)];
      if (first == no_base) continue;
      if (first < 0) {
        double* to = out + ~first;
        for (int i = 0; i < block; ++i) {
          for (int j = 0; j < block; ++j) to[j] += from[i][s * block + j];
          to += of_place[place] - i - 1;
        }
        continue;
      }
      double* to = out + first;
      for (int j = 0; j < block; ++j) {
        for (int i = s == p ? j : 0; i < block; ++i) to[i] += from[i][s * block + j];
        to += of_place[other] - j - 1;
      }
    }
  }
}

void ConstraintRows::add_row_hessian(int row, const double* h, const std::vector<SiteTable>& tables,
                                     Span<double> out) const noexcept {
  const RowSupport& support = hessian_support[at(row)];
  const int* position = hessian_position.data() + hessian_position_begin[at(row)];
  int row_y = 0;
  for (int p = 0; p < support.places(); ++p) {
    const Read& a = read_of(row, support, p);
    const double* ba = place_jacobian(tables, a);
    int column_y = 0;
    for (int s = 0; s <= p; ++s) {
      const Read& b = read_of(row, support, s);
      const double* bb = place_jacobian(tables, b);
      for (int i = 0; i < a.width; ++i) {
        for (int j = 0; j < b.width && a.first_unknown + i >= b.first_unknown + j; ++j) {
          const int where = position[packed_index(a.first_unknown + i, b.first_unknown + j)];
          if (where >= 0) out[at(where)] += congruence(h, a, ba, row_y, i, b, bb, column_y, j);
        }
      }
      column_y += b.values;
    }
    row_y += a.values;
  }
}

void ConstraintRows::add_stress(Span<const double> multipliers, std::vector<SiteTable>& tables) const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const double multiplier = multipliers[at(first_row + r)];
    const RowSupport& support = jacobian_support[at(r)];
    const double* r_y = jacobian.data() + jacobian_begin[at(r)];
    for (int p = 0; p < support.places(); ++p) {
      const Read& read = read_of(r, support, p);
      double* stress = tables[at(read.table)].total_stress.data() + at(read.index * read.values);
      for (int k = 0; k < read.values; ++k) stress[k] += multiplier * *r_y++;
    }
  }
}

}  // namespace bowstring
