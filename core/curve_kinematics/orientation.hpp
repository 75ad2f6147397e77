#pragma once

#include <cmath>

#include "core/interfaces/kinematics.hpp"
#include "core/lie/s2.hpp"
#include "core/lie/small_matrix.hpp"
#include "core/lie/so3.hpp"

namespace bowstring {

/// ζ from one orientation to a later one, and its derivatives in the tangent numbers of both.
template <int m>
struct StationStrain {
  Vector<m> value;
  Matrix<m, m> by_earlier, by_later;
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

inline StationStrain<1> station_strain(const PlanarOrientation& earlier, const PlanarOrientation& later) noexcept {
  return {{{later.angle - earlier.angle}}, {{-1.0}}, {{1.0}}};
}
inline StationStrain<2> station_strain(const DirectionOrientation& earlier,
                                       const DirectionOrientation& later) noexcept {
  const lie::RelativeTurn turn = lie::relative_turn(earlier.rotation, later.rotation);
  return {turn.value, turn.by_a, turn.by_b};
}
inline StationStrain<3> station_strain(const FrameOrientation& earlier, const FrameOrientation& later) noexcept {
  const lie::RelativeRotation relative = lie::relative_rotation(earlier.rotation, later.rotation);
  return {relative.value, relative.by_a, relative.by_b};
}

/// Σ_a stress_a ∂²ζ_a over the tangent numbers of (earlier, later).
inline Matrix<2, 2> station_curvature(const PlanarOrientation&, const PlanarOrientation&, const Vector<1>&) noexcept {
  return {};
}
inline Matrix<4, 4> station_curvature(const DirectionOrientation& earlier, const DirectionOrientation& later,
                                      const Vector2& stress) noexcept {
  return lie::relative_turn_curvature(earlier.rotation, later.rotation, stress);
}
inline Matrix<6, 6> station_curvature(const FrameOrientation& earlier, const FrameOrientation& later,
                                      const Vector3& stress) noexcept {
  const Vector3 strain = lie::log(earlier.rotation.inverse() * later.rotation);
  return lie::relative_rotation_curvature(strain, stress);
}

/// Unit tangent t = R e₁.
inline Vector2 tangent(const PlanarOrientation& o) noexcept { return {{std::cos(o.angle), std::sin(o.angle)}}; }
inline Vector3 tangent(const DirectionOrientation& o) noexcept { return o.rotation.first_axis(); }
inline Vector3 tangent(const FrameOrientation& o) noexcept { return o.rotation.first_axis(); }

/// ∂t/∂δ. In space R Exp(δ) e₁ = R (e₁ + δ × e₁ + ½ δ × (δ × e₁) + …), with δ × e₁ = (0, δ₃, −δ₂).
inline Matrix<2, 1> tangent_gradient(const PlanarOrientation& o) noexcept {
  return {{-std::sin(o.angle), std::cos(o.angle)}};
}
inline Matrix<3, 2> tangent_gradient(const DirectionOrientation& o) noexcept {
  const Matrix3 r = o.rotation.matrix();
  Matrix<3, 2> out;
  out.set_column(0, -r.column(2));
  out.set_column(1, r.column(1));
  return out;
}
inline Matrix<3, 3> tangent_gradient(const FrameOrientation& o) noexcept {
  const Matrix3 r = o.rotation.matrix();
  Matrix3 out;
  out.set_column(1, -r.column(2));
  out.set_column(2, r.column(1));
  return out;
}

/// w·∂²t/∂δ². In space, with g = Rᵀw, the second-order term above is g·½(δ₁δ − |δ|² e₁).
inline Matrix<1, 1> tangent_curvature(const PlanarOrientation& o, const Vector2& w) noexcept {
  return {{-dot(w, tangent(o))}};
}
inline Matrix2 tangent_curvature(const DirectionOrientation& o, const Vector3& w) noexcept {
  return -dot(w, tangent(o)) * Matrix2::identity();
}
inline Matrix3 tangent_curvature(const FrameOrientation& o, const Vector3& w) noexcept {
  const Vector3 g = o.rotation.inverse() * w;
  const double half2 = 0.5 * g[1], half3 = 0.5 * g[2];
  return {{0.0, half2, half3, half2, -g[0], 0.0, half3, 0.0, -g[0]}};
}

}  // namespace bowstring
