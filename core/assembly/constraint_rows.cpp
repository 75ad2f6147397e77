#include "core/assembly/constraint_rows.hpp"

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
}

void ConstraintRows::locate(const BlockLayout& blocks, const HessianPattern& hessian_pattern,
                            const JacobianPattern& jacobian_pattern) {
  jacobian_position.clear();
  hessian_position.clear();
  hessian_position_begin.assign(1, 0);
  for (int r = 0; r < rows(); ++r) {
    const int* u = unknown.data() + unknown_begin[at(r)];
    const int count = unknown_begin[at(r) + 1] - unknown_begin[at(r)];
    for (int a = 0; a < count; ++a) {
      jacobian_position.push_back(u[a] < 0 ? -1 : jacobian_pattern.position(first_row + r, u[a]));
      for (int b = 0; b <= a; ++b) {
        hessian_position.push_back(u[a] < 0 || u[b] < 0 ? -1 : hessian_pattern.position(blocks, u[a], u[b]));
      }
    }
    hessian_position_begin.push_back(static_cast<int>(hessian_position.size()));
  }
}

void ConstraintRows::add_jacobian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  const double* r_y = jacobian.data();
  const int* position = jacobian_position.data();
  for (const Read& read : reads) {
    const double* b = place_jacobian(tables, read);
    for (int k = 0; k < read.width; ++k) {
      if (position[k] < 0) continue;
      double sum = b == nullptr ? r_y[k] : 0.0;
      for (int a = 0; b != nullptr && a < read.values; ++a) sum += r_y[a] * b[a * read.width + k];
      out[at(position[k])] += sum;
    }
    r_y += read.values;
    position += read.width;
  }
}

void ConstraintRows::add_hessian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  if (!identity) {
    for (int r = 0; r < rows(); ++r) add_row_hessian(r, tables, out);
    return;
  }
  for (std::size_t k = 0; k < hessian.size(); ++k) {
    if (hessian_position[k] >= 0) out[at(hessian_position[k])] += hessian[k];
  }
}

void ConstraintRows::add_row_hessian(int row, const std::vector<SiteTable>& tables, Span<double> out) const noexcept {
  const double* h = hessian.data() + hessian_begin[at(row)];
  const int* position = hessian_position.data() + hessian_position_begin[at(row)];
  int row_y = 0, row_u = 0;
  for (int p = read_begin[at(row)]; p < read_begin[at(row) + 1]; ++p) {
    const Read& a = reads[at(p)];
    const double* ba = place_jacobian(tables, a);
    int column_y = 0, column_u = 0;
    for (int s = read_begin[at(row)]; s <= p; ++s) {
      const Read& b = reads[at(s)];
      const double* bb = place_jacobian(tables, b);
      for (int i = 0; i < a.width; ++i) {
        for (int j = 0; j < b.width && row_u + i >= column_u + j; ++j) {
          const int where = position[packed_index(row_u + i, column_u + j)];
          if (where >= 0) out[at(where)] += congruence(h, a, ba, row_y, i, b, bb, column_y, j);
        }
      }
      column_y += b.values;
      column_u += b.width;
    }
    row_y += a.values;
    row_u += a.width;
  }
}

void ConstraintRows::add_stress(Span<const double> multipliers, std::vector<SiteTable>& tables) const noexcept {
  const double* r_y = jacobian.data();
  for (int r = 0; r < rows(); ++r) {
    const double multiplier = multipliers[at(first_row + r)];
    for (int p = read_begin[at(r)]; p < read_begin[at(r) + 1]; ++p) {
      const Read& read = reads[at(p)];
      double* stress = tables[at(read.table)].total_stress.data() + at(read.index * read.values);
      for (int k = 0; k < read.values; ++k) stress[k] += multiplier * *r_y++;
    }
  }
}

}  // namespace bowstring
