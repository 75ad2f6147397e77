#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/lie/so3.hpp"

/// Directions: points of S², carried as a Rotation whose turn about its own first axis is immaterial. Tangent numbers
/// are the components 2 and 3 of a body rotation vector, the retraction is R Exp((0, δ₂, δ₃)).
namespace bowstring::lie {

/// For a unit vector u in the body frame: components 2 and 3 of the shortest rotation vector that carries e₁ to u,
/// (−u₃, u₂) θ/sin θ with θ the angle between them. For u = −e₁ half a turn about axis 3.
inline Vector2 direction_log(const Vector3& u) noexcept {
  const double sine = std::hypot(u[1], u[2]);
  const double angle = std::atan2(sine, u[0]);
  if (sine == 0.0) return {{0.0, angle}};
  return Vector2{{-u[2], u[1]}} * (angle / sine);
}

namespace detail {

/// f(c) = acos(c)/√(1 − c²) = θ/sin θ at c = cos θ, and its first two derivatives in c.
struct TurnFactor {
  double value = 0.0, first = 0.0, second = 0.0;
};

/// 2^{2k} k!²/(2k+1)!, the coefficients of f in y = (1 − c)/2: asin(√y)/√(y(1 − y)) = Σ_k of them y^k.
template <std::size_t n>
constexpr std::array<double, n> turn_factor_series() {
  std::array<double, n> out{};
  double coefficient = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    out[k] = coefficient;
    coefficient *= (2.0 * static_cast<double>(k) + 2.0) / (2.0 * static_cast<double>(k) + 3.0);
  }
  return out;
}

/// At c = u₁ of a unit vector. The closed form follows from (1 − c²)f' = c f − 1, whose right side cancels near c = 1:
/// there the series. f grows without bound toward c = −1, where it is cut off at a sine of 1e-8: large and finite.
inline TurnFactor turn_factor(const Vector3& u) noexcept {
  const double c = u[0];
  if (c > 0.5) {
    constexpr auto series = turn_factor_series<34>();
    const PolynomialJet f = polynomial_jet(series, 0.5 * (1.0 - c));
    return {f.value, -0.5 * f.first, 0.25 * f.second};
  }
  const double sine = std::fmax(std::hypot(u[1], u[2]), 1e-8);
  const double f = std::atan2(sine, c) / sine;
  const double first = (c * f - 1.0) / (sine * sine);
  return {f, first, (f + 3.0 * c * first) / (sine * sine)};
}

/// u = Q e₁, Q = aᵀ b, as a function of (α₂, α₃, β₂, β₃), u = Exp(−(0, α)) Q Exp((0, β)) e₁, with its first and second
/// derivatives at 0: ∂u/∂α_k = −e_k × u and ∂u/∂β_k = Q(e_k × e₁); twice in one argument the symmetrised double
/// product, ∂²u/∂α_k∂α_l = ½(e_k u_l + e_l u_k) − δ_kl u and ∂²u/∂β_k∂β_l = −δ_kl u.
struct TurnedAxis {
  Vector3 u;
  std::array<Vector3, 4> first;
  std::array<std::array<Vector3, 4>, 4> second;
};
inline TurnedAxis turned_axis(const Matrix3& q) noexcept {
  const std::array<Vector3, 2> e{Vector3::unit(1), Vector3::unit(2)};
  TurnedAxis t;
  t.u = q.column(0);
  t.first = {-cross(e[0], t.u), -cross(e[1], t.u), -q.column(2), q.column(1)};
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t l = 0; l < 2; ++l) {
      const Vector3 inward = k == l ? -t.u : Vector3::zero();
      t.second[k][l] = 0.5 * (dot(e[l], t.u) * e[k] + dot(e[k], t.u) * e[l]) + inward;
      t.second[2 + k][2 + l] = inward;
      t.second[k][2 + l] = t.second[2 + l][k] = -cross(e[k], t.first[2 + l]);
    }
  }
  return t;
}

}  // namespace detail

/// ζ = direction_log(aᵀ b e₁), the turn from a's first axis to b's in a's body frame, and its derivatives in the
/// tangent numbers of a and of b.
struct RelativeTurn {
  Vector2 value;
  Matrix2 by_a, by_b;
  Matrix3 between;            ///< aᵀ b
  detail::TurnFactor factor;  ///< of its first column
};
/// ζ = f(u₁)(−u₃, u₂), differentiated as this function of R³ along the derivatives of u, which stay on the sphere.
inline RelativeTurn relative_turn(const Rotation& a, const Rotation& b) noexcept {
  RelativeTurn out;
  out.between = (a.inverse() * b).matrix();
  const detail::TurnedAxis t = detail::turned_axis(out.between);
  const detail::TurnFactor f = out.factor = detail::turn_factor(t.u);
  const auto derivative = [&](const Vector3& du) {
    return f.value * Vector2{{-du[2], du[1]}} + f.first * du[0] * Vector2{{-t.u[2], t.u[1]}};
  };
  out.value = direction_log(t.u);
  for (int k = 0; k < 2; ++k) {
    out.by_a.set_column(k, derivative(t.first[static_cast<std::size_t>(k)]));
    out.by_b.set_column(k, derivative(t.first[static_cast<std::size_t>(k) + 2]));
  }
  return out;
}

/// Hessian at 0 of m·ζ over (α₂, α₃, β₂, β₃).
///
/// With w(u) = m·(−u₃, u₂), linear in u, m·ζ = f(u₁)w(u), and along p and q
///   ∂²(m·ζ) = f'' ∂_p u₁ ∂_q u₁ w(u) + f' (∂_p u₁ w(∂_q u) + ∂_q u₁ w(∂_p u)) + f' ∂²u₁ w(u) + f w(∂²u).
inline Matrix<4, 4> relative_turn_curvature(const RelativeTurn& turn, const Vector2& m) noexcept {
  const detail::TurnedAxis t = detail::turned_axis(turn.between);
  const detail::TurnFactor& f = turn.factor;
  const auto w = [&m](const Vector3& u) { return m[1] * u[1] - m[0] * u[2]; };
  const double w_u = w(t.u);
  double du[4], w_du[4];
  for (std::size_t p = 0; p < 4; ++p) du[p] = t.first[p][0], w_du[p] = w(t.first[p]);
  Matrix<4, 4> out;
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q <= p; ++q) {
      const Vector3& second = t.second[p][q];
      const double entry = (f.second * du[p] * du[q] + f.first * second[0]) * w_u +
                           f.first * (du[p] * w_du[q] + du[q] * w_du[p]) + f.value * w(second);
      out(static_cast<int>(p), static_cast<int>(q)) = out(static_cast<int>(q), static_cast<int>(p)) = entry;
    }
  }
  return out;
}

/// For the chart q = base·Exp((0, x)) of R²: derivative at x of the tangent numbers δ, R Exp((0, δ)) having the first
/// axis of q(x + h). To first order a turn about the first axis does nothing, so these are rows and columns 2 and 3
/// of J_r((0, x)), where x lies in the plane of them: I + b (x xᵀ − |x|² I).
inline Matrix2 direction_chart(const Vector2& x) noexcept {
  const double t = norm_squared(x);
  const double b = jacobian_coefficients(t).b;
  return (1.0 - b * t) * Matrix2::identity() + b * outer(x, x);
}

/// Σ_a g_a ∂²δ_a/∂h² there, at h = 0.
///
/// Let η(τ) be the body rotation vector of Exp((0, x))⁻¹Exp((0, x + τh)). To second order Exp(η)e₁ is
/// e₁ + η×e₁ + ½ η×(η×e₁) and has the components 2 and 3 (η₃ + ½η₁η₂, −η₂ + ½η₁η₃), so that
///   δ = (η₂ − ½η₁η₃, η₃ + ½η₁η₂),  δ'' = (η₂'' − η₁'η₃', η₃'' + η₁'η₂'),
/// with η' = J_r h, whose first component is a (x₃h₂ − x₂h₃), and η'' as in `exp_chart_curvature`.
inline Matrix2 direction_chart_curvature(const Vector2& x, const Vector2& g) noexcept {
  const double a = jacobian_coefficients(norm_squared(x)).a;
  const Matrix3 of_eta = exp_chart_curvature({{0.0, x[0], x[1]}}, {{0.0, g[0], g[1]}});
  const Vector2 twist_rate = a * Vector2{{x[1], -x[0]}};
  const Vector2 by_twist = direction_chart(x) * Vector2{{g[1], -g[0]}};
  return of_eta.block<2, 2>(1, 1) + symmetric_part(outer(twist_rate, by_twist));
}

/// The tangent numbers α = direction_log(e/|e|) of a direction that follows an edge vector e, written in the body
/// frame: ∂α/∂e at e = length·e₁.
inline Matrix<2, 3> edge_direction(double length) noexcept {
  Matrix<2, 3> out;
  out(0, 2) = -1.0 / length;
  out(1, 1) = 1.0 / length;
  return out;
}

/// Σ_a g_a ∂²α_a/∂e² there: ∂²α₂/∂e₁∂e₃ = 1/length², ∂²α₃/∂e₁∂e₂ = −1/length², the rest is 0.
inline Matrix3 edge_direction_curvature(double length, const Vector2& g) noexcept {
  Matrix3 out;
  out(0, 2) = out(2, 0) = g[0] / (length * length);
  out(0, 1) = out(1, 0) = -g[1] / (length * length);
  return out;
}

/// A frame whose first axis is the unit vector t: the least turn from the axes of space, smooth but at t = −e₁, where
/// it is half a turn about axis 3.
inline Rotation frame_from_tangent(const Vector3& t) noexcept {
  if (t[0] >= 0.0) return Rotation{1.0 + t[0], 0.0, -t[2], t[1]}.normalized();
  const double sine = std::hypot(t[1], t[2]);
  if (sine == 0.0) return {0.0, 0.0, 0.0, 1.0};
  // (1 + t₁)/sine without the cancellation near t₁ = −1.
  return Rotation{sine / (1.0 - t[0]), 0.0, -t[2] / sine, t[1] / sine}.normalized();
}

/// Parallel transport: r after the least turn that carries its first axis to the unit vector t. For opposite vectors
/// half a turn about an axis across r's first one, the same for the same input.
inline Rotation transport(const Rotation& r, const Vector3& t) noexcept {
  return (r * frame_from_tangent(r.inverse() * t)).normalized();
}

}  // namespace bowstring::lie
