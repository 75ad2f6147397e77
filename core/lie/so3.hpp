#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/lie/small_matrix.hpp"

/// Lie groups of rotations and rigid motions, with what second-order methods need of them.
///
/// Conventions. Tangents are body tangents: a rotation moves as R Exp(δ), a motion as g Exp(δ). A second derivative on
/// a group is the Hessian at 0 of the function δ ↦ E(q Exp δ) of Rⁿ. v^ is hat(v), θ = |v|. Angles are in rad.
/// Closed forms: J. Solà, J. Deray, D. Atchuthan, "A micro Lie theory for state estimation in robotics" (2018),
/// appendices A to D; the second-order ones are derived where they stand.
namespace bowstring::lie {

namespace detail {

/// (−1)^k/(first + 2k)!, k = 0 … n − 1.
template <std::size_t n>
constexpr std::array<double, n> alternating_reciprocal_factorials(int first) {
  std::array<double, n> out{};
  double factorial = 1.0;
  for (int i = 2; i <= first; ++i) factorial *= i;
  int last = first;
  double sign = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    out[k] = sign / factorial;
    factorial *= (last + 1.0) * (last + 2.0);
    last += 2;
    sign = -sign;
  }
  return out;
}

/// Σ c[k] x^k
template <std::size_t n, class T>
constexpr T polynomial(const std::array<double, n>& c, const T& x) {
  T sum = T(c[n - 1]);
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + T(c[k]);
  return sum;
}

/// Σ c[k] x^k and its first two derivatives.
struct PolynomialJet {
  double value = 0.0, first = 0.0, second = 0.0;
};
template <std::size_t n>
constexpr PolynomialJet polynomial_jet(const std::array<double, n>& c, double x) noexcept {
  PolynomialJet p;
  for (std::size_t k = n; k-- > 0;) {
    p.second = p.second * x + 2.0 * p.first;
    p.first = p.first * x + p.value;
    p.value = p.value * x + c[k];
  }
  return p;
}

/// Up to here (a little beyond π²) the coefficients of the Jacobians are taken from series in θ². They hold full
/// precision on the whole range of log, which the closed forms lose near 0.
inline constexpr double series_range = 10.0;

}  // namespace detail

/// A rotation of space as a unit quaternion w + xi + yj + zk. `T` as in `Vector`.
template <class T = double>
struct BasicRotation {
  T w = T(1), x = T(0), y = T(0), z = T(0);

  static constexpr BasicRotation identity() { return {}; }
  /// Four numbers in the order w, x, y, z.
  static constexpr BasicRotation load(const T* q) { return {q[0], q[1], q[2], q[3]}; }
  constexpr void store(T* q) const { q[0] = w, q[1] = x, q[2] = y, q[3] = z; }

  constexpr BasicRotation inverse() const { return {w, -x, -y, -z}; }
  BasicRotation normalized() const {
    using std::sqrt;
    const T n = sqrt(w * w + x * x + y * y + z * z);
    return {w / n, x / n, y / n, z / n};
  }
  /// Its columns are the body axes in space.
  constexpr Matrix<3, 3, T> matrix() const {
    const T one(1), two(2);
    return {{one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y),  //
             two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x),  //
             two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)}};
  }
  /// R e₁, the tangent of a curve's frame.
  constexpr Vector<3, T> first_axis() const {
    const T one(1), two(2);
    return {{one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)}};
  }

  friend constexpr BasicRotation operator*(const BasicRotation& a, const BasicRotation& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
  friend constexpr Vector<3, T> operator*(const BasicRotation& r, const Vector<3, T>& v) {
    const Vector<3, T> axis{{r.x, r.y, r.z}};
    const Vector<3, T> turned = T(2) * cross(axis, v);
    return v + r.w * turned + cross(axis, turned);
  }
};

using Rotation = BasicRotation<>;

/// A turn about the first axis.
inline Rotation about_first_axis(double angle) noexcept {
  return {std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0, 0.0};
}

/// The rotation of an orthogonal matrix with determinant 1; rounding in its entries is not amplified, because the
/// largest quaternion component is found first (S. Shepperd, J. Guidance and Control 1 (1978) 223).
inline Rotation from_matrix(const Matrix3& m) noexcept {
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  int i = 0;
  for (int k = 1; k < 3; ++k) {
    if (m(k, k) > m(i, i)) i = k;
  }
  if (trace >= m(i, i)) {
    return Rotation{1.0 + trace, m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}.normalized();
  }
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  Vector3 axis;
  axis[i] = 1.0 + m(i, i) - m(j, j) - m(k, k);
  axis[j] = m(j, i) + m(i, j);
  axis[k] = m(k, i) + m(i, k);
  return Rotation{m(k, j) - m(j, k), axis[0], axis[1], axis[2]}.normalized();
}

/// The rotation about v by the angle |v|.
template <class T>
BasicRotation<T> exp(const Vector<3, T>& v) {
  using std::cos, std::sin, std::sqrt;
  const T squared = norm_squared(v);
  T cosine, factor;
  if (squared < T(0.01)) {
    // No square root: its derivatives do not exist at 0.
    constexpr auto cos_series = detail::alternating_reciprocal_factorials<6>(0);
    constexpr auto sinc_series = detail::alternating_reciprocal_factorials<6>(1);
    const T half_squared = squared * T(0.25);
    cosine = detail::polynomial(cos_series, half_squared);
    factor = T(0.5) * detail::polynomial(sinc_series, half_squared);
  } else {
    const T angle = sqrt(squared);
    cosine = cos(angle * T(0.5));
    factor = sin(angle * T(0.5)) / angle;
  }
  return {cosine, factor * v[0], factor * v[1], factor * v[2]};
}

/// The shortest v with exp(v) = r: |v| ≤ π. The half angle comes from its sine and its cosine together and so is
/// accurate near 0 and near π. At π the axis is the one that the quaternion has.
template <class T>
Vector<3, T> log(const BasicRotation<T>& r) {
  using std::atan2, std::sqrt;
  const bool other_cover = r.w < T(0);
  const T cosine = other_cover ? T(-r.w) : r.w;
  const Vector<3, T> axis = other_cover ? Vector<3, T>{{-r.x, -r.y, -r.z}} : Vector<3, T>{{r.x, r.y, r.z}};
  const T sine_squared = norm_squared(axis);
  const T tangent_squared = sine_squared / (cosine * cosine);
  if (tangent_squared < T(1e-3)) {
    constexpr std::array<double, 8> arctangent{1.0,     -1.0 / 3,  1.0 / 5,  -1.0 / 7,
                                               1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
    return axis * (T(2) * detail::polynomial(arctangent, tangent_squared) / cosine);
  }
  const T sine = sqrt(sine_squared);
  return axis * (T(2) * atan2(sine, cosine) / sine);
}

/// a = (1 − cos θ)/θ² and b = (θ − sin θ)/θ³ of J_r(v) = I − a v^ + b v^², and their rates a'(θ)/θ, b'(θ)/θ.
struct JacobianCoefficients {
  double a = 0.0, b = 0.0;
  double a_rate = 0.0, b_rate = 0.0;
};
/// `t` = θ².
inline JacobianCoefficients jacobian_coefficients(double t) noexcept {
  if (t < detail::series_range) {
    constexpr auto a_series = detail::alternating_reciprocal_factorials<16>(2);
    constexpr auto b_series = detail::alternating_reciprocal_factorials<16>(3);
    const detail::PolynomialJet a = detail::polynomial_jet(a_series, t);
    const detail::PolynomialJet b = detail::polynomial_jet(b_series, t);
    return {a.value, b.value, 2.0 * a.first, 2.0 * b.first};
  }
  const double angle = std::sqrt(t);
  const double half_sine = std::sin(0.5 * angle);
  const double sinc = std::sin(angle) / angle;
  const double a = 2.0 * half_sine * half_sine / t;
  const double b = (1.0 - sinc) / t;
  return {a, b, (sinc - 2.0 * a) / t, (a - 3.0 * b) / t};
}

/// c = 1/θ² − cot(θ/2)/(2θ) of J_r⁻¹(v) = I + ½ v^ + c v^², and its rate c'(θ)/θ. Singular at θ = 2π.
struct InverseJacobianCoefficients {
  double c = 0.0, c_rate = 0.0;
};
/// `t` = θ². From the partial fractions of the cotangent, c = Σ_{n≥1} 2/(4π²n² − t). The first pole is kept as it
/// is, the others become a series in t whose ratio at θ = π is 1/16: coefficients 2 (ζ(2k+2) − 1)/(2π)^{2k+2}. All
/// terms are positive, so that nothing cancels between 0 and π.
inline InverseJacobianCoefficients inverse_jacobian_coefficients(double t) noexcept {
  if (t < detail::series_range) {
    constexpr double first_pole = 39.478417604357434475;  // 4π²
    constexpr std::array<double, 15> other_poles{
        0.032672741512164447611,   0.00010564110705334699024, 5.6373702828768453026e-7,  3.3571419266574513601e-9,
        2.0742872904166045537e-11, 1.3000482138698973965e-13, 8.1960520556910085984e-16, 5.1801181961697243152e-18,
        3.2775391747017918398e-20, 2.0747401878593604517e-22, 1.3136241807166533778e-24, 8.3180031951892640914e-27,
        5.2672629968342308728e-29, 3.3354842988221443313e-31, 2.1122063323183885457e-33};
    const detail::PolynomialJet rest = detail::polynomial_jet(other_poles, t);
    const double pole = 2.0 / (first_pole - t);
    return {pole + rest.value, pole * pole + 2.0 * rest.first};
  }
  const double angle = std::sqrt(t);
  const double half_sine = std::sin(0.5 * angle);
  const double cotangent_term = 0.5 * std::cos(0.5 * angle) / (half_sine * angle);
  const double c = 1.0 / t - cotangent_term;
  return {c, (0.25 / (half_sine * half_sine) - cotangent_term - 2.0 * c) / t};
}

/// J_r: Exp(v)⁻¹ d Exp(v) = (J_r(v) dv)^.
inline Matrix3 right_jacobian(const Vector3& v) noexcept {
  const JacobianCoefficients k = jacobian_coefficients(norm_squared(v));
  const Matrix3 h = hat(v);
  return Matrix3::identity() - k.a * h + k.b * (h * h);
}
/// J_l: d Exp(v) Exp(v)⁻¹ = (J_l(v) dv)^. J_l(v) = J_r(−v) = J_r(v)ᵀ.
inline Matrix3 left_jacobian(const Vector3& v) noexcept { return right_jacobian(-v); }

/// |v| < 2π. `k`: the coefficients at |v|².
inline Matrix3 right_jacobian_inverse(const Vector3& v, const InverseJacobianCoefficients& k) noexcept {
  // v^² = v vᵀ − |v|² I
  Matrix3 out = k.c * outer(v, v);
  const double diagonal = 1.0 - k.c * norm_squared(v);
  for (int i = 0; i < 3; ++i) out(i, i) += diagonal;
  return out + 0.5 * hat(v);
}
inline Matrix3 right_jacobian_inverse(const Vector3& v) noexcept {
  return right_jacobian_inverse(v, inverse_jacobian_coefficients(norm_squared(v)));
}
/// |v| < 2π
inline Matrix3 left_jacobian_inverse(const Vector3& v) noexcept { return right_jacobian_inverse(-v); }

/// ζ = Log(aᵀb) and its derivatives in the body tangents of a and of b.
struct RelativeRotation {
  Vector3 value;
  Matrix3 by_a, by_b;
  InverseJacobianCoefficients coefficients;  ///< of J_r⁻¹(ζ)
};
/// ∂ζ/∂b = J_r⁻¹(ζ); ∂ζ/∂a = −J_l⁻¹(ζ), because a Exp(δ) turns aᵀb into Exp(−δ) aᵀb.
inline RelativeRotation relative_rotation(const Vector3& zeta) noexcept {
  RelativeRotation out;
  out.value = zeta;
  out.coefficients = inverse_jacobian_coefficients(norm_squared(zeta));
  out.by_b = right_jacobian_inverse(zeta, out.coefficients);
  out.by_a = -out.by_b.transpose();
  return out;
}
inline RelativeRotation relative_rotation(const Rotation& a, const Rotation& b) noexcept {
  return relative_rotation(log(a.inverse() * b));
}

namespace detail {

/// The matrix K with ηᵀKδ = m·(DJ_r⁻¹(ζ)[η] δ), the derivative of J_r⁻¹ at ζ along η. With
/// J_r⁻¹(ζ)δ = δ + ½ ζ×δ + c ζ×(ζ×δ) and dc along η being (c'/θ)(ζ·η),
///   ηᵀKδ = ½ m·(η×δ) + (c'/θ)(ζ·η) m·(ζ×(ζ×δ)) + c m·(η×(ζ×δ) + ζ×(η×δ)),
/// and with a×(b×c) = b(a·c) − c(a·b) in the last two terms.
inline Matrix3 inverse_jacobian_gradient(const Vector3& zeta, const InverseJacobianCoefficients& k,
                                         const Vector3& m) noexcept {
  const Vector3 doubly_crossed = cross(zeta, cross(zeta, m));
  return -0.5 * hat(m) + k.c_rate * outer(zeta, doubly_crossed) +
         k.c * (dot(m, zeta) * Matrix3::identity() + outer(m, zeta) - 2.0 * outer(zeta, m));
}

}  // namespace detail

/// Hessian of m·ζ at 0 over (δa, δb), with ζ(δa, δb) = Log(Exp(−δa) Exp(ζ) Exp(δb)): rows and columns 0–2 belong to
/// a, 3–5 to b.
///
/// Along Exp(ζ)Exp(τδ), dζ/dτ = J_r⁻¹(ζ)δ, hence d²ζ/dτ² = DJ_r⁻¹(ζ)[J_r⁻¹(ζ)δ] δ. Along Exp(−τδ)Exp(ζ),
/// dζ/dτ = −J_l⁻¹(ζ)δ, hence d²ζ/dτ² = DJ_l⁻¹(ζ)[J_l⁻¹(ζ)δ] δ, where DJ_l⁻¹ is DJ_r⁻¹ with the other sign of its
/// term ½ η×δ. A quadratic form leaves the symmetric part of both. The derivative of J_r⁻¹(ζ)δb along δa is the mixed
/// one, DJ_r⁻¹(ζ)[−J_l⁻¹(ζ)δa] δb.
inline Matrix<6, 6> relative_rotation_curvature(const RelativeRotation& zeta, const Vector3& m) noexcept {
  const Matrix3& right = zeta.by_b;
  const Matrix3 gradient = detail::inverse_jacobian_gradient(zeta.value, zeta.coefficients, m);
  const Matrix3 ab = -(right * gradient);
  Matrix<6, 6> out;
  out.set_block(0, 0, symmetric_part(right * (gradient + hat(m))));
  out.set_block(0, 3, ab);
  out.set_block(3, 0, ab.transpose());
  out.set_block(3, 3, symmetric_part(right.transpose() * gradient));
  return out;
}

/// For the chart q = base·Exp(x) of R³: derivative at x of the body tangent δ, Exp(δ) = q(x)⁻¹ q(x + h).
inline Matrix3 exp_chart(const Vector3& x) noexcept { return right_jacobian(x); }

/// Σ_a g_a ∂²δ_a/∂h² there, at h = 0.
///
/// Along x + τh, dδ/dτ = J_r⁻¹(δ) η with η = J_r(x + τh)h, hence at δ = 0
///   d²δ/dτ² = DJ_r⁻¹(0)[η] η + dη/dτ = ½ η×η + DJ_r(x)[h] h = DJ_r(x)[h] h.
/// With J_r(x)h = h − a x×h + b x×(x×h) and h×h = 0,
///   g·DJ_r(x)[h]h = −(a'/θ)(x·h) g·(x×h) + (b'/θ)(x·h) g·(x×(x×h)) + b [(g·x)|h|² − (g·h)(x·h)].
inline Matrix3 exp_chart_curvature(const Vector3& x, const Vector3& g) noexcept {
  const JacobianCoefficients k = jacobian_coefficients(norm_squared(x));
  const Vector3 crossed = cross(x, g);
  const Vector3 with_x = k.a_rate * crossed + k.b_rate * cross(x, crossed) - k.b * g;
  return symmetric_part(outer(x, with_x)) + k.b * dot(g, x) * Matrix3::identity();
}

}  // namespace bowstring::lie
