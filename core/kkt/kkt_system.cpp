#include "core/kkt/kkt_system.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Dense>

namespace bowstring::kkt {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int no_slot = std::numeric_limits<int>::min();
// ρ, of the mean diagonal entry that the rows meet; 1 would cancel a negative one that a row reads alone.
constexpr double row_weight = 2.0;
constexpr std::size_t part_size = 1 << 14;  // numbers of the matrix that are filled at a time
constexpr double dual_slack = 1e-10;        // of 1/ρ
constexpr double largest_growth = 1e12;     // beyond it the factor says nothing

}  // namespace

void KktSystem::analyse(const Problem& problem, Span<const double> jacobian, Span<const char> held) {
  n_ = problem.unknowns();
  m_ = problem.rows();
  hessian_ = problem.hessian_pattern();
  jacobian_ = problem.jacobian_pattern();
  scale_.assign(problem.stationarity_scale().begin(), problem.stationarity_scale().end());
  exact_.resize(at(m_));
  for (int r = 0; r < m_; ++r) {
    const bool equality = problem.row_lower()[at(r)] == problem.row_upper()[at(r)];
    exact_[at(r)] = equality || (!held.empty() && held[at(r)] != 0) ? 1 : 0;
  }
  // Places' own rows and unknowns outlive epochs, and so does their elimination while it is sound.
  if (!local_.fits(problem) || !local_.update(jacobian)) local_.analyse(problem, jacobian);
  number_slots(problem);
  shape_matrix();
  list_entries();
  sort_by_part();
  right_.assign(at(slots_ + ProfileMatrix::padding), 0.0);
  border_right_.assign(at(borders_), 0.0);
  work_a_.resize(at(n_));
  work_b_.resize(at(m_));
  left_a_.resize(at(n_));
  left_b_.resize(at(m_));
  delta_.resize(at(n_));
  lambda_.resize(at(m_));
  start_.resize(at(n_));
}

void KktSystem::number_slots(const Problem& problem) {
  slot_of_unknown_.assign(at(n_), no_slot);
  slot_of_row_.assign(at(m_), no_slot);
  unknown_of_slot_.clear();
  row_of_slot_.clear();
  const Span<const int> order = problem.order();
  borders_ = 0;
  exact_rows_ = 0;
  const std::size_t inner = order.size() - at(problem.border());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int index = order[k];
    if (index < n_) {
      if (local_.block_of_unknown(index) >= 0) continue;
      if (k >= inner) {
        slot_of_unknown_[at(index)] = -1 - borders_++;
        continue;
      }
      slot_of_unknown_[at(index)] = static_cast<int>(unknown_of_slot_.size());
      unknown_of_slot_.push_back(index);
      row_of_slot_.push_back(-1);
      continue;
    }
    const int row = index - n_;
    if (exact_[at(row)] == 0) continue;
    const int block = local_.block_of_row(row);
    if (block >= 0) {
      // The rows that are left of a place stand where its first ones would.
      const LocalBlock& place = local_.blocks()[at(block)];
      if (row - place.first_row >= place.left()) continue;
    }
    slot_of_row_[at(row)] = static_cast<int>(unknown_of_slot_.size());
    unknown_of_slot_.push_back(-1);
    row_of_slot_.push_back(row);
    ++exact_rows_;
  }
  slots_ = static_cast<int>(unknown_of_slot_.size());
}

/// Columns reach as far as the unknowns that one entry of the Hessian or one row couples, once a place's local unknowns
/// are replaced by its retained ones.
void KktSystem::shape_matrix() {
  struct Reach {
    int low = std::numeric_limits<int>::max(), high = -1;
    void add(int slot) noexcept {
      if (slot < 0) return;
      low = std::min(low, slot);
      high = std::max(high, slot);
    }
    void add(const Reach& other) noexcept {
      low = std::min(low, other.low);
      high = std::max(high, other.high);
    }
  };
  std::vector<int> last(at(slots_));
  for (int s = 0; s < slots_; ++s) last[at(s)] = s;
  const auto couple = [&](const Reach& reach) {
    // The profile never decreases, so that the columns between reach as far.
    if (reach.high >= 0) last[at(reach.low)] = std::max(last[at(reach.low)], reach.high);
  };
  std::vector<Reach> of_block(local_.blocks().size());
  for (std::size_t b = 0; b < of_block.size(); ++b) {
    const LocalBlock& block = local_.blocks()[b];
    for (int p = 0; p < block.retained; ++p) of_block[b].add(slot_of_unknown_[at(local_.retained(block)[p])]);
  }
  const auto add_unknown = [&](Reach& reach, int unknown) {
    const int slot = slot_of_unknown_[at(unknown)];
    if (slot != no_slot) {
      reach.add(slot);
    } else {
      reach.add(of_block[at(local_.block_of_unknown(unknown))]);
    }
  };
  for (int j = 0; j < n_; ++j) {
    Reach own;
    add_unknown(own, j);
    Reach all = own;
    for (int k = hessian_.begin[at(j)]; k < hessian_.begin[at(j) + 1]; ++k) {
      const int i = hessian_.inner[at(k)];
      const int slot = slot_of_unknown_[at(i)];
      if (own.low == own.high && slot >= 0) {
        // The usual entry; of those above the column the first one counts, of those below it the last.
        if (slot > own.low) {
          all.high = std::max(all.high, slot);
        } else {
          last[at(slot)] = std::max(last[at(slot)], own.high);
        }
        continue;
      }
      Reach pair = own;
      add_unknown(pair, i);
      couple(pair);
    }
    if (own.low == own.high) couple(all);
  }
  int longest = LocalElimination::most_retained;
  for (int r = 0; r < m_; ++r) {
    Reach row;
    int length = 0;
    for (int k = jacobian_.begin[at(r)]; k < jacobian_.begin[at(r) + 1]; ++k) {
      const int unknown = jacobian_.inner[at(k)];
      add_unknown(row, unknown);
      const int block = local_.block_of_unknown(unknown);
      length += block < 0 ? 1 : local_.blocks()[at(block)].retained;
    }
    longest = std::max(longest, length);
    const int block = local_.block_of_row(r);
    const int first = block < 0 ? r : local_.blocks()[at(block)].first_row;
    const int count = block < 0 ? 1 : local_.blocks()[at(block)].left();
    for (int k = 0; exact_[at(r)] != 0 && k < count; ++k) row.add(slot_of_row_[at(first + k)]);
    couple(row);
  }
  row_slot_.resize(at(longest));
  row_value_.resize(at(longest));
  matrix_.shape(std::move(last));
  border_values_.assign(at(borders_ * slots_ + borders_ * borders_), 0.0);
}

int KktSystem::target(int slot, int other) const noexcept {
  if (slot >= 0 && other >= 0) return matrix_.index(std::max(slot, other), std::min(slot, other));
  if (slot < 0 && other < 0) {
    const int k = std::max(-1 - slot, -1 - other), l = std::min(-1 - slot, -1 - other);
    return -1 - (borders_ * slots_ + k * borders_ + l);
  }
  const int border = -1 - std::min(slot, other);
  return -1 - (border * slots_ + std::max(slot, other));
}

void KktSystem::list_entries() {
  direct_.clear();
  mixed_entries_.clear();
  pairs_.clear();
  mixed_.clear();
  pair_entry_.clear();
  pair_target_.clear();
  mixed_entry_.clear();
  mixed_target_.clear();
  // Entries with local unknowns, gathered by the two places, or by place and retained unknown: a place has few
  // partners.
  partner_of_block_.assign(local_.blocks().size(), -1);
  next_partner_.clear();
  const auto find = [&](int block, int partner, auto&& make) {
    int* link = &partner_of_block_[at(block)];
    while (*link >= 0) {
      Partner& known = next_partner_[at(*link)];
      if (known.partner == partner) return known.index;
      link = &known.next;
    }
    *link = static_cast<int>(next_partner_.size());
    const int index = make();
    next_partner_.push_back({partner, index, -1});
    return index;
  };
  for (int j = 0; j < n_; ++j) {
    for (int k = hessian_.begin[at(j)]; k < hessian_.begin[at(j) + 1]; ++k) {
      const int i = hessian_.inner[at(k)];
      const int bi = local_.block_of_unknown(i), bj = local_.block_of_unknown(j);
      if (bi < 0 && bj < 0) {
        direct_.push_back({k, target(slot_of_unknown_[at(i)], slot_of_unknown_[at(j)])});
        continue;
      }
      mixed_entries_.push_back({i, j, k});
      if (bi >= 0 && bj >= 0) {
        const bool swap = bi < bj;
        const int first = swap ? bj : bi, second = swap ? bi : bj;
        const LocalBlock& b1 = local_.blocks()[at(first)];
        const LocalBlock& b2 = local_.blocks()[at(second)];
        const int index = find(first, -1 - second, [&] {
          pairs_.push_back({first, second, static_cast<int>(pair_entry_.size()), 0});
          pair_entry_.resize(pair_entry_.size() + at(b1.locals * b2.locals), -1);
          return static_cast<int>(pairs_.size()) - 1;
        });
        const int base = pairs_[at(index)].first_entry;
        const int li = local_.place_in_block(i), lj = local_.place_in_block(j);
        const int row = swap ? lj : li, column = swap ? li : lj;
        pair_entry_[at(base + row * b2.locals + column)] = k;
        if (first == second) pair_entry_[at(base + column * b2.locals + row)] = k;
      } else {
        const int block = std::max(bi, bj);
        const int local = bi >= 0 ? i : j, other = bi >= 0 ? j : i;
        const int index = find(block, other, [&] {
          mixed_.push_back({block, other, static_cast<int>(mixed_entry_.size()), 0});
          mixed_entry_.resize(mixed_entry_.size() + at(local_.blocks()[at(block)].locals), -1);
          return static_cast<int>(mixed_.size()) - 1;
        });
        mixed_entry_[at(mixed_[at(index)].first_entry + local_.place_in_block(local))] = k;
      }
    }
  }
  for (Pair& pair : pairs_) {
    const LocalBlock& b1 = local_.blocks()[at(pair.first)];
    const LocalBlock& b2 = local_.blocks()[at(pair.second)];
    pair.first_target = static_cast<int>(pair_target_.size());
    for (int a = 0; a < b1.retained; ++a) {
      for (int b = 0; b < b2.retained; ++b) {
        if (pair.first == pair.second && b > a) continue;
        pair_target_.push_back(
            target(slot_of_unknown_[at(local_.retained(b1)[a])], slot_of_unknown_[at(local_.retained(b2)[b])]));
      }
    }
  }
  for (Mixed& mixed : mixed_) {
    const LocalBlock& block = local_.blocks()[at(mixed.block)];
    mixed.first_target = static_cast<int>(mixed_target_.size());
    for (int a = 0; a < block.retained; ++a) {
      mixed_target_.push_back(
          target(slot_of_unknown_[at(local_.retained(block)[a])], slot_of_unknown_[at(mixed.unknown)]));
    }
  }
}

void KktSystem::sort_by_part() {
  const int parts = static_cast<int>(matrix_.stored() / part_size) + 1;
  const auto part_of = [](int target) { return std::max(target, 0) / static_cast<int>(part_size); };
  const auto sort = [&](auto& items, std::vector<int>& begin, auto&& first_target) {
    begin.assign(at(parts) + 1, 0);
    for (const auto& item : items) ++begin[at(part_of(first_target(item)) + 1)];
    for (int part = 0; part < parts; ++part) begin[at(part) + 1] += begin[at(part)];
    if (parts == 1) return;
    auto sorted = items;
    std::vector<int> next = begin;
    for (const auto& item : items) sorted[at(next[at(part_of(first_target(item)))]++)] = item;
    items.swap(sorted);
  };
  sort(direct_, direct_begin_, [](const Direct& item) { return item.target; });
  sort(pairs_, pair_begin_, [&](const Pair& item) { return pair_target_[at(item.first_target)]; });
  sort(mixed_, mixed_begin_, [&](const Mixed& item) { return mixed_target_[at(item.first_target)]; });
}

void KktSystem::add_hessian(Span<const double> w) {
  for (std::size_t part = 0; part + 1 < direct_begin_.size(); ++part) {
    for (int k = direct_begin_[part]; k < direct_begin_[part + 1]; ++k) {
      cell(direct_[at(k)].target) += w[at(direct_[at(k)].entry)];
    }
    for (int k = pair_begin_[part]; k < pair_begin_[part + 1]; ++k) add_pair(pairs_[at(k)], w);
    for (int k = mixed_begin_[part]; k < mixed_begin_[part + 1]; ++k) add_mixed(mixed_[at(k)], w);
  }
}

void KktSystem::add_pair(const Pair& pair, Span<const double> w) {
  const LocalBlock& b1 = local_.blocks()[at(pair.first)];
  const LocalBlock& b2 = local_.blocks()[at(pair.second)];
  const double* a1 = local_.a(b1);
  const double* a2 = local_.a(b2);
  const int* entry = pair_entry_.data() + pair.first_entry;
  const int* where = pair_target_.data() + pair.first_target;
  double half[LocalElimination::most_rows][LocalElimination::most_retained];
  for (int i = 0; i < b1.locals; ++i) {
    std::fill_n(half[i], b2.retained, 0.0);
    for (int j = 0; j < b2.locals; ++j) {
      const int k = entry[i * b2.locals + j];
      if (k < 0) continue;
      const double value = w[at(k)];
      for (int b = 0; b < b2.retained; ++b) half[i][b] += value * a2[j * b2.retained + b];
    }
  }
  const bool same = pair.first == pair.second;
  for (int a = 0; a < b1.retained; ++a) {
    const int end = same ? a + 1 : b2.retained;
    for (int b = 0; b < end; ++b) {
      double sum = 0.0;
      for (int i = 0; i < b1.locals; ++i) sum += a1[i * b1.retained + a] * half[i][b];
      const bool diagonal = !same && local_.retained(b1)[a] == local_.retained(b2)[b];
      cell(*where++) += diagonal ? 2.0 * sum : sum;
    }
  }
}

void KktSystem::add_mixed(const Mixed& mixed, Span<const double> w) {
  const LocalBlock& block = local_.blocks()[at(mixed.block)];
  const double* a = local_.a(block);
  const int* where = mixed_target_.data() + mixed.first_target;
  for (int p = 0; p < block.retained; ++p, ++where) {
    double sum = 0.0;
    for (int l = 0; l < block.locals; ++l) {
      const int k = mixed_entry_[at(mixed.first_entry + l)];
      if (k >= 0) sum -= a[l * block.retained + p] * w[at(k)];
    }
    cell(*where) += local_.retained(block)[p] == mixed.unknown ? 2.0 * sum : sum;
  }
}

int KktSystem::reduced_row(int row, Span<const double> jacobian, int* slot, double* value) const noexcept {
  int count = 0;
  const auto add = [&](int unknown, double number) {
    if (number == 0.0) return;
    const int s = slot_of_unknown_[at(unknown)];
    for (int k = 0; k < count; ++k) {
      if (slot[k] == s) {
        value[k] += number;
        return;
      }
    }
    slot[count] = s;
    value[count++] = number;
  };
  bool plain = true;
  for (int k = jacobian_.begin[at(row)]; k < jacobian_.begin[at(row) + 1]; ++k) {
    const int unknown = jacobian_.inner[at(k)];
    const double number = jacobian[at(k)];
    if (number == 0.0) continue;
    if (local_.block_of_unknown(unknown) >= 0) {
      plain = false;
      continue;
    }
    slot[count] = slot_of_unknown_[at(unknown)];
    value[count++] = number;
  }
  if (plain) return count;
  for (int k = jacobian_.begin[at(row)]; k < jacobian_.begin[at(row) + 1]; ++k) {
    const int unknown = jacobian_.inner[at(k)];
    const int index = local_.block_of_unknown(unknown);
    if (index < 0) continue;
    const LocalBlock& block = local_.blocks()[at(index)];
    const double* a = local_.a(block) + local_.place_in_block(unknown) * block.retained;
    for (int p = 0; p < block.retained; ++p) add(local_.retained(block)[p], -jacobian[at(k)] * a[p]);
  }
  return count;
}

void KktSystem::add_outer(const int* slot, const double* value, int count, double factor) noexcept {
  double* stored = matrix_.values().data();
  for (int a = 0; a < count; ++a) {
    const double scaled = factor * value[a];
    const int own = slot[a];
    if (own < 0) {
      for (int b = 0; b < count; ++b) {
        if (slot[b] >= 0 || b <= a) border_values_[at(-1 - target(own, slot[b]))] += scaled * value[b];
      }
      continue;
    }
    const int column = matrix_.begin(own) - own;
    for (int b = 0; b <= a; ++b) {
      const int other = slot[b];
      if (other < 0) continue;
      const int where = other >= own ? column + other : matrix_.begin(other) + own - other;
      stored[where] += scaled * value[b];
    }
  }
}

void KktSystem::put_row(int row_slot, const int* slot, const double* value, int count) noexcept {
  for (int k = 0; k < count; ++k) cell(target(row_slot, slot[k])) += value[k];
}

void KktSystem::assemble(const Values& values) {
  matrix_.clear();
  std::fill(border_values_.begin(), border_values_.end(), 0.0);
  add_hessian(values.hessian);
  int* slot = row_slot_.data();
  double* value = row_value_.data();
  for (int r = 0; r < m_; ++r) {
    if (exact_[at(r)] != 0) continue;
    const double e = values.softness[at(r)];
    if (!(e < std::numeric_limits<double>::infinity())) continue;
    const int count = reduced_row(r, values.jacobian, slot, value);
    add_outer(slot, value, count, 1.0 / e);
  }
  for (int s = 0; s < slots_; ++s) {
    const int unknown = unknown_of_slot_[at(s)];
    if (unknown >= 0)
      matrix_.values()[at(matrix_.index(s, s))] += values.shift * scale_[at(unknown)] * scale_[at(unknown)];
  }
  for (int u = 0; values.shift != 0.0 && borders_ > 0 && u < n_; ++u) {
    const int s = slot_of_unknown_[at(u)];
    if (s < 0 && s != no_slot) cell(target(s, s)) += values.shift * scale_[at(u)] * scale_[at(u)];
  }
  if (exact_rows_ == 0) return;

  // ρ: the mean diagonal entry that the exact rows meet, against their own squares.
  const auto for_rows = [&](const auto& act) {
    for (int s = 0; s < slots_; ++s) {
      const int row = row_of_slot_[at(s)];
      if (row < 0) continue;
      const int index = local_.block_of_row(row);
      int count = 0;
      if (index < 0) {
        count = reduced_row(row, values.jacobian, slot, value);
      } else {
        const LocalBlock& block = local_.blocks()[at(index)];
        const double* b = local_.b(block) + (row - block.first_row) * block.retained;
        for (int p = 0; p < block.retained; ++p) {
          if (b[p] == 0.0) continue;
          slot[count] = slot_of_unknown_[at(local_.retained(block)[p])];
          value[count++] = b[p];
        }
      }
      act(s, count);
    }
  };
  double diagonal = 0.0, squares = 0.0;
  for_rows([&](int, int count) {
    for (int k = 0; k < count; ++k) {
      if (slot[k] < 0) continue;
      diagonal += value[k] * value[k] * std::fabs(matrix_.values()[at(matrix_.index(slot[k], slot[k]))]);
      squares += value[k] * value[k] * value[k] * value[k];
    }
  });
  weight_ = squares > 0.0 && diagonal > 0.0 ? row_weight * diagonal / squares : 1.0;
  slack_ = dual_slack / weight_;
  for_rows([&](int s, int count) {
    add_outer(slot, value, count, weight_);
    put_row(s, slot, value, count);
    matrix_.values()[at(matrix_.index(s, s))] -= slack_;
  });
}

KktSystem::Outcome KktSystem::factor(const Values& values) {
  values_ = values;
  Outcome out;
  if (!local_.update(values.jacobian)) return out;
  assemble(values);
  const PivotReport report = matrix_.factor();
  factor_border();
  out.growth = report.growth;
  out.saddle_directions = report.negative + schur_negative_ - exact_rows_;
  out.exists = report.vanishing == 0 && report.growth < largest_growth && std::isfinite(report.growth);
  if (report.first_vanishing >= 0) {
    out.singular_unknown = unknown_of_slot_[at(report.first_vanishing)];
    out.singular_row = row_of_slot_[at(report.first_vanishing)];
  }
  return out;
}

void KktSystem::factor_border() {
  schur_negative_ = 0;
  if (borders_ == 0) return;
  border_solved_.assign(border_values_.begin(), border_values_.begin() + borders_ * slots_);
  border_solved_.resize(border_solved_.size() + ProfileMatrix::padding, 0.0);
  for (int k = 0; k < borders_; ++k) matrix_.solve(border_solved_.data() + k * slots_);
  Eigen::MatrixXd schur(borders_, borders_);
  const double* corner = border_values_.data() + borders_ * slots_;
  for (int k = 0; k < borders_; ++k) {
    for (int l = 0; l <= k; ++l) {
      double sum = corner[k * borders_ + l];
      for (int s = 0; s < slots_; ++s) sum -= border_values_[at(k * slots_ + s)] * border_solved_[at(l * slots_ + s)];
      schur(k, l) = schur(l, k) = sum;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(schur);
  const Eigen::MatrixXd inverse = schur.inverse();
  schur_inverse_.assign(inverse.data(), inverse.data() + borders_ * borders_);
  for (int k = 0; k < borders_; ++k) schur_negative_ += eigen.eigenvalues()[k] < 0.0 ? 1 : 0;
}

void KktSystem::solve_reduced() {
  matrix_.solve(right_.data());
  if (borders_ == 0) return;
  std::vector<double> corner(at(borders_));
  for (int k = 0; k < borders_; ++k) {
    corner[at(k)] = border_right_[at(k)];
    for (int s = 0; s < slots_; ++s) corner[at(k)] -= border_values_[at(k * slots_ + s)] * right_[at(s)];
  }
  for (int k = 0; k < borders_; ++k) {
    border_right_[at(k)] = 0.0;
    for (int l = 0; l < borders_; ++l) border_right_[at(k)] += schur_inverse_[at(k * borders_ + l)] * corner[at(l)];
  }
  for (int k = 0; k < borders_; ++k) {
    const double* solved = border_solved_.data() + k * slots_;
    for (int s = 0; s < slots_; ++s) right_[at(s)] -= solved[s] * border_right_[at(k)];
  }
}

void KktSystem::solve_once(const double* a, const double* b, double* delta, double* lambda) {
  const Span<const double> w = values_.hessian, jacobian = values_.jacobian;
  // The places' particular solutions, and what is left of their rows.
  std::fill(start_.begin(), start_.end(), 0.0);
  std::copy_n(a, n_, work_a_.data());
  std::copy_n(b, m_, work_b_.data());
  for (const LocalBlock& block : local_.blocks()) {
    double* rotated = work_b_.data() + block.first_row;
    local_.rotate(block, rotated);
    for (int k = 0; k < block.locals; ++k) start_[at(local_.local(block)[k])] = rotated[k];
  }
  // a ← a − W t₀ + Jᵀ E⁻¹ (b − J t₀) of the soft rows.
  for (const Entry& entry : mixed_entries_) {
    work_a_[at(entry.i)] -= w[at(entry.entry)] * start_[at(entry.j)];
    if (entry.i != entry.j) work_a_[at(entry.j)] -= w[at(entry.entry)] * start_[at(entry.i)];
  }
  for (int r = 0; r < m_; ++r) {
    if (exact_[at(r)] != 0 || !std::isfinite(values_.softness[at(r)])) continue;
    double right = b[r];
    const int first = jacobian_.begin[at(r)], end = jacobian_.begin[at(r) + 1];
    for (int k = first; k < end; ++k) right -= jacobian[at(k)] * start_[at(jacobian_.inner[at(k)])];
    right /= values_.softness[at(r)];
    for (int k = first; k < end; ++k) work_a_[at(jacobian_.inner[at(k)])] += jacobian[at(k)] * right;
  }
  // Onto the retained unknowns.
  for (const LocalBlock& block : local_.blocks()) {
    const double* coefficient = local_.a(block);
    for (int l = 0; l < block.locals; ++l) {
      const double pull = work_a_[at(local_.local(block)[l])];
      if (pull == 0.0) continue;
      for (int p = 0; p < block.retained; ++p) {
        work_a_[at(local_.retained(block)[p])] -= coefficient[l * block.retained + p] * pull;
      }
    }
  }
  const auto retained_right = [&](int row) {
    const int index = local_.block_of_row(row);
    if (index < 0) {
      double right = b[row];
      for (int k = jacobian_.begin[at(row)]; k < jacobian_.begin[at(row) + 1]; ++k) {
        right -= jacobian[at(k)] * start_[at(jacobian_.inner[at(k)])];
      }
      return right;
    }
    const LocalBlock& block = local_.blocks()[at(index)];
    return work_b_[at(block.first_row + block.locals + row - block.first_row)];
  };
  // + ρ Jᵀ b of the rows that are left.
  for (int s = 0; s < slots_; ++s) {
    const int row = row_of_slot_[at(s)];
    if (row < 0) continue;
    const double right = retained_right(row);
    right_[at(s)] = right;
    if (right == 0.0) continue;
    const int index = local_.block_of_row(row);
    if (index < 0) {
      for (int k = jacobian_.begin[at(row)]; k < jacobian_.begin[at(row) + 1]; ++k) {
        const int unknown = jacobian_.inner[at(k)];
        const int of = local_.block_of_unknown(unknown);
        if (of < 0) {
          work_a_[at(unknown)] += weight_ * jacobian[at(k)] * right;
          continue;
        }
        const LocalBlock& block = local_.blocks()[at(of)];
        const double* coefficient = local_.a(block) + local_.place_in_block(unknown) * block.retained;
        for (int p = 0; p < block.retained; ++p) {
          work_a_[at(local_.retained(block)[p])] -= weight_ * jacobian[at(k)] * coefficient[p] * right;
        }
      }
    } else {
      const LocalBlock& block = local_.blocks()[at(index)];
      const double* left = local_.b(block) + (row - block.first_row) * block.retained;
      for (int p = 0; p < block.retained; ++p) {
        work_a_[at(local_.retained(block)[p])] += weight_ * left[p] * right;
      }
    }
  }
  for (int u = 0; u < n_; ++u) {
    const int s = slot_of_unknown_[at(u)];
    if (s >= 0) {
      right_[at(s)] = work_a_[at(u)];
    } else if (s != no_slot) {
      border_right_[at(-1 - s)] = work_a_[at(u)];
    }
  }
  solve_reduced();
  for (int u = 0; u < n_; ++u) {
    const int s = slot_of_unknown_[at(u)];
    delta[u] = s >= 0 ? right_[at(s)] : s == no_slot ? start_[at(u)] : border_right_[at(-1 - s)];
  }
  for (const LocalBlock& block : local_.blocks()) {
    const double* coefficient = local_.a(block);
    for (int l = 0; l < block.locals; ++l) {
      double& own = delta[local_.local(block)[l]];
      for (int p = 0; p < block.retained; ++p) {
        own -= coefficient[l * block.retained + p] * delta[local_.retained(block)[p]];
      }
    }
  }
  // Multipliers: of soft rows from what they give way, of the others from the system, of places' from what is left.
  std::copy_n(a, n_, work_a_.data());
  for (const Entry& entry : mixed_entries_) {
    work_a_[at(entry.i)] -= w[at(entry.entry)] * delta[entry.j];
    if (entry.i != entry.j) work_a_[at(entry.j)] -= w[at(entry.entry)] * delta[entry.i];
  }
  for (int r = 0; r < m_; ++r) {
    lambda[r] = 0.0;
    if (exact_[at(r)] == 0) {
      if (!std::isfinite(values_.softness[at(r)])) continue;
      double sum = -b[r];
      const int first = jacobian_.begin[at(r)], end = jacobian_.begin[at(r) + 1];
      for (int k = first; k < end; ++k) sum += jacobian[at(k)] * delta[jacobian_.inner[at(k)]];
      lambda[r] = sum / values_.softness[at(r)];
    } else if (slot_of_row_[at(r)] >= 0 && local_.block_of_row(r) < 0) {
      lambda[r] = right_[at(slot_of_row_[at(r)])];
    } else {
      continue;
    }
    for (int k = jacobian_.begin[at(r)]; k < jacobian_.begin[at(r) + 1]; ++k) {
      const int unknown = jacobian_.inner[at(k)];
      if (local_.block_of_unknown(unknown) >= 0) work_a_[at(unknown)] -= jacobian[at(k)] * lambda[r];
    }
  }
  for (const LocalBlock& block : local_.blocks()) {
    double pull[LocalElimination::most_rows] = {}, left[LocalElimination::most_rows] = {};
    for (int l = 0; l < block.locals; ++l) pull[l] = work_a_[at(local_.local(block)[l])];
    for (int k = 0; k < block.left(); ++k) left[k] = right_[at(slot_of_row_[at(block.first_row + k)])];
    local_.multipliers(block, pull, left, lambda + block.first_row);
  }
}

double KktSystem::residual(Span<const double> a, Span<const double> b, Span<const double> exactness,
                           Span<const double> delta, Span<const double> lambda) {
  double* ra = work_a_.data();
  double* rb = work_b_.data();
  const double* w = values_.hessian.data();
  for (int u = 0; u < n_; ++u) {
    const double shift =
        local_.block_of_unknown(u) < 0 ? values_.shift * scale_[at(u)] * scale_[at(u)] * delta[at(u)] : 0.0;
    ra[u] = a[at(u)] - shift;
  }
  for (int j = 0; j < n_; ++j) {
    const int first = hessian_.begin[at(j)], end = hessian_.begin[at(j) + 1];
    const double here = delta[at(j)];
    double sum = 0.0;
    if (first < end) sum += w[first] * here;
    for (int k = first + 1; k < end; ++k) {
      const int i = hessian_.inner[at(k)];
      ra[i] -= w[k] * here;
      sum += w[k] * delta[at(i)];
    }
    ra[j] -= sum;
  }
  double rows = 0.0;
  for (int r = 0; r < m_; ++r) {
    double sum = b[at(r)];
    const double multiplier = lambda[at(r)];
    for (int k = jacobian_.begin[at(r)]; k < jacobian_.begin[at(r) + 1]; ++k) {
      const int u = jacobian_.inner[at(k)];
      const double value = values_.jacobian[at(k)];
      sum -= value * delta[at(u)];
      ra[u] -= value * multiplier;
    }
    if (exact_[at(r)] == 0) {
      const double soft = values_.softness[at(r)];
      const double e = exactness.empty() ? soft : exactness[at(r)];
      sum = std::isfinite(soft) ? sum + e * multiplier : 0.0;
    }
    rb[r] = sum;
    rows = std::max(rows, std::fabs(sum));
  }
  double pull = 0.0;
  for (int u = 0; u < n_; ++u) pull = std::max(pull, std::fabs(ra[u]) / scale_[at(u)]);
  double size_a = 1e-300, size_b = 1e-300;
  for (int u = 0; u < n_; ++u) size_a = std::max(size_a, std::fabs(a[at(u)]) / scale_[at(u)]);
  for (int r = 0; r < m_; ++r) size_b = std::max(size_b, std::fabs(b[at(r)]));
  return std::max(pull / size_a, size_b > 1e-299 ? rows / size_b : rows);
}

double KktSystem::solve(Span<const double> a, Span<const double> b, Span<const double> exactness, int refinements,
                        Span<double> delta, Span<double> lambda, double enough) {
  solve_once(a.data(), b.data(), delta.data(), lambda.data());
  double before = residual(a, b, exactness, delta, lambda);
  for (int k = 0; k < refinements && before > enough; ++k) {
    std::copy(work_a_.begin(), work_a_.end(), left_a_.begin());
    std::copy(work_b_.begin(), work_b_.end(), left_b_.begin());
    solve_once(left_a_.data(), left_b_.data(), delta_.data(), lambda_.data());
    for (int u = 0; u < n_; ++u) delta[at(u)] += delta_[at(u)];
    for (int r = 0; r < m_; ++r) lambda[at(r)] += lambda_[at(r)];
    const double now = residual(a, b, exactness, delta, lambda);
    if (!(now < before)) {
      for (int u = 0; u < n_; ++u) delta[at(u)] -= delta_[at(u)];
      for (int r = 0; r < m_; ++r) lambda[at(r)] -= lambda_[at(r)];
      break;
    }
    before = now;
  }
  return before;
}

}  // namespace bowstring::kkt
