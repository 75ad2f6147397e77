#include "solvers/trust-region/metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring::trust_region {

namespace {
constexpr double two_pi = 6.283185307179586;
constexpr double probe = 1e-3;  // of a tangent number: it moves the value of a real unknown, and of no rotation
}  // namespace

void Metric::set_up(const Problem& problem, Span<const double> q) {
  const auto n = static_cast<std::size_t>(problem.unknowns());
  std::vector<double> before(n), after(n), moved(q.size());
  problem.values(q, before);
  problem.retract(q, std::vector<double>(n, probe), moved);
  problem.values(moved, after);
  int farthest = -1;
  length_ = extent(problem, q, farthest);
  // A scene without positions: the length of its edges, each of which has up to three rotations.
  double edges = 0.0;
  for (std::size_t u = 0; u < n; ++u) {
    if (after[u] == before[u]) edges += problem.stationarity_scale()[u] / 3.0;
  }
  length_ = std::max(length_, edges);
  if (!(length_ > 0.0)) length_ = 1.0;
  const double arm = length_ / two_pi;
  weight_.resize(n);
  for (std::size_t u = 0; u < n; ++u) {
    const double to_length = after[u] == before[u] ? arm : 1.0;
    weight_[u] = to_length * to_length / static_cast<double>(n);
  }
}

double Metric::norm(Span<const double> delta) const noexcept { return std::sqrt(product(delta, delta)); }

double Metric::product(Span<const double> one, Span<const double> other) const noexcept {
  double sum = 0.0;
  for (std::size_t u = 0; u < weight_.size(); ++u) sum += weight_[u] * one[u] * other[u];
  return sum;
}

double Metric::extent(const Problem& problem, Span<const double> q, int& farthest) const {
  std::vector<double> value(static_cast<std::size_t>(problem.unknowns()));
  problem.values(q, value);
  farthest = -1;
  if (value.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  farthest = static_cast<int>((-*low > *high ? low : high) - value.begin());
  return *high - *low;
}

}  // namespace bowstring::trust_region
