#pragma once

#include <cmath>

#include "core/lie/so3.hpp"

namespace bowstring::lie {

/// A rigid motion of the plane, x ↦ R(angle) x + position. The angle is not wrapped.
struct Se2 {
  double angle = 0.0;
  Vector2 position;

  static constexpr Se2 identity() noexcept { return {}; }
  Matrix2 rotation() const noexcept {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c, -s, s, c}};
  }
  /// [R p; 0 1]
  Matrix3 matrix() const noexcept {
    Matrix3 m = Matrix3::identity();
    m.set_block(0, 0, rotation());
    m(0, 2) = position[0];
    m(1, 2) = position[1];
    return m;
  }
  Se2 inverse() const noexcept { return {-angle, -(rotation().transpose() * position)}; }

  friend Se2 operator*(const Se2& g, const Se2& h) noexcept {
    return {g.angle + h.angle, g.rotation() * h.position + g.position};
  }
  friend Vector2 operator*(const Se2& g, const Vector2& point) noexcept { return g.rotation() * point + g.position; }
};

/// Functions of twists ξ = (ω, ν₁, ν₂), the body-fixed (left-invariant) coordinates of g⁻¹ dg/ds.
namespace se2 {

using Twist = Vector<3>;

/// [ω^ ν; 0 0]
constexpr Matrix3 hat(const Twist& xi) noexcept {
  Matrix3 m;
  m(0, 1) = -xi[0];
  m(1, 0) = xi[0];
  m(0, 2) = xi[1];
  m(1, 2) = xi[2];
  return m;
}

/// The inverse of `hat`.
constexpr Twist vee(const Matrix3& m) noexcept { return {{0.5 * (m(1, 0) - m(0, 1)), m(0, 2), m(1, 2)}}; }

/// (ω, V ν) with V = (sin ω/ω) I + ((1 − cos ω)/ω) J, J the quarter turn.
inline Se2 exp(const Twist& xi) noexcept {
  const double omega = xi[0];
  const JacobianCoefficients k = jacobian_coefficients(omega * omega);
  const double along = 1.0 - omega * omega * k.b;
  const double across = omega * k.a;
  return {omega, {{along * xi[1] - across * xi[2], across * xi[1] + along * xi[2]}}};
}

/// The twist with the smallest |ω| ≤ π: (ω, V⁻¹ p) with V⁻¹ = (ω/2)cot(ω/2) I − (ω/2) J.
inline Twist log(const Se2& g) noexcept {
  constexpr double turn = 6.283185307179586476925;
  const double omega = std::remainder(g.angle, turn);
  const double along = 1.0 - omega * omega * inverse_jacobian_coefficients(omega * omega).c;
  const double across = 0.5 * omega;
  const Vector2& p = g.position;
  return {{omega, along * p[0] + across * p[1], along * p[1] - across * p[0]}};
}

/// Ad_g: (Ad_g ξ)^ = g ξ^ g⁻¹, [1 0; −J p R].
inline Matrix3 adjoint(const Se2& g) noexcept {
  Matrix3 m;
  m(0, 0) = 1.0;
  m(1, 0) = g.position[1];
  m(2, 0) = -g.position[0];
  m.set_block(1, 1, g.rotation());
  return m;
}

/// J_l: d Exp(ξ) Exp(ξ)⁻¹ = (J_l(ξ) dξ)^.
///
/// J_l = Σ adⁿ/(n + 1)! with ad = [0 0; −Jν ωJ], hence [1 0; q V] with V as in `exp` and
/// q = Σ_{n≥1} (ωJ)ⁿ⁻¹(−Jν)/(n + 1)! = (a I + b ωJ)(−Jν) = −a Jν + b ων.
inline Matrix3 left_jacobian(const Twist& xi) noexcept {
  const double omega = xi[0];
  const JacobianCoefficients k = jacobian_coefficients(omega * omega);
  const double along = 1.0 - omega * omega * k.b;
  const double across = omega * k.a;
  return {{1.0, 0.0, 0.0,                                      //
           k.a * xi[2] + k.b * omega * xi[1], along, -across,  //
           -k.a * xi[1] + k.b * omega * xi[2], across, along}};
}

}  // namespace se2

}  // namespace bowstring::lie
