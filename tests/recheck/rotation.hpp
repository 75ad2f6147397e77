#pragma once

#include <cmath>

#include "tests/recheck/tape.hpp"

namespace recheck {

/// Three numbers; in the plane the third is 0.
template <class Scalar>
struct Vector {
  Scalar x{}, y{}, z{};
};
using Point = Vector<double>;

template <class A, class B>
using Common = decltype(A{} + B{});

template <class A, class B>
Vector<Common<A, B>> operator+(const Vector<A>& a, const Vector<B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B>
Vector<Common<A, B>> operator-(const Vector<A>& a, const Vector<B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class A, class B>
Vector<Common<A, B>> operator*(const A& a, const Vector<B>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class A, class B>
Common<A, B> dot(const Vector<A>& a, const Vector<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class A, class B>
Vector<Common<A, B>> cross(const Vector<A>& a, const Vector<B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Scalar>
Scalar norm(const Vector<Scalar>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
template <class Scalar>
Vector<Scalar> unit(const Vector<Scalar>& a) {
  return (Scalar(1.0) / norm(a)) * a;
}

/// The axes of a rotation: the columns of its matrix, x along the curve.
template <class Scalar>
struct Frame {
  Vector<Scalar> x, y, z;
};

/// `v` after the least turn that carries the unit vector a to b; not for opposite vectors.
template <class A, class B, class C>
auto least_turn(const Vector<A>& a, const Vector<B>& b, const Vector<C>& v) {
  using Scalar = Common<Common<A, B>, C>;
  const auto k = cross(a, b);
  const auto kv = cross(k, v);
  return v + kv + (Scalar(1.0) / (Scalar(1.0) + dot(a, b))) * cross(k, kv);
}

/// (arcsin √s)² for small s = sin² θ: θ² without the root that has no derivative at 0.
template <class Scalar>
Scalar squared_arcsine(const Scalar& s) {
  return s * (1.0 + s * (1.0 / 3.0 + s * (8.0 / 45.0 + s * (4.0 / 35.0 + s * (128.0 / 1575.0)))));
}

/// arcsin(√s)/√s for small s.
template <class Scalar>
Scalar arcsine_ratio(const Scalar& s) {
  return 1.0 + s * (1.0 / 6.0 + s * (3.0 / 40.0 + s * (5.0 / 112.0 + s * (35.0 / 1152.0 + s * (63.0 / 2816.0)))));
}

/// Below this sin² θ the series are exact to rounding, and no root is taken.
inline constexpr double small_sine_squared = 1e-3;

/// θ² of the angle between two unit vectors.
template <class Scalar>
Scalar squared_angle(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  using std::atan2;
  using std::sqrt;
  const Vector<Scalar> k = cross(a, b);
  const Scalar sine_squared = dot(k, k), cosine = dot(a, b);
  if (value_of(sine_squared) < small_sine_squared && value_of(cosine) > 0.0) return squared_arcsine(sine_squared);
  const Scalar angle = atan2(sqrt(sine_squared), cosine);
  return angle * angle;
}

/// The rotation vector of AᵀB in the axes of A (which are also B's components of it): n θ with
/// n sin θ = vee((AᵀB − BᵀA)/2) and cos θ = (tr AᵀB − 1)/2. Not at θ = π.
template <class Scalar>
Vector<Scalar> rotation_vector(const Frame<Scalar>& a, const Frame<Scalar>& b) {
  using std::atan2;
  using std::sqrt;
  const Scalar half = 0.5;
  const Vector<Scalar> sine = {half * (dot(a.z, b.y) - dot(a.y, b.z)), half * (dot(a.x, b.z) - dot(a.z, b.x)),
                               half * (dot(a.y, b.x) - dot(a.x, b.y))};
  const Scalar s = dot(sine, sine);
  const Scalar cosine = half * (dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z) - 1.0);
  if (value_of(s) < small_sine_squared && value_of(cosine) > 0.0) return arcsine_ratio(s) * sine;
  const Scalar root = sqrt(s);
  return (atan2(root, cosine) / root) * sine;
}

}  // namespace recheck
