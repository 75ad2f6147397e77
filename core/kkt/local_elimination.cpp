#include "core/kkt/local_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bowstring::kkt {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double felt = 1e-3;  // of the steepest local unknown: less at the start is no way to satisfy a row
constexpr double lost = 1e-6;  // the same, later
constexpr int most_retained = 24;

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
  const Span<const int> candidates{problem.local_unknowns().data() + rows.first_local, at(rows.locals)};
  // Columns of the candidates, made orthogonal to what has been chosen: the longest one is next.
  std::vector<double> column(at(rows.locals * rows.rows), 0.0);
  std::vector<int> reads;
  for (int i = 0; i < rows.rows; ++i) {
    const int row = rows.first_row + i;
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int unknown = pattern.inner[at(k)];
      const auto found = std::find(candidates.begin(), candidates.end(), unknown);
      if (found != candidates.end()) {
        column[at(static_cast<int>(found - candidates.begin()) * rows.rows + i)] = jacobian[at(k)];
      }
      if (std::find(reads.begin(), reads.end(), unknown) == reads.end()) reads.push_back(unknown);
    }
  }
  // Angles and lengths have other units: a column counts by what is left of its own length.
  std::vector<double> whole(at(rows.locals), 0.0);
  const auto squared = [&](int c) {
    double sum = 0.0;
    for (int i = 0; i < rows.rows; ++i) sum += column[at(c * rows.rows + i)] * column[at(c * rows.rows + i)];
    return sum;
  };
  double steepest = 0.0;
  for (int c = 0; c < rows.locals; ++c) steepest = std::max(steepest, whole[at(c)] = squared(c));
  std::vector<int> chosen;
  while (static_cast<int>(chosen.size()) < std::min(rows.rows, rows.locals)) {
    int best = -1;
    double best_share = felt * felt;
    for (int c = 0; c < rows.locals; ++c) {
      if (whole[at(c)] <= felt * felt * felt * felt * steepest) continue;
      const double share = squared(c) / whole[at(c)];
      if (share > best_share) best = c, best_share = share;
    }
    if (best < 0) break;
    chosen.push_back(best);
    const double length = squared(best);
    for (int c = 0; c < rows.locals; ++c) {
      if (c == best) continue;
      double along = 0.0;
      for (int i = 0; i < rows.rows; ++i) along += column[at(c * rows.rows + i)] * column[at(best * rows.rows + i)];
      for (int i = 0; i < rows.rows; ++i) {
        column[at(c * rows.rows + i)] -= along / length * column[at(best * rows.rows + i)];
      }
    }
    for (int i = 0; i < rows.rows; ++i) column[at(best * rows.rows + i)] = 0.0;
  }
  if (chosen.empty()) return false;
  std::sort(chosen.begin(), chosen.end());

  LocalBlock block;
  block.first_row = rows.first_row;
  block.rows = rows.rows;
  block.first_local = static_cast<int>(local_.size());
  block.locals = static_cast<int>(chosen.size());
  block.first_retained = static_cast<int>(retained_.size());
  std::vector<int> locals;
  for (const int c : chosen) locals.push_back(candidates[at(c)]);
  std::sort(reads.begin(), reads.end());
  std::vector<int> rest;
  for (const int u : reads) {
    if (std::find(locals.begin(), locals.end(), u) == locals.end()) rest.push_back(u);
  }
  if (static_cast<int>(rest.size()) > most_retained) return false;
  block.retained = static_cast<int>(rest.size());
  const int index = static_cast<int>(blocks_.size());
  for (int k = 0; k < block.locals; ++k) {
    block_of_unknown_[at(locals[at(k)])] = index;
    place_in_block_[at(locals[at(k)])] = k;
  }
  for (int i = 0; i < rows.rows; ++i) {
    const int row = rows.first_row + i;
    block_of_row_[at(row)] = index;
    jacobian_begin_.push_back(pattern.begin[at(row)]);
    for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
      const int unknown = pattern.inner[at(k)];
      const auto found = std::find(locals.begin(), locals.end(), unknown);
      entry_.push_back(found != locals.end()
                           ? -1 - static_cast<int>(found - locals.begin())
                           : static_cast<int>(std::lower_bound(rest.begin(), rest.end(), unknown) - rest.begin()));
    }
    entry_begin_.push_back(static_cast<int>(entry_.size()));
  }
  local_.insert(local_.end(), locals.begin(), locals.end());
  retained_.insert(retained_.end(), rest.begin(), rest.end());
  blocks_.push_back(block);
  return true;
}

bool LocalElimination::update(Span<const double> jacobian) noexcept {
  int block_row = 0;
  for (const LocalBlock& block : blocks_) {
    const int d = block.rows, k = block.locals, p = block.retained;
    double m[most_rows][most_rows] = {}, rest[most_rows][most_retained] = {};
    for (int i = 0; i < d; ++i, ++block_row) {
      const double* value = jacobian.data() + jacobian_begin_[at(block_row)];
      for (int e = entry_begin_[at(block_row)]; e < entry_begin_[at(block_row) + 1]; ++e) {
        const int place = entry_[at(e)];
        (place < 0 ? m[i][-1 - place] : rest[i][place]) = *value++;
      }
    }
    // Householder's reflections, applied to everything and gathered in Q.
    double q[most_rows][most_rows] = {};
    for (int i = 0; i < d; ++i) q[i][i] = 1.0;
    for (int c = 0; c < k; ++c) {
      double squared = 0.0, above = 0.0;
      for (int i = c; i < d; ++i) squared += m[i][c] * m[i][c];
      for (int i = 0; i < c; ++i) above += m[i][c] * m[i][c];
      if (!(squared > lost * lost * (squared + above))) return false;
      const double alpha = m[c][c] > 0.0 ? -std::sqrt(squared) : std::sqrt(squared);
      double v[most_rows] = {};
      double norm = 0.0;
      for (int i = c; i < d; ++i) v[i] = m[i][c];
      v[c] -= alpha;
      for (int i = c; i < d; ++i) norm += v[i] * v[i];
      const double twice = 2.0 / norm;
      const auto reflect = [&](auto& matrix, int columns) {
        for (int j = 0; j < columns; ++j) {
          double sum = 0.0;
          for (int i = c; i < d; ++i) sum += v[i] * matrix[i][j];
          for (int i = c; i < d; ++i) matrix[i][j] -= twice * sum * v[i];
        }
      };
      reflect(m, k);
      reflect(rest, p);
      reflect(q, d);  // gathers Qᵀ
    }
    double* store_q = q_.data() + block.first_q;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) store_q[i * d + j] = q[i][j];
    }
    double* r = r_.data() + block.first_r;
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j) r[i * k + j] = m[i][j];
    }
    double* a = a_.data() + block.first_a;
    for (int i = k - 1; i >= 0; --i) {
      for (int j = 0; j < p; ++j) {
        double sum = rest[i][j];
        for (int l = i + 1; l < k; ++l) sum -= r[i * k + l] * a[l * p + j];
        a[i * p + j] = sum / r[i * k + i];
      }
    }
    double* b = b_.data() + block.first_b;
    for (int i = k; i < d; ++i) {
      for (int j = 0; j < p; ++j) b[(i - k) * p + j] = rest[i][j];
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
