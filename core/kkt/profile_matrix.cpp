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

/// Four numbers side by side, wherever they stand (GCC and Clang). An alias would lose the alignment, and so does auto.
typedef double FourNumbers __attribute__((vector_size(32), aligned(8), may_alias));

/// target −= Σ_j factor_j · source_j over `count` numbers, and over up to three more, where all sources are zero.
[[gnu::always_inline]] inline void subtract_four(double* target, const double* const* source, const double* factor,
                                                 int count) noexcept {
  FourNumbers* t = reinterpret_cast<FourNumbers*>(target);
  const FourNumbers* a = reinterpret_cast<const FourNumbers*>(source[0]);
  const FourNumbers* b = reinterpret_cast<const FourNumbers*>(source[1]);
  const FourNumbers* c = reinterpret_cast<const FourNumbers*>(source[2]);
  const FourNumbers* d = reinterpret_cast<const FourNumbers*>(source[3]);
  const double fa = factor[0], fb = factor[1], fc = factor[2], fd = factor[3];
  for (int k = 0; 4 * k < count; ++k) t[k] -= (fa * a[k] + fb * b[k]) + (fc * c[k] + fd * d[k]);
}

[[gnu::always_inline]] inline void subtract_one(double* target, const double* source, double factor,
                                                int count) noexcept {
  FourNumbers* t = reinterpret_cast<FourNumbers*>(target);
  const FourNumbers* a = reinterpret_cast<const FourNumbers*>(source);
  for (int k = 0; 4 * k < count; ++k) t[k] -= factor * a[k];
}

/// Over `count` numbers, and up to three more that are zero in `a`.
[[gnu::always_inline]] inline double dot(const double* a, const double* b, int count) noexcept {
  const FourNumbers* va = reinterpret_cast<const FourNumbers*>(a);
  const FourNumbers* vb = reinterpret_cast<const FourNumbers*>(b);
  FourNumbers sum{};
  for (int k = 0; 4 * k < count; ++k) sum += va[k] * vb[k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

void ProfileMatrix::shape(std::vector<int> last) {
  last_ = std::move(last);
  begin_.resize(last_.size());
  int stored = 0;
  for (int c = 0; c < size(); ++c) {
    if (c > 0) last_[at(c)] = std::max(last_[at(c)], last_[at(c - 1)]);
    begin_[at(c)] = stored;
    stored += last_[at(c)] - c + 1 + padding;
  }
  values_.assign(at(stored), 0.0);
  reach_.resize(last_.size());
  pivot_.resize(last_.size());
}

void ProfileMatrix::clear() noexcept { std::fill(values_.begin(), values_.end(), 0.0); }

// Wider vectors where the machine has them: the same operations on each number, and so the same bits ("avx2" allows no
// fused ones).
#if defined(__x86_64__)
[[gnu::target_clones("avx2", "default")]]
#endif
PivotReport
ProfileMatrix::factor() noexcept {
  PivotReport report;
  double largest = 0.0, growth = 0.0;
  int first = 0;  // column that reaches the row in hand
  for (int c = 0; c < size(); ++c) largest = std::max(largest, std::fabs(values_[at(begin_[at(c)])]));
  for (int c = 0; c < size(); ++c) {
    double* target = values_.data() + begin_[at(c)] - c;
    const double original = target[c];
    // Entries that are zero at the column's lower end cost nothing; a factor fills what an earlier column reaches.
    int row = last_[at(c)];
    const int filled = c > 0 ? reach_[at(c - 1)] : 0;
    while (row > c && row > filled && target[row] == 0.0) --row;
    reach_[at(c)] = std::max(row, filled);
    while (reach_[at(first)] < c) ++first;
    int j = first;
    const auto source = [&](int column) { return values_.data() + begin_[at(column)] - column; };
    const auto one = [&](int column) {
      const double* s = source(column);
      subtract_one(target + c, s + c, s[c] * pivot_[at(column)], reach_[at(column)] - c + 1);
    };
    for (; j + 3 < c; j += 4) {
      const int end = reach_[at(j + 3)];
      if (end > last_[at(j)]) {  // the first one does not store so much
        for (int k = j; k < j + 4; ++k) one(k);
        continue;
      }
      const double* from[4] = {source(j) + c, source(j + 1) + c, source(j + 2) + c, source(j + 3) + c};
      const double factor[4] = {*from[0] * pivot_[at(j)], *from[1] * pivot_[at(j + 1)], *from[2] * pivot_[at(j + 2)],
                                *from[3] * pivot_[at(j + 3)]};
      subtract_four(target + c, from, factor, end - c + 1);
    }
    for (; j < c; ++j) one(j);
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
    for (int r = c + 1; r <= reach_[at(c)]; ++r) {
      const double u = target[r];
      target[r] = u * by_pivot;
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
