#include "core/kkt/profile_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace bowstring::kkt {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A pivot so small against what it was computed from is rounding.
constexpr double vanishing = 64.0 * std::numeric_limits<double>::epsilon();

/// target −= Σ_j factor_j · source_j over `count` numbers, four columns at once.
[[gnu::always_inline]] inline void subtract_four(double* __restrict target, const double* a, const double* b,
                                                 const double* c, const double* d, const double* factor,
                                                 int count) noexcept {
  const double fa = factor[0], fb = factor[1], fc = factor[2], fd = factor[3];
  for (int k = 0; k < count; ++k) target[k] -= (fa * a[k] + fb * b[k]) + (fc * c[k] + fd * d[k]);
}

[[gnu::always_inline]] inline void subtract_one(double* __restrict target, const double* source, double factor,
                                                int count) noexcept {
  for (int k = 0; k < count; ++k) target[k] -= factor * source[k];
}

[[gnu::always_inline]] inline double dot(const double* a, const double* b, int count) noexcept {
  double even = 0.0, odd = 0.0;
  int k = 0;
  for (; k + 1 < count; k += 2) {
    even += a[k] * b[k];
    odd += a[k + 1] * b[k + 1];
  }
  return k < count ? even + odd + a[k] * b[k] : even + odd;
}

}  // namespace

void ProfileMatrix::shape(std::vector<int> last) {
  last_ = std::move(last);
  begin_.resize(last_.size());
  int stored = 0;
  for (int c = 0; c < size(); ++c) {
    if (c > 0) last_[at(c)] = std::max(last_[at(c)], last_[at(c - 1)]);
    begin_[at(c)] = stored;
    stored += last_[at(c)] - c + 1;
  }
  values_.assign(at(stored), 0.0);
  reach_.resize(last_.size());
  first_.resize(last_.size());
  pivot_.resize(last_.size());
}

void ProfileMatrix::clear() noexcept { std::fill(values_.begin(), values_.end(), 0.0); }

void ProfileMatrix::find_reach() noexcept {
  int before = 0;
  for (int c = 0; c < size(); ++c) {
    const double* column = values_.data() + begin_[at(c)] - c;
    int row = last_[at(c)];
    while (row > c && row > before && column[row] == 0.0) --row;
    before = reach_[at(c)] = std::max(row, before);
  }
  int column = 0;
  for (int row = 0; row < size(); ++row) {
    while (reach_[at(column)] < row) ++column;
    first_[at(row)] = column;
  }
}

// Wider vectors where the machine has them: the same operations on each number, and so the same bits ("avx2" allows no
// fused ones).
#if defined(__x86_64__)
[[gnu::target_clones("avx2", "default")]]
#endif
PivotReport
ProfileMatrix::factor() noexcept {
  PivotReport report;
  find_reach();
  double largest = 0.0, growth = 0.0;
  for (int c = 0; c < size(); ++c) largest = std::max(largest, std::fabs(values_[at(begin_[at(c)])]));
  for (int c = 0; c < size(); ++c) {
    double* target = values_.data() + begin_[at(c)] - c;
    const double original = target[c];
    int j = first_[at(c)];
    const auto source = [&](int column) { return values_.data() + begin_[at(column)] - column; };
    // A column stores at least what the one before it reaches, and zeros below its own reach.
    for (; j + 3 < c; j += 4) {
      const double* s[4] = {source(j), source(j + 1), source(j + 2), source(j + 3)};
      const double factor[4] = {s[0][c] * pivot_[at(j)], s[1][c] * pivot_[at(j + 1)], s[2][c] * pivot_[at(j + 2)],
                                s[3][c] * pivot_[at(j + 3)]};
      const int common = reach_[at(j)];
      subtract_four(target + c, s[0] + c, s[1] + c, s[2] + c, s[3] + c, factor, common - c + 1);
      for (int i = 1; i < 4; ++i) {
        subtract_one(target + common + 1, s[i] + common + 1, factor[i], reach_[at(j + i)] - common);
      }
    }
    for (; j < c; ++j) {
      const double* s = source(j);
      subtract_one(target + c, s + c, s[c] * pivot_[at(j)], reach_[at(j)] - c + 1);
    }
    const double pivot = target[c];
    const bool lost = !(std::fabs(pivot) > vanishing * std::fabs(original)) || pivot == 0.0;
    if (lost) {
      if (report.vanishing++ == 0) report.first_vanishing = c;
    }
    // The sign of what rounding left means nothing, but the factor goes on.
    pivot_[at(c)] = pivot == 0.0 || !std::isfinite(pivot) ? vanishing * std::max(std::fabs(original), largest) : pivot;
    if (pivot < 0.0) ++report.negative;
    const double by_pivot = 1.0 / pivot_[at(c)];
    double steepest = 0.0;
    for (int row = c + 1; row <= reach_[at(c)]; ++row) {
      const double u = target[row];
      target[row] = u * by_pivot;
      steepest = std::max(steepest, std::fabs(u));
    }
    growth = std::max(growth, steepest * steepest * std::fabs(by_pivot));
  }
  report.growth = largest > 0.0 ? growth / largest : 1.0;
  return report;
}

#if defined(__x86_64__)
[[gnu::target_clones("avx2", "default")]]
#endif
void ProfileMatrix::solve(double* x) const noexcept {
  for (int c = 0; c < size(); ++c) {
    const double* column = values_.data() + begin_[at(c)];
    subtract_one(x + c + 1, column + 1, x[c], reach_[at(c)] - c);
  }
  for (int c = size() - 1; c >= 0; --c) {
    const double* column = values_.data() + begin_[at(c)];
    x[c] = x[c] / pivot_[at(c)] - dot(column + 1, x + c + 1, reach_[at(c)] - c);
  }
}

}  // namespace bowstring::kkt
