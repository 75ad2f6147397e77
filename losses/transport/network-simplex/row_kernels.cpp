#include "losses/transport/network-simplex/row_kernels.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace bowstring::simplex {
namespace {

using Four = double __attribute__((vector_size(32)));
using FourMasks = std::int64_t __attribute__((vector_size(32)));

constexpr double infinity = std::numeric_limits<double>::infinity();

// Vectors are neither taken nor returned by value: how they are passed depends on the target.
[[gnu::always_inline]] inline void load(const double* from, Four& out) { std::memcpy(&out, from, sizeof out); }

[[gnu::always_inline]] inline void keep_smaller(const Four& candidate, Four& least) {
  least = candidate < least ? candidate : least;
}

[[gnu::always_inline]] inline double smallest(const Four& a) {
  const double left = a[1] < a[0] ? a[1] : a[0], right = a[3] < a[2] ? a[3] : a[2];
  return right < left ? right : left;
}

template <int fours>
[[gnu::always_inline]] inline double chunk_minimum(const double* cost, const double* add) {
  Four of_cost, of_add, least[2];
  for (int k = 0; k < fours; ++k) {
    load(cost + 4 * k, of_cost);
    load(add + 4 * k, of_add);
    const Four sum = of_cost + of_add;
    if (k < 2) {
      least[k] = sum;
    } else {
      keep_smaller(sum, least[k % 2]);
    }
  }
  keep_smaller(least[1], least[0]);
  return smallest(least[0]);
}

[[gnu::always_inline]] inline void take(double candidate, int at, Minimum& best) {
  if (candidate < best.value) best = {candidate, at};
}

/// The last chunk of a row may reach back into the one before: what it finds anew is beyond.
[[gnu::always_inline]] inline Minimum minimum(const double* cost, const double* add, int count) {
  Minimum best{infinity, 0};
  int j = 0;
  for (; j + 32 <= count; j += 32) take(chunk_minimum<8>(cost + j, add + j), j, best);
  if (count < 8) {
    for (; j < count; ++j) take(cost[j] + add[j], j, best);
    return best;
  }
  for (; j + 8 <= count; j += 8) take(chunk_minimum<2>(cost + j, add + j), j, best);
  if (j < count) take(chunk_minimum<2>(cost + count - 8, add + count - 8), count - 8, best);
  return best;
}

/// The largest |cost|.
[[gnu::always_inline]] inline double largest(const double* cost, std::size_t count) {
  const Four zero{0.0, 0.0, 0.0, 0.0};
  Four here, least[2] = {zero, zero}, most[2] = {zero, zero};
  std::size_t k = 0;
  for (; k + 8 <= count; k += 8) {
    for (std::size_t part = 0; part < 2; ++part) {
      load(cost + k + 4 * part, here);
      keep_smaller(here, least[part]);
      most[part] = here > most[part] ? here : most[part];
    }
  }
  for (int part = 0; part < 2; ++part) keep_smaller(-most[part], least[0]);
  keep_smaller(least[1], least[0]);
  double out = -smallest(least[0]);
  for (; k < count; ++k) out = std::fabs(cost[k]) > out ? std::fabs(cost[k]) : out;
  return out;
}

[[gnu::always_inline]] inline RowLook look(const double* cost, const double* add, double of_row, double tolerance,
                                           int count) {
  const Four zero{0.0, 0.0, 0.0, 0.0}, none = zero + infinity, row = zero + of_row, limit = zero + tolerance;
  Four least[2] = {none, none}, slack[2] = {none, none}, of_cost, of_add;
  FourMasks within{0, 0, 0, 0};  // −1 for each
  int j = 0;
  for (; j + 8 <= count; j += 8) {
    for (int part = 0; part < 2; ++part) {
      load(cost + j + 4 * part, of_cost);
      load(add + j + 4 * part, of_add);
      const Four reduced = of_cost + of_add - row;
      const FourMasks tight = reduced <= limit;
      within += tight;
      keep_smaller(reduced, least[part]);
      keep_smaller(tight ? none : reduced, slack[part]);
    }
  }
  keep_smaller(least[1], least[0]);
  keep_smaller(slack[1], slack[0]);
  RowLook out{smallest(least[0]), smallest(slack[0]), -(within[0] + within[1] + within[2] + within[3])};
  for (; j < count; ++j) {
    const double reduced = cost[j] + add[j] - of_row;
    out.least = reduced < out.least ? reduced : out.least;
    out.slack = reduced > tolerance && reduced < out.slack ? reduced : out.slack;
    out.within += reduced <= tolerance ? 1 : 0;
  }
  return out;
}

Minimum minimum_anywhere(const double* cost, const double* add, int count) { return minimum(cost, add, count); }
double largest_anywhere(const double* cost, std::size_t count) { return largest(cost, count); }
RowLook look_anywhere(const double* cost, const double* add, double of_row, double tolerance, int count) {
  return look(cost, add, of_row, tolerance, count);
}

struct Kernels {
  decltype(&minimum_anywhere) row_minimum = minimum_anywhere;
  decltype(&largest_anywhere) largest = largest_anywhere;
  decltype(&look_anywhere) look_at_row = look_anywhere;
};

#if defined(__x86_64__)
[[gnu::target("avx2")]] Minimum minimum_with_avx2(const double* cost, const double* add, int count) {
  return minimum(cost, add, count);
}
[[gnu::target("avx2")]] double largest_with_avx2(const double* cost, std::size_t count) { return largest(cost, count); }
[[gnu::target("avx2")]] RowLook look_with_avx2(const double* cost, const double* add, double of_row, double tolerance,
                                               int count) {
  return look(cost, add, of_row, tolerance, count);
}

const Kernels kernels =
    __builtin_cpu_supports("avx2") ? Kernels{minimum_with_avx2, largest_with_avx2, look_with_avx2} : Kernels{};
#else
constexpr Kernels kernels;
#endif

}  // namespace

Minimum row_minimum(const double* cost, const double* add, int count) noexcept {
  return kernels.row_minimum(cost, add, count);
}

int place_of(const Minimum& minimum, const double* cost, const double* add) noexcept {
  int place = minimum.from;
  while (cost[place] + add[place] != minimum.value) ++place;
  return place;
}

double largest_below(const double* cost, std::size_t count, double barrier) noexcept {
  double out = kernels.largest(cost, count);
  if (out < barrier) return out;
  out = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double size = std::fabs(cost[k]);
    out = size < barrier && size > out ? size : out;
  }
  return out;
}

RowLook look_at_row(const double* cost, const double* add, double of_row, double tolerance, int count) noexcept {
  return kernels.look_at_row(cost, add, of_row, tolerance, count);
}

}  // namespace bowstring::simplex
