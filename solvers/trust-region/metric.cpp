#include "solvers/trust-region/metric.hpp"

#include <cmath>

#include "solvers/newton/diagnosis.hpp"

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
  // Rotations: what edges give up for their closure, but their lengths, and whatever has a lever.
  std::vector<char> rotation(n, 0);
  for (const int u : problem.local_unknowns()) rotation[static_cast<std::size_t>(u)] = 1;
  for (std::size_t u = 0; u < n; ++u) {
    if (problem.stationarity_scale()[u] != 1.0) rotation[u] = 1;
    if (after[u] != before[u]) rotation[u] = 0;
  }
  length_ = newton::extent(q);
  if (!(length_ > 0.0)) length_ = 1.0;
  const double arm = length_ / two_pi;
  weight_.resize(n);
  for (std::size_t u = 0; u < n; ++u) weight_[u] = (rotation[u] != 0 ? arm * arm : 1.0) / static_cast<double>(n);
}

double Metric::norm(Span<const double> delta) const noexcept { return std::sqrt(product(delta, delta)); }

double Metric::product(Span<const double> one, Span<const double> other) const noexcept {
  double sum = 0.0;
  for (std::size_t u = 0; u < weight_.size(); ++u) sum += weight_[u] * one[u] * other[u];
  return sum;
}

}  // namespace bowstring::trust_region
