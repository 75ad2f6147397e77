#pragma once

#include <functional>

#include "core/check/differences.hpp"
#include "tests/kinematics/declared_curve.hpp"

namespace bowstring::testing {

inline double largest(const std::vector<double>& numbers) {
  double out = 0.0;
  for (const double x : numbers) out = std::max(out, std::abs(x));
  return out;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

inline std::vector<double> random_numbers(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> out(at(count));
  for (double& x : out) x = uniform(random);
  return out;
}

/// Rows: the derivative of `f` with respect to each unknown along its retraction, by fourth-order differences.
template <class Declared>
std::vector<std::vector<double>> differences(const Declared& curve, const std::vector<double>& q,
                                             const std::function<std::vector<double>(const std::vector<double>&)>& f,
                                             double step = 1e-4) {
  std::vector<std::vector<double>> rows;
  for (int u = 0; u < curve.unknowns(); ++u) {
    const std::vector<double> a = f(curve.moved(q, u, -2.0 * step)), b = f(curve.moved(q, u, -step));
    const std::vector<double> c = f(curve.moved(q, u, step)), d = f(curve.moved(q, u, 2.0 * step));
    std::vector<double> row(a.size());
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = first_difference(a[i], b[i], c[i], d[i], step);
    rows.push_back(row);
  }
  return rows;
}

/// The symmetric part of the differences of a gradient: for left-invariant derivatives X_i the Taylor coefficients of
/// δ ↦ f(q · Exp δ) are ½ (X_i X_j + X_j X_i) f.
inline std::vector<double> symmetric_part(const std::vector<std::vector<double>>& rows) {
  const std::size_t n = rows.size();
  std::vector<double> out(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) out[i * n + j] = 0.5 * (rows[i][j] + rows[j][i]);
  }
  return out;
}

inline std::vector<double> weighted_rows(const std::vector<double>& weight, const std::vector<double>& matrix,
                                         int columns) {
  std::vector<double> out(at(columns), 0.0);
  for (std::size_t r = 0; r < weight.size(); ++r) {
    for (int c = 0; c < columns; ++c) out[at(c)] += weight[r] * matrix[r * at(columns) + at(c)];
  }
  return out;
}

struct Tolerance {
  double jacobian = 1e-9, curvature = 1e-8;  ///< relative to the largest entry
};

/// B against differences of y, and Σ stress ∂²y/∂δ² against differences of stressᵀB, number by number.
template <class Declared>
void check_site(const Declared& curve, Site which, const std::vector<double>& q, Tolerance tolerance = {}) {
  const SiteDeclaration& site = curve.site(which);
  const int n = curve.unknowns();
  const int numbers = site.count * site.values;
  REQUIRE(numbers > 0);

  const std::vector<double> jacobian = curve.jacobian(which, q);
  const auto columns = differences(curve, q, [&](const std::vector<double>& p) { return curve.values(which, p); });
  std::vector<double> expected(jacobian.size());
  for (int r = 0; r < numbers; ++r) {
    for (int u = 0; u < n; ++u) expected[at(r * n + u)] = columns[at(u)][at(r)];
  }
  REQUIRE(largest(expected) > 1e-3);
  CHECK(largest_difference(jacobian, expected) <= tolerance.jacobian * largest(expected));

  const std::vector<double> stress = random_numbers(numbers, 7);
  const std::vector<double> curvature = curve.curvature(which, q, stress);
  if (site.linear) {
    CHECK(largest(curvature) == 0.0);
    return;
  }
  const std::vector<double> by_differences = symmetric_part(differences(
      curve, q, [&](const std::vector<double>& p) { return weighted_rows(stress, curve.jacobian(which, p), n); }));
  // Near a straight line the curvature of a direction's turn is of the order of the turn itself.
  REQUIRE(largest(by_differences) > 1e-10);
  CHECK(largest_difference(curvature, by_differences) <= tolerance.curvature * std::max(largest(by_differences), 1e-2));
}

/// An isotropic energy of the strain that also reads ds and s where they vary: what laws see of a station whose basis
/// is the kinematics' own. E = ½ |ζ|²/ds + a |ζ|⁴/4 + b ds² s, with a and b different at each station.
template <class Declared>
struct IsotropicEnergy {
  const Declared& curve;
  const SiteDeclaration& site = curve.site(Site::station);
  int components = site.values - (site.lengths_vary ? 2 : 0);

  struct Station {
    double energy = 0.0;
    std::vector<double> stress, modulus;  ///< values, values × values
  };

  Station at_station(int k, const double* y) const {
    const int m = components, v = site.values;
    const double quartic = 0.3 + 0.1 * k, lengthwise = 0.02 + 0.01 * k;
    const double ds = site.lengths_vary ? y[m] : site.ds[at(k)];
    const double s = site.lengths_vary ? y[m + 1] : site.arc[at(k)];
    double squared = 0.0;
    for (int i = 0; i < m; ++i) squared += y[i] * y[i];
    Station out;
    out.energy = 0.5 * squared / ds + 0.25 * quartic * squared * squared + lengthwise * ds * ds * s;
    out.stress.assign(at(v), 0.0);
    out.modulus.assign(at(v * v), 0.0);
    const double secant = 1.0 / ds + quartic * squared;
    for (int i = 0; i < m; ++i) {
      out.stress[at(i)] = secant * y[i];
      for (int j = 0; j < m; ++j) out.modulus[at(i * v + j)] = (i == j ? secant : 0.0) + 2.0 * quartic * y[i] * y[j];
    }
    if (!site.lengths_vary) return out;
    out.stress[at(m)] = -0.5 * squared / (ds * ds) + 2.0 * lengthwise * ds * s;
    out.stress[at(m + 1)] = lengthwise * ds * ds;
    for (int i = 0; i < m; ++i) out.modulus[at(i * v + m)] = out.modulus[at(m * v + i)] = -y[i] / (ds * ds);
    out.modulus[at(m * v + m)] = squared / (ds * ds * ds) + 2.0 * lengthwise * s;
    out.modulus[at(m * v + m + 1)] = out.modulus[at((m + 1) * v + m)] = 2.0 * lengthwise * ds;
    return out;
  }

  double energy(const std::vector<double>& q) const {
    const std::vector<double> y = curve.values(Site::station, q);
    double sum = 0.0;
    for (int k = 0; k < site.count; ++k) sum += at_station(k, y.data() + k * site.values).energy;
    return sum;
  }
  std::vector<double> stress(const std::vector<double>& q) const {
    const std::vector<double> y = curve.values(Site::station, q);
    std::vector<double> out;
    for (int k = 0; k < site.count; ++k) {
      const Station station = at_station(k, y.data() + k * site.values);
      out.insert(out.end(), station.stress.begin(), station.stress.end());
    }
    return out;
  }
  std::vector<double> gradient(const std::vector<double>& q) const {
    return weighted_rows(stress(q), curve.jacobian(Site::station, q), curve.unknowns());
  }
  /// BᵀCB + Σ stress ∂²y/∂δ².
  std::vector<double> hessian(const std::vector<double>& q) const {
    const int n = curve.unknowns(), v = site.values;
    const std::vector<double> y = curve.values(Site::station, q);
    const std::vector<double> b = curve.jacobian(Site::station, q);
    std::vector<double> out = curve.curvature(Site::station, q, stress(q));
    for (int k = 0; k < site.count; ++k) {
      const Station station = at_station(k, y.data() + k * v);
      for (int a = 0; a < v; ++a) {
        for (int c = 0; c < v; ++c) {
          const double modulus = station.modulus[at(a * v + c)];
          const double* row_a = b.data() + (k * v + a) * n;
          const double* row_c = b.data() + (k * v + c) * n;
          for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) out[at(i * n + j)] += modulus * row_a[i] * row_c[j];
          }
        }
      }
    }
    return out;
  }
};

/// Gradient and Hessian of an isotropic energy against differences: B and curvature where only |ζ| has a meaning.
template <class Declared>
void check_isotropic_energy(const Declared& curve, const std::vector<double>& q, Tolerance tolerance = {}) {
  const IsotropicEnergy<Declared> energy{curve};
  const auto slopes =
      differences(curve, q, [&](const std::vector<double>& p) { return std::vector<double>{energy.energy(p)}; });
  std::vector<double> expected;
  for (const auto& slope : slopes) expected.push_back(slope[0]);
  REQUIRE(largest(expected) > 1e-12);
  CHECK(largest_difference(energy.gradient(q), expected) <= tolerance.jacobian * std::max(1.0, largest(expected)));

  const std::vector<double> second =
      symmetric_part(differences(curve, q, [&](const std::vector<double>& p) { return energy.gradient(p); }));
  REQUIRE(largest(second) > 1e-3);
  CHECK(largest_difference(energy.hessian(q), second) <= tolerance.curvature * largest(second));
}

}  // namespace bowstring::testing
