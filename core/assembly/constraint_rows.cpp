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

void ConstraintRows::reserve_derivatives() {
  jacobian.assign(at(jacobian_begin.back()), 0.0);
  int largest = 0;
  for (int r = 0; r < rows(); r = part_end(r)) {
    largest = std::max(largest, hessian_begin[at(part_end(r))] - hessian_begin[at(r)]);
  }
  hessian.assign(at(largest), 0.0);
  all_places.clear();
  for (int r = 0; r < rows(); ++r) all_places.push_back({0, 0, read_begin[at(r) + 1] - read_begin[at(r)]});
  jacobian_support = hessian_support = all_places;
}

/// The number of unknowns of each place, where it is the same for all and B = I; 0 otherwise.
int ConstraintRows::block_of(int row) const noexcept {
  const int first = read_begin[at(row)], end = read_begin[at(row) + 1];
  for (int p = first; p < end; ++p) {
    if (!reads[at(p)].identity || reads[at(p)].width != reads[at(first)].width) return 0;
  }
  return first == end ? 0 : reads[at(first)].width;
}

bool ConstraintRows::locate_blocks(int row, const BlockLayout& layout, const HessianPattern& pattern) {
  const int block = block_of(row);
  if (block == 0) return false;
  const Blocks found{block, static_cast<int>(base.size()), static_cast<int>(length.size())};
  const int* u = unknown.data() + unknown_begin[at(row)];
  const SparsityPattern view = pattern.view();
  const auto give_up = [&] {
    base.resize(at(found.first_base));
    length.resize(at(found.first_length));
    return false;
  };
  for (int p = 0; p < all_places[at(row)].count; ++p) {
    const int* of_p = u + p * block;
    const auto held = std::count_if(of_p, of_p + block, [](int free) { return free < 0; });
    if (held != 0 && held != block) return give_up();
    length.push_back(held != 0 ? 0 : view.begin[at(*of_p) + 1] - view.begin[at(*of_p)]);
    for (int s = 0; s <= p; ++s) {
      const int* of_s = u + s * block;
      if (*of_p < 0 || *of_s < 0) {
        base.push_back(no_base);
        continue;
      }
      const bool swapped = *of_s > *of_p;
      const int first = pattern.position(layout, *of_p, *of_s);
      const int columns = length[at(found.first_length + (swapped ? p : s))];
      base.push_back(swapped ? ~first : first);
      for (int i = 0; i < block; ++i) {
        for (int j = 0; j < (s == p ? i + 1 : block); ++j) {
          const int column = swapped ? i : j, inner = swapped ? j : i;
          const int expected = first + inner + column * columns - column * (column + 1) / 2;
          if (pattern.position(layout, of_p[i], of_s[j]) != expected) return give_up();
        }
      }
    }
  }
  blocks[at(row)] = found;
  return true;
}

void ConstraintRows::locate(const BlockLayout& layout, const HessianPattern& hessian_pattern,
                            const JacobianPattern& jacobian_pattern) {
  jacobian_position.clear();
  hessian_position.clear();
  base.clear();
  length.clear();
  blocks.assign(at(rows()), {});
  hessian_position_begin.assign(1, 0);
  for (int r = 0; r < rows(); ++r) {
    const int* u = unknown.data() + unknown_begin[at(r)];
    const int count = unknown_begin[at(r) + 1] - unknown_begin[at(r)];
    for (int a = 0; a < count; ++a) {
      jacobian_position.push_back(u[a] < 0 ? -1 : jacobian_pattern.position(first_row + r, u[a]));
    }
    if (!locate_blocks(r, layout, hessian_pattern)) {
      for (int a = 0; a < count; ++a) {
        for (int b = 0; b <= a; ++b) {
          hessian_position.push_back(u[a] < 0 || u[b] < 0 ? -1 : hessian_pattern.position(layout, u[a], u[b]));
        }
      }
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
