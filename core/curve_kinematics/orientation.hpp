#pragma once

#include <cmath>

#include "core/interfaces/kinematics.hpp"
#include "core/lie/s2.hpp"
#include "core/lie/small_matrix.hpp"
#include "core/lie/so3.hpp"

namespace bowstring {

/// ζ from one angle to a later one, like `lie::RelativeTurn` and `lie::RelativeRotation`.
struct RelativeAngle {
  Vector<1> value;
  Matrix<1, 1> by_a{{-1.0}}, by_b{{1.0}};
};

/// The orientation of an edge or of a held tangent: one specialisation per manifold, with
///   dimension    of space,
///   coordinates  numbers that the field stores,
///   components   tangent numbers, which are as many as those of ζ,
///   straight     ζ is linear in the tangent numbers.
template <Manifold manifold>
struct Orientation;

/// An angle in the plane, not wrapped: ζ = θ_later − θ_earlier.
template <>
struct Orientation<Manifold::circle> {
  static constexpr int dimension = 2, coordinates = 1, components = 1;
  static constexpr bool straight = true;
  double angle = 0.0;

  static Orientation load(const double* q) noexcept { return {q[0]}; }
};

/// A direction in space: ζ is the turn by the shortest way, in the basis of the earlier one.
template <>
struct Orientation<Manifold::direction> {
  static constexpr int dimension = 3, coordinates = 4, components = 2;
  static constexpr bool straight = false;
  lie::Rotation rotation;

  static Orientation load(const double* q) noexcept { return {lie::Rotation::load(q)}; }
};

/// A frame in space: ζ = Log(R_earlierᵀ R_later).
template <>
struct Orientation<Manifold::rotation> {
  static constexpr int dimension = 3, coordinates = 4, components = 3;
  static constexpr bool straight = false;
  lie::Rotation rotation;

  static Orientation load(const double* q) noexcept { return {lie::Rotation::load(q)}; }
};

using PlanarOrientation = Orientation<Manifold::circle>;
using DirectionOrientation = Orientation<Manifold::direction>;
using FrameOrientation = Orientation<Manifold::rotation>;

/// ζ from orientation a to the later orientation b, with its derivatives in the tangent numbers of both.
inline RelativeAngle station_strain(const PlanarOrientation& a, const PlanarOrientation& b) noexcept {
  return {{{b.angle - a.angle}}};
}
inline lie::RelativeTurn station_strain(const DirectionOrientation& a, const DirectionOrientation& b) noexcept {
  return lie::relative_turn(a.rotation, b.rotation);
}
inline lie::RelativeRotation station_strain(const FrameOrientation& a, const FrameOrientation& b) noexcept {
  return lie::relative_rotation(a.rotation, b.rotation);
}
template <Manifold manifold>
using StationStrain = decltype(station_strain(Orientation<manifold>(), Orientation<manifold>()));

/// Σ_k stress_k ∂²ζ_k over the tangent numbers of (a, b).
inline Matrix<2, 2> station_curvature(const RelativeAngle&, const Vector<1>&) noexcept { return {}; }
inline Matrix<4, 4> station_curvature(const lie::RelativeTurn& strain, const Vector2& stress) noexcept {
  return lie::relative_turn_curvature(strain, stress);
}
inline Matrix<6, 6> station_curvature(const lie::RelativeRotation& strain, const Vector3& stress) noexcept {
  return lie::relative_rotation_curvature(strain, stress);
}

/// The orientation as a matrix R.
inline Matrix2 axes(const PlanarOrientation& o) noexcept {
  const double c = std::cos(o.angle), s = std::sin(o.angle);
  return {{c, -s, s, c}};
}
inline Matrix3 axes(const DirectionOrientation& o) noexcept { return o.rotation.matrix(); }
inline Matrix3 axes(const FrameOrientation& o) noexcept { return o.rotation.matrix(); }

/// Unit tangent t = R e₁.
template <int d>
Vector<d> tangent(const Matrix<d, d>& axes) noexcept {
  return axes.column(0);
}
inline Vector2 tangent(const PlanarOrientation& o) noexcept { return {{std::cos(o.angle), std::sin(o.angle)}}; }
inline Vector3 tangent(const DirectionOrientation& o) noexcept { return o.rotation.first_axis(); }
inline Vector3 tangent(const FrameOrientation& o) noexcept { return o.rotation.first_axis(); }

/// Component `k` of ∂t/∂δ. In space R Exp(δ) e₁ = R (e₁ + δ × e₁ + ½ δ × (δ × e₁) + …), with δ × e₁ = (0, δ₃, −δ₂).
template <Manifold manifold>
Vector<Orientation<manifold>::components> tangent_gradient(
    const Matrix<Orientation<manifold>::dimension, Orientation<manifold>::dimension>& axes, int k) noexcept {
  if constexpr (manifold == Manifold::circle) {
    return {{axes(k, 1)}};
  } else if constexpr (manifold == Manifold::direction) {
    return {{-axes(k, 2), axes(k, 1)}};
  } else {
    return {{0.0, -axes(k, 2), axes(k, 1)}};
  }
}

/// w·∂²t/∂δ². In space, with g = Rᵀw, the second-order term above is g·½(δ₁δ − |δ|² e₁).
template <Manifold manifold>
auto tangent_curvature(const Matrix<Orientation<manifold>::dimension, Orientation<manifold>::dimension>& axes,
                       const Vector<Orientation<manifold>::dimension>& w) noexcept {
  constexpr int m = Orientation<manifold>::components;
  const double along = -dot(w, axes.column(0));
  Matrix<m, m> out;
  for (int k = m == 3 ? 1 : 0; k < m; ++k) out(k, k) = along;
  if constexpr (m == 3) {
    for (int k = 1; k < m; ++k) out(0, k) = out(k, 0) = 0.5 * dot(w, axes.column(k));
  }
  return out;
}

}  // namespace bowstring
