#pragma once

#include "core/lie/so3.hpp"

namespace bowstring::lie {

/// A rigid motion of space, x ↦ R x + position; as a frame g = (R, p) along a curve, its tangent is R e₁.
struct Se3 {
  Rotation rotation;
  Vector3 position;

  static constexpr Se3 identity() noexcept { return {}; }
  /// [R p; 0 1]
  constexpr Matrix<4, 4> matrix() const noexcept {
    Matrix<4, 4> m = Matrix<4, 4>::identity();
    m.set_block(0, 0, rotation.matrix());
    for (int i = 0; i < 3; ++i) m(i, 3) = position[i];
    return m;
  }
  constexpr Se3 inverse() const noexcept { return {rotation.inverse(), -(rotation.inverse() * position)}; }

  friend constexpr Se3 operator*(const Se3& g, const Se3& h) noexcept {
    return {g.rotation * h.rotation, g.rotation * h.position + g.position};
  }
  friend constexpr Vector3 operator*(const Se3& g, const Vector3& point) noexcept {
    return g.rotation * point + g.position;
  }
};

/// Functions of twists ξ = (ω, ν), the body-fixed (left-invariant) coordinates of g⁻¹ dg/ds (preprint, section 3).
namespace se3 {

using Twist = Vector<6>;

constexpr Vector3 angular(const Twist& xi) noexcept { return {{xi[0], xi[1], xi[2]}}; }
constexpr Vector3 linear(const Twist& xi) noexcept { return {{xi[3], xi[4], xi[5]}}; }
constexpr Twist twist(const Vector3& omega, const Vector3& nu) noexcept {
  return {{omega[0], omega[1], omega[2], nu[0], nu[1], nu[2]}};
}

/// [ω^ ν; 0 0]
constexpr Matrix<4, 4> hat(const Twist& xi) noexcept {
  Matrix<4, 4> m;
  m.set_block(0, 0, bowstring::hat(angular(xi)));
  for (int i = 0; i < 3; ++i) m(i, 3) = xi[3 + i];
  return m;
}

/// The inverse of `hat`.
constexpr Twist vee(const Matrix<4, 4>& m) noexcept {
  return twist(bowstring::vee(m.block<3, 3>(0, 0)), {{m(0, 3), m(1, 3), m(2, 3)}});
}

/// (Exp ω, J_l(ω) ν)
inline Se3 exp(const Twist& xi) noexcept {
  return {lie::exp(angular(xi)), lie::left_jacobian(angular(xi)) * linear(xi)};
}

/// The twist with the smallest |ω| ≤ π: (Log R, J_l⁻¹(ω) p).
inline Twist log(const Se3& g) noexcept {
  const Vector3 omega = lie::log(g.rotation);
  return twist(omega, lie::left_jacobian_inverse(omega) * g.position);
}

/// Ad_g: (Ad_g ξ)^ = g ξ^ g⁻¹, [R 0; p^R R].
constexpr Matrix<6, 6> adjoint(const Se3& g) noexcept {
  const Matrix3 r = g.rotation.matrix();
  Matrix<6, 6> m;
  m.set_block(0, 0, r);
  m.set_block(3, 0, bowstring::hat(g.position) * r);
  m.set_block(3, 3, r);
  return m;
}

/// J_l: d Exp(ξ) Exp(ξ)⁻¹ = (J_l(ξ) dξ)^.
///
/// J_l = Σ adⁿ/(n + 1)! with ad = [ω^ 0; ν^ ω^], which multiplies like ω^ + ε ν^ with ε² = 0. So J_l = [J 0; Q J]
/// with J that of the rotations and Q its derivative at ω along ν:
///   Q = a ν^ + (a'/θ)(ω·ν) ω^ + b (ω^ν^ + ν^ω^) + (b'/θ)(ω·ν) ω^².
inline Matrix<6, 6> left_jacobian(const Twist& xi) noexcept {
  const Vector3 omega = angular(xi), nu = linear(xi);
  const JacobianCoefficients k = jacobian_coefficients(norm_squared(omega));
  const double along = dot(omega, nu);
  const Matrix3 w = bowstring::hat(omega), v = bowstring::hat(nu), ww = w * w;
  const Matrix3 j = Matrix3::identity() + k.a * w + k.b * ww;
  Matrix<6, 6> m;
  m.set_block(0, 0, j);
  m.set_block(3, 0, k.a * v + k.a_rate * along * w + k.b * (w * v + v * w) + k.b_rate * along * ww);
  m.set_block(3, 3, j);
  return m;
}

}  // namespace se3

}  // namespace bowstring::lie
