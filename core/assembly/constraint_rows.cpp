#include "core/assembly/constraint_rows.hpp"

#include <algorithm>

#include "core/assembly/finite.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

void ConstraintRows::reserve_derivatives() {
  jacobian.assign(at(jacobian_begin.back()), 0.0);
  hessian.assign(at(hessian_begin.back()), 0.0);
  all_places.clear();
  for (int r = 0; r < rows(); ++r) all_places.push_back({0, 0, read_begin[at(r) + 1] - read_begin[at(r)]});
  jacobian_support = hessian_support = all_places;
}

void ConstraintRows::locate(const BlockLayout& blocks, const HessianPattern& hessian_pattern,
                            const JacobianPattern& jacobian_pattern) {
  jacobian_position.clear();
  hessian_position.clear();
  free.clear();
  hessian_position_begin.assign(1, 0);
  for (int r = 0; r < rows(); ++r) {
    const int* u = unknown.data() + unknown_begin[at(r)];
    const int count = unknown_begin[at(r) + 1] - unknown_begin[at(r)];
    char none_held = 1;
    for (int a = 0; a < count; ++a) {
      if (u[a] < 0) none_held = 0;
      jacobian_position.push_back(u[a] < 0 ? -1 : jacobian_pattern.position(first_row + r, u[a]));
      for (int b = 0; b <= a; ++b) {
        hessian_position.push_back(u[a] < 0 || u[b] < 0 ? -1 : hessian_pattern.position(blocks, u[a], u[b]));
      }
    }
    free.push_back(none_held);
    hessian_position_begin.push_back(static_cast<int>(hessian_position.size()));
  }
}

const ConstraintRows::Read& ConstraintRows::read_of(int row, const RowSupport& support, int k) const noexcept {
  return reads[at(read_begin[at(row)] + support.place(k))];
}

ConstraintRows::Stretches ConstraintRows::stretches(int row, const RowSupport& support) const noexcept {
  const Read* read = reads.data() + read_begin[at(row)];
  const auto end = [read](int places) {
    return places == 0 ? 0 : read[places - 1].first_value + read[places - 1].values;
  };
  Stretches out;
  out.lead = end(support.lead);
  if (support.count == 0) return out;
  const int first = read[support.first].first_value;
  out.shift = first - out.lead;
  out.tail = end(support.first + support.count) - first;
  return out;
}

bool ConstraintRows::fits(int row, const RowSupport& support) const noexcept {
  const int places = all_places[at(row)].count;
  return support.lead >= 0 && support.count >= 0 && support.first >= support.lead &&
         support.first <= places - support.count;
}

int ConstraintRows::flawed_jacobian_row() const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const auto count = at(stretches(r, jacobian_support[at(r)]).values());
    if (!all_finite(jacobian.data() + jacobian_begin[at(r)], count)) return r;
  }
  return -1;
}

int ConstraintRows::flawed_hessian_row() const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const auto count = at(packed_size(stretches(r, hessian_support[at(r)]).values()));
    if (!all_finite(hessian.data() + hessian_begin[at(r)], count)) return r;
  }
  return -1;
}

void ConstraintRows::add_jacobian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  for (int r = 0; r < rows(); ++r) {
    const RowSupport& support = jacobian_support[at(r)];
    const double* r_y = jacobian.data() + jacobian_begin[at(r)];
    for (int p = 0; p < support.places(); ++p) {
      const Read& read = read_of(r, support, p);
      const double* b = place_jacobian(tables, read);
      const int* position = jacobian_position.data() + unknown_begin[at(r)] + read.first_unknown;
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

void ConstraintRows::add_hessian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  for (int r = 0; r < rows(); ++r) {
    if (identity) {
      add_identity_row_hessian(r, out);
    } else {
      add_row_hessian(r, tables, out);
    }
  }
}

void ConstraintRows::add_identity_row_hessian(int row, Span<double> out) const noexcept {
  const Stretches values = stretches(row, hessian_support[at(row)]);  // which are unknowns, too
  const double* h = hessian.data() + hessian_begin[at(row)];
  const int* position = hessian_position.data() + hessian_position_begin[at(row)];
  const bool all_free = free[at(row)] != 0;
  for (int i = 0; i < values.values(); ++i) {
    const int* in_row = position + packed_size(i < values.lead ? i : i + values.shift);
    const int columns = i + 1;
    const int lead = std::min(values.lead, columns);
    if (all_free) {
      for (int j = 0; j < lead; ++j) out[at(in_row[j])] += h[j];
      for (int j = lead; j < columns; ++j) out[at(in_row[values.shift + j])] += h[j];
    } else {
      for (int j = 0; j < columns; ++j) {
        const int where = in_row[j < lead ? j : values.shift + j];
        if (where >= 0) out[at(where)] += h[j];
      }
    }
    h += columns;
  }
}

void ConstraintRows::add_row_hessian(int row, const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  const RowSupport& support = hessian_support[at(row)];
  const double* h = hessian.data() + hessian_begin[at(row)];
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
