#include "losses/transport/network-simplex/row_minimum.hpp"

#include <cstring>
#include <limits>

namespace bowstring::simplex {
namespace {

using Four = double __attribute__((vector_size(32)));

constexpr int chunk = 32;  // places whose minimum is found before it is asked where it is

/// Vectors are neither taken nor returned by value: how they are passed depends on the target.
[[gnu::always_inline]] inline void sums(const double* cost, const double* add, Four& out) {
  Four of_cost, of_add;
  std::memcpy(&of_cost, cost, sizeof of_cost);
  std::memcpy(&of_add, add, sizeof of_add);
  out = of_cost + of_add;
}

[[gnu::always_inline]] inline double smallest_of_chunk(const double* cost, const double* add) {
  Four a, b, c, d;
  sums(cost, add, a);
  sums(cost + 4, add + 4, b);
  for (int j = 8; j < chunk; j += 8) {
    sums(cost + j, add + j, c);
    sums(cost + j + 4, add + j + 4, d);
    a = c < a ? c : a;
    b = d < b ? d : b;
  }
  a = b < a ? b : a;
  const double left = a[1] < a[0] ? a[1] : a[0], right = a[3] < a[2] ? a[3] : a[2];
  return right < left ? right : left;
}

[[gnu::always_inline]] inline Minimum find(const double* cost, const double* add, int count) {
  double least = std::numeric_limits<double>::infinity();
  int from = 0, j = 0;
  for (; j + chunk <= count; j += chunk) {
    const double here = smallest_of_chunk(cost + j, add + j);
    if (here < least) {
      least = here;
      from = j;
    }
  }
  for (; j < count; ++j) {
    const double here = cost[j] + add[j];
    if (here < least) {
      least = here;
      from = j;
    }
  }
  if (least == std::numeric_limits<double>::infinity()) return {least, -1};
  while (cost[from] + add[from] != least) ++from;
  return {least, from};
}

Minimum find_anywhere(const double* cost, const double* add, int count) { return find(cost, add, count); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] Minimum find_with_avx2(const double* cost, const double* add, int count) {
  return find(cost, add, count);
}
const auto chosen = __builtin_cpu_supports("avx2") ? find_with_avx2 : find_anywhere;
#else
constexpr auto chosen = find_anywhere;
#endif

}  // namespace

Minimum row_minimum(const double* cost, const double* add, int count) noexcept { return chosen(cost, add, count); }

}  // namespace bowstring::simplex
