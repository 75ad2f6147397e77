#pragma once

#include <doctest/doctest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <random>
#include <vector>

#include "core/lie/so3.hpp"

/// What the group operations should give, to 50 digits, from definitions that the code under test does not use: the
/// matrix exponential by its power series, and derivatives by central differences.
namespace bowstring::reference {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

inline constexpr double pi = 3.14159265358979323846;

inline Real widen(double x) { return Real(x); }
template <int N>
Vector<N, Real> widen(const Vector<N>& v) {
  Vector<N, Real> out;
  for (int i = 0; i < N; ++i) out[i] = v[i];
  return out;
}
template <int R, int C>
Matrix<R, C, Real> widen(const Matrix<R, C>& m) {
  Matrix<R, C, Real> out;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < C; ++j) out(i, j) = m(i, j);
  }
  return out;
}
/// A quaternion of doubles is a unit one to rounding only.
inline lie::BasicRotation<Real> widen(const lie::Rotation& r) {
  return lie::BasicRotation<Real>{r.w, r.x, r.y, r.z}.normalized();
}

template <int N>
double magnitude(const Vector<N, Real>& v) {
  return static_cast<double>(norm(v));
}
template <int R, int C>
double magnitude(const Matrix<R, C, Real>& m) {
  return magnitude(Vector<R * C, Real>{m.data});
}

/// |found − expected|/|expected| in the Frobenius norm; a test on it cannot pass on zeros.
template <class Found, class Expected>
double relative_error(const Found& found, const Expected& expected) {
  const double scale = magnitude(expected);
  REQUIRE(scale > 0.0);
  return magnitude(widen(found) - expected) / scale;
}

/// Scaling and squaring of the Taylor series.
template <int N>
Matrix<N, N, Real> matrix_exponential(const Matrix<N, N, Real>& m) {
  constexpr int squarings = 20;
  const Matrix<N, N, Real> small = m / Real(1 << squarings);
  Matrix<N, N, Real> term = Matrix<N, N, Real>::identity();
  Matrix<N, N, Real> sum = term;
  for (int k = 1; k <= 16; ++k) {
    term = term * small / Real(k);
    sum += term;
  }
  for (int k = 0; k < squarings; ++k) sum = sum * sum;
  return sum;
}

/// Of a rotation by less than half a turn.
inline lie::BasicRotation<Real> quaternion(const Matrix<3, 3, Real>& m) {
  const Real w = sqrt(1 + m(0, 0) + m(1, 1) + m(2, 2)) / 2;
  const Vector<3, Real> axis = vee(m) / (2 * w);
  return {w, axis[0], axis[1], axis[2]};
}

inline lie::Rotation narrow(const lie::BasicRotation<Real>& r) {
  return {static_cast<double>(r.w), static_cast<double>(r.x), static_cast<double>(r.y), static_cast<double>(r.z)};
}
template <int N>
Vector<N> narrow(const Vector<N, Real>& v) {
  Vector<N> out;
  for (int i = 0; i < N; ++i) out[i] = static_cast<double>(v[i]);
  return out;
}

inline lie::BasicRotation<Real> exp(const Vector<3, Real>& v) {
  const Real angle = norm(v);
  if (angle == 0) return {};
  const Vector<3, Real> axis = v * Real(sin(angle / 2) / angle);
  return {cos(angle / 2), axis[0], axis[1], axis[2]};
}

inline Vector<3, Real> log(const lie::BasicRotation<Real>& r) {
  const Vector<3, Real> axis{{r.x, r.y, r.z}};
  const Real sine = norm(axis);
  if (sine == 0) return {};
  return axis * Real((r.w < 0 ? -2 : 2) * atan2(sine, abs(r.w)) / sine);
}

inline constexpr double step = 1e-12;

/// ∂f/∂x at 0, f from R^n to vectors or matrices; `at(j)` of the result is the derivative along axis j.
template <int n, class Function>
auto derivatives(const Function& f) {
  const Real h(step);
  std::vector<decltype(f(Vector<n, Real>{}))> out;
  for (int j = 0; j < n; ++j) {
    const Vector<n, Real> ahead = h * Vector<n, Real>::unit(j);
    out.push_back((f(ahead) - f(-ahead)) / (2 * h));
  }
  return out;
}

/// ∂f/∂x at 0 of f from R^n to R^m.
template <int m, int n, class Function>
Matrix<m, n, Real> jacobian(const Function& f) {
  const auto columns = derivatives<n>(f);
  Matrix<m, n, Real> out;
  for (int j = 0; j < n; ++j) out.set_column(j, columns[static_cast<std::size_t>(j)]);
  return out;
}

/// Second derivatives at 0 of f from R^n to R.
template <int n, class Function>
Matrix<n, n, Real> hessian(const Function& f) {
  const Real h(step);
  Matrix<n, n, Real> out;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vector<n, Real> p = h * Vector<n, Real>::unit(i), q = h * Vector<n, Real>::unit(j);
      out(i, j) = (f(p + q) - f(p - q) - f(q - p) + f(-p - q)) / (4 * h * h);
    }
  }
  return out;
}

/// The same numbers on every run and on every standard library.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  /// Uniform in [−1, 1).
  double next() { return 2.0 * (static_cast<double>(engine_()) / 4294967296.0) - 1.0; }
  template <int N>
  Vector<N> vector() {
    Vector<N> v;
    for (int i = 0; i < N; ++i) v[i] = next();
    return v;
  }
  Vector3 direction() { return normalized(vector<3>()); }
  lie::Rotation rotation() {
    const Vector<4> q = normalized(vector<4>());
    return {q[0], q[1], q[2], q[3]};
  }

 private:
  std::mt19937 engine_;
};

/// Angles where formulas change or lose digits: near 0, ordinary, near π.
inline const std::vector<double>& angles() {
  static const std::vector<double> list{1e-8,   1e-4,   0.0632, 0.0633, 0.0999,    0.1001,   0.7,
                                        1.0471, 1.0473, 1.9,    2.9,    pi - 1e-3, pi - 1e-7};
  return list;
}

/// Rotation vectors of those angles about axes drawn with `seed`.
inline std::vector<Vector3> rotation_vectors(unsigned seed) {
  Numbers numbers(seed);
  std::vector<Vector3> out;
  for (const double angle : angles()) out.push_back(angle * numbers.direction());
  return out;
}

}  // namespace bowstring::reference
