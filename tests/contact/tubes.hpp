#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/contact/centerline.hpp"

namespace bowstring::contact::testing {

/// A vessel that owns its numbers.
struct Tube {
  int dimension = 3;
  std::vector<double> points;
  std::vector<double> radius;

  int nodes() const { return static_cast<int>(radius.size()); }
  double* node(int i) { return points.data() + i * dimension; }

  Centerline view(Interpolation interpolation) const {
    return {interpolation, dimension, nodes(), points.data(), radius.data()};
  }
};

using Curve = std::function<std::vector<double>(double)>;

/// Nodes of `curve` at n parameters evenly spread over [from, to].
inline Tube tube(const Curve& curve, double from, double to, int nodes, double radius) {
  Tube out;
  out.dimension = static_cast<int>(curve(from).size());
  for (int i = 0; i < nodes; ++i) {
    const std::vector<double> p = curve(from + (to - from) * i / (nodes - 1));
    out.points.insert(out.points.end(), p.begin(), p.end());
    out.radius.push_back(radius);
  }
  return out;
}

inline std::vector<double> line(double x) { return {x, 0.0}; }

/// Limbs along x at y = ±half_width, x ≥ 0, joined by a half circle; from (length, half_width) on.
inline Curve hairpin(double length, double half_width) {
  return [=](double s) -> std::vector<double> {
    const double bend = M_PI * half_width;
    if (s < length) return {length - s, half_width};
    if (s > length + bend) return {s - length - bend, -half_width};
    const double angle = (s - length) / half_width;
    return {-half_width * std::sin(angle), half_width * std::cos(angle)};
  };
}

inline std::vector<double> helix(double angle, double radius, double pitch) {
  return {radius * std::cos(angle), radius * std::sin(angle), pitch * angle / (2.0 * M_PI)};
}

/// A crooked tube with edges near 4 mm and a radius that varies, |dR/ds| up to about 0.2.
inline Tube crooked_tube(int dimension, int nodes, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Tube out;
  out.dimension = dimension;
  const double phase = 3.0 * uniform(random);
  for (int i = 0; i < nodes; ++i) {
    const double p[3] = {4.0 * i, 6.0 * std::sin(0.3 * i + phase), 4.0 * std::cos(0.4 * i + phase)};
    for (int k = 0; k < dimension; ++k) out.points.push_back(p[k] + 0.3 * uniform(random));
    out.radius.push_back(6.0 + std::sin(0.7 * i + phase) + 0.1 * uniform(random));
  }
  return out;
}

inline double dot(const double* a, const double* b, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

inline double norm(const double* a, int n) { return std::sqrt(dot(a, a, n)); }

}  // namespace bowstring::contact::testing
