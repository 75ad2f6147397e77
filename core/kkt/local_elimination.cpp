#include "core/kkt/local_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bowstring::kkt {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double felt = 1e-3;  // of the steepest local unknown: less at the start is no way to satisfy a row
constexpr double lost = 1e-6;  // the same, later
constexpr int most_candidates = 8, most_reads = 16;

}  // namespace

bool LocalElimination::fits(const Problem& problem) const noexcept {
  if (problem_ != &problem || block_of_row_.size() != at(problem.rows())) return false;
  const SparsityPattern pattern = problem.jacobian_pattern();
  std::size_t row = 0;
  for (const LocalBlock& block : blocks_) {
    for (int i = 0; i < block.rows; ++i, ++row) {
      if (jacobian_begin_[row] != pattern.begin[at(block.first_row + i)]) return false;
    }
  }
  return true;
}

void LocalElimination::analyse(const Problem& problem, Span<const double> jacobian) {
  problem_ = &problem;
  blocks_.clear();
  local_.clear();
  retained_.clear();
  entry_.clear();
  entry_begin_.assign(1, 0);
  jacobian_begin_.clear();
  block_of_unknown_.assign(at(problem.unknowns()), -1);
  place_in_block_.assign(at(problem.unknowns()), -1);
  block_of_row_.assign(at(problem.rows()), -1);
  int q = 0, r = 0, a = 0, b = 0;
  for (const LocalRows& rows : problem.local_rows()) {
    if (rows.rows > most_rows || !choose(problem, rows, jacobian)) continue;
    LocalBlock& block = blocks_.back();
    block.first_q = q, block.first_r = r, block.first_a = a, block.first_b = b;
    q += block.rows * block.rows;
    r += block.locals * block.locals;
    a += block.locals * block.retained;
    b += block.left() * block.retained;
  }
  q_.assign(at(q), 0.0);
  r_.assign(at(r), 0.0);
  a_.assign(at(a), 0.0);
  b_.assign(at(b), 0.0);
  update(jacobian);
}

bool LocalElimination::choose(const Problem& problem, const LocalRows& rows, Span<const double> jacobian) {
  const SparsityPattern pattern = problem.jacobian_pattern();
  const int* candidates = problem.local_unknowns().data() + rows.first_local;
  if (rows.locals > most_candidates) return false;
  const auto candidate = [&](int unknown) {
    return static_cast<int>(std::find(candidates, candidates + rows.locals, unknown) - candidates);
  };
  // Columns of the candidates, made orthogonal to what has been chosen: the one of which most is left is next, since
  // angles and lengths have other units.
  double column[most_candidates][most_rows] = {}, whole[most_candidates] = {};
  int read[most_reads] = {}, reads = 0;
  for (int i = 0; i < rows.rows; ++i) {
    const int row = rows.first_row + i;
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int unknown = pattern.inner[at(k)];
      const int c = candidate(unknown);
      if (c < rows.locals) column[c][i] = jacobian[at(k)];
      if (std::find(read, read + reads, unknown) != read + reads) continue;
      if (reads == most_reads) return false;
      read[reads++] = unknown;
    }
  }
  const auto dot = [&](int c, int d) {
    double sum = 0.0;
    for (int i = 0; i < rows.rows; ++i) sum += column[c][i] * column[d][i];
    return sum;
  };
  double steepest = 0.0;
  for (int c = 0; c < rows.locals; ++c) steepest = std::max(steepest, whole[c] = dot(c, c));
  bool chosen[most_candidates] = {};
  int locals = 0;
  for (; locals < std::min(rows.rows, rows.locals); ++locals) {
    int best = -1;
    double best_share = felt * felt;
    for (int c = 0; c < rows.locals; ++c) {
      if (chosen[c] || whole[c] <= felt * felt * felt * felt * steepest) continue;
      const double share = dot(c, c) / whole[c];
      if (share > best_share) best = c, best_share = share;
    }
    if (best < 0) break;
    chosen[best] = true;
    for (int c = 0; c < rows.locals; ++c) {
      if (chosen[c]) continue;
      const double along = dot(c, best) / dot(best, best);
      for (int i = 0; i < rows.rows; ++i) column[c][i] -= along * column[best][i];
    }
  }
  if (locals == 0) return false;

  LocalBlock block;
  block.first_row = rows.first_row;
  block.rows = rows.rows;
  block.first_local = static_cast<int>(local_.size());
  block.locals = locals;
  block.first_retained = static_cast<int>(retained_.size());
  block.retained = reads - locals;
  const int index = static_cast<int>(blocks_.size());
  for (int c = 0; c < rows.locals; ++c) {
    if (!chosen[c]) continue;
    block_of_unknown_[at(candidates[c])] = index;
    place_in_block_[at(candidates[c])] = static_cast<int>(local_.size()) - block.first_local;
    local_.push_back(candidates[c]);
  }
  std::sort(read, read + reads);
  for (int k = 0; k < reads; ++k) {
    if (block_of_unknown_[at(read[k])] != index) retained_.push_back(read[k]);
  }
  const int* rest = retained_.data() + block.first_retained;
  for (int i = 0; i < rows.rows; ++i) {
    const int row = rows.first_row + i;
    block_of_row_[at(row)] = index;
    jacobian_begin_.push_back(pattern.begin[at(row)]);
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int unknown = pattern.inner[at(k)];
      entry_.push_back(block_of_unknown_[at(unknown)] == index
                           ? -1 - place_in_block_[at(unknown)]
                           : static_cast<int>(std::lower_bound(rest, rest + block.retained, unknown) - rest));
    }
    entry_begin_.push_back(static_cast<int>(entry_.size()));
  }
  blocks_.push_back(block);
  return true;
}

namespace {

/// Jacobian rows of one place: of its local unknowns, of the retained ones, and Qᵀ.
struct Rows {
  static constexpr int most = LocalElimination::most_rows;
  double local[most][most] = {}, rest[most][LocalElimination::most_retained] = {}, q[most][most] = {};
};

/// Householder's reflections of the first `locals` columns, applied to everything and gathered in Qᵀ. With sizes known
/// to the compiler the loops unroll.
template <int fixed_rows, int fixed_locals>
bool triangularise(Rows& m, int rows, int locals, int retained) noexcept {
  const int d = fixed_rows > 0 ? fixed_rows : rows, k = fixed_rows > 0 ? fixed_locals : locals;
  for (int c = 0; c < k; ++c) {
    double squared = 0.0, above = 0.0;
    for (int i = c; i < d; ++i) squared += m.local[i][c] * m.local[i][c];
    for (int i = 0; i < c; ++i) above += m.local[i][c] * m.local[i][c];
    if (!(squared > lost * lost * (squared + above))) return false;
    const double alpha = m.local[c][c] > 0.0 ? -std::sqrt(squared) : std::sqrt(squared);
    double v[Rows::most] = {};
    for (int i = c; i < d; ++i) v[i] = m.local[i][c];
    v[c] -= alpha;
    double norm = 0.0;
    for (int i = c; i < d; ++i) norm += v[i] * v[i];
    const double twice = 2.0 / norm;
    const auto reflect = [&](auto& matrix, int columns) {
      for (int j = 0; j < columns; ++j) {
        double sum = 0.0;
        for (int i = c; i < d; ++i) sum += v[i] * matrix[i][j];
        for (int i = c; i < d; ++i) matrix[i][j] -= twice * sum * v[i];
      }
    };
    reflect(m.local, k);
    reflect(m.rest, retained);
    reflect(m.q, d);
  }
  return true;
}

bool triangularise(Rows& m, const LocalBlock& block) noexcept {
  if (block.rows == 2 && block.locals == 2) return triangularise<2, 2>(m, 2, 2, block.retained);
  if (block.rows == 2 && block.locals == 1) return triangularise<2, 1>(m, 2, 1, block.retained);
  if (block.rows == 3 && block.locals == 3) return triangularise<3, 3>(m, 3, 3, block.retained);
  if (block.rows == 3 && block.locals == 2) return triangularise<3, 2>(m, 3, 2, block.retained);
  return triangularise<0, 0>(m, block.rows, block.locals, block.retained);
}

}  // namespace

bool LocalElimination::update(Span<const double> jacobian) noexcept {
  int block_row = 0;
  for (const LocalBlock& block : blocks_) {
    const int d = block.rows, k = block.locals, p = block.retained;
    Rows m;
    for (int i = 0; i < d; ++i, ++block_row) {
      const double* value = jacobian.data() + jacobian_begin_[at(block_row)];
      for (int e = entry_begin_[at(block_row)]; e < entry_begin_[at(block_row) + 1]; ++e) {
        const int place = entry_[at(e)];
        (place < 0 ? m.local[i][-1 - place] : m.rest[i][place]) = *value++;
      }
      m.q[i][i] = 1.0;
    }
    if (!triangularise(m, block)) return false;
    double* store_q = q_.data() + block.first_q;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) store_q[i * d + j] = m.q[i][j];
    }
    double* r = r_.data() + block.first_r;
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j) r[i * k + j] = m.local[i][j];
    }
    double* a = a_.data() + block.first_a;
    for (int i = k - 1; i >= 0; --i) {
      for (int j = 0; j < p; ++j) {
        double sum = m.rest[i][j];
        for (int l = i + 1; l < k; ++l) sum -= r[i * k + l] * a[l * p + j];
        a[i * p + j] = sum / r[i * k + i];
      }
    }
    double* b = b_.data() + block.first_b;
    for (int i = k; i < d; ++i) {
      for (int j = 0; j < p; ++j) b[(i - k) * p + j] = m.rest[i][j];
    }
  }
  return true;
}

void LocalElimination::rotate(const LocalBlock& block, double* right) const noexcept {
  const int d = block.rows, k = block.locals;
  const double* q = q_.data() + block.first_q;
  const double* r = r_.data() + block.first_r;
  double rotated[most_rows] = {};
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) rotated[i] += q[i * d + j] * right[j];
  }
  for (int i = k - 1; i >= 0; --i) {
    for (int l = i + 1; l < k; ++l) rotated[i] -= r[i * k + l] * rotated[l];
    rotated[i] /= r[i * k + i];
  }
  std::copy_n(rotated, d, right);
}

void LocalElimination::multipliers(const LocalBlock& block, const double* pull, const double* left,
                                   double* out) const noexcept {
  const int d = block.rows, k = block.locals;
  const double* q = q_.data() + block.first_q;
  const double* r = r_.data() + block.first_r;
  double y[most_rows] = {};
  for (int i = 0; i < k; ++i) {
    double sum = pull[i];
    for (int l = 0; l < i; ++l) sum -= r[l * k + i] * y[l];
    y[i] = sum / r[i * k + i];
  }
  for (int i = k; i < d; ++i) y[i] = left[i - k];
  for (int j = 0; j < d; ++j) {
    out[j] = 0.0;
    for (int i = 0; i < d; ++i) out[j] += q[i * d + j] * y[i];
  }
}

}  // namespace bowstring::kkt
