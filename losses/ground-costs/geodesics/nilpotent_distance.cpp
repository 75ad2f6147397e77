#include "nilpotent_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/lie/so3.hpp"

namespace bowstring::geodesics {
namespace {

constexpr double pi = 3.14159265358979323846;

/// q as a function of u = t², and its derivatives: Σ_{n≥1} 2/(n²π² − u), the partial fractions of the cotangent. The
/// first pole comes from 1 − u/π² as it is, so that it keeps its relative precision; the second is kept too, and the
/// others are a power series of ratio 1/9 on u ≤ π²: 2(ζ(2k+2) − 1 − 2^{−2k−2})/π^{2k+2}.
struct PoleSum {
  double value, first, second;
};
PoleSum pole_sum(double u, double distance_to_pole) noexcept {
  static constexpr std::array<double, 15> series{
      0.080030374227488904724,   0.00040700993101800994527, 3.5741237699164256839e-6,  3.6065898431388279966e-8,
      3.846877389020976959e-10,  4.2107393537476448577e-12, 4.6694762565038755648e-14, 5.2137659011693576084e-16,
      5.8430132441676543601e-18, 6.5614340694273134315e-20, 7.3764094053333042005e-22, 8.2977542584063250737e-24,
      9.3374110970798545607e-26, 1.050936689219024135e-27,  1.182970241993778956e-29};
  const lie::detail::PolynomialJet rest = lie::detail::polynomial_jet(series, u);
  const double first = 1.0 / (pi * pi * distance_to_pole), second = 1.0 / (4.0 * pi * pi - u);
  return {2.0 * (first + second) + rest.value, 2.0 * (first * first + second * second) + rest.first,
          4.0 * (first * first * first + second * second * second) + rest.second};
}

/// ψ = (bend, 0), lateral ≥ 0 in both components; λ in the same axes.
struct Canonical {
  double forward_squared, bend_squared;
  Vector2 lateral;
};

/// λ = 2π y/√(1 + |y|²): all of the plane for the disc, 1 − |λ|²/4π² = 1/(1 + |y|²) to full precision.
struct Place {
  Vector2 y, dual;
  double u, distance_to_pole;

  explicit Place(const Vector2& at) noexcept : y(at) {
    const double stretch = 1.0 + norm_squared(y);
    distance_to_pole = 1.0 / stretch;
    dual = 2.0 * pi / std::sqrt(stretch) * y;
    u = pi * pi * norm_squared(y) / stretch;
  }
};

/// Value of the dual function less s² + |ψ|², derivative, and the three numbers of the NEGATIVE Hessian.
struct DualFunction {
  double value;
  double bent;  ///< the part of it that is not linear
  Vector2 gradient;
  double h00, h01, h11;
  PoleSum q;

  DualFunction(const Canonical& c, const Place& at) noexcept : q(pole_sum(at.u, at.distance_to_pole)) {
    const Vector2& l = at.dual;
    const double a = c.forward_squared + c.bend_squared, b = c.forward_squared;
    const double form = a * l[0] * l[0] + b * l[1] * l[1];
    bent = 0.25 * q.value * form;
    value = 2.0 * dot(l, c.lateral) - bent;
    const double common = 0.125 * q.first * form;
    gradient = {{2.0 * c.lateral[0] - l[0] * (common + 0.5 * q.value * a),
                 2.0 * c.lateral[1] - l[1] * (common + 0.5 * q.value * b)}};
    const double curved = 0.0625 * q.second * form;
    h00 = common + 0.5 * q.value * a + l[0] * l[0] * (curved + 0.5 * q.first * a);
    h11 = common + 0.5 * q.value * b + l[1] * l[1] * (curved + 0.5 * q.first * b);
    h01 = l[0] * l[1] * (curved + 0.25 * q.first * (a + b));
  }
  /// To the top of the quadratic model, in λ.
  Vector2 newton_step() const noexcept {
    const double determinant = h00 * h11 - h01 * h01;
    return {
        {(h11 * gradient[0] - h01 * gradient[1]) / determinant, (h00 * gradient[1] - h01 * gradient[0]) / determinant}};
  }
};

/// Whether a step that promises `decrement` has done good. What is less than rounding is not judged by values, but by
/// what the next step promises.
bool improves(const DualFunction& from, double decrement, const DualFunction& to, double rounding) noexcept {
  if (decrement > rounding) return to.value >= from.value;
  return 0.5 * dot(to.newton_step(), to.gradient) <= decrement;
}

/// The radius |y| at which the maximum along a direction lies, roughly: exact for small and for large ratios of
/// z·n to s² + (ψ·n)².
double radius_along(double ratio) noexcept {
  const double small = 6.0 / pi * ratio;
  // (1 + (large/…)) with the exponent ¾, by two square roots
  const double bent = std::sqrt(1.0 + 1.6194 * ratio);
  return small / (bent * std::sqrt(bent));
}

Vector2 first_guess(const Canonical& c) noexcept {
  Vector2 direction = c.lateral;
  Vector2 y;
  for (int pass = 0; pass < 2; ++pass) {
    const double length_squared = norm_squared(direction);
    const double form = c.forward_squared + c.bend_squared * direction[0] * direction[0] / length_squared;
    const double along = dot(direction, c.lateral) / std::sqrt(length_squared);
    y = radius_along(along / form) / std::sqrt(length_squared) * direction;
    if (pass == 1 || c.bend_squared == 0.0) break;
    const Place at(y);
    const double pole = 1.0 / (pi * pi * at.distance_to_pole);
    const double q = 2.0 * pole + 0.13, q_first = 2.0 * pole * pole;
    const double quadratic = form * 4.0 * at.u;
    const double common = 0.0625 * q_first * quadratic + 0.25 * q * c.forward_squared;
    direction = {{c.lateral[0] / (common + 0.25 * q * c.bend_squared), c.lateral[1] / common}};
  }
  return y;
}

/// Near (0, 2π), where λ* tends to as s → 0 for all πz₁² < z₂|ψ|²: with t = π − τ and λ = 2t(sin ζ, cos ζ) the leading
/// terms of stationarity are ζ(z₂ + |ψ|²/2τ) = z₁ and 4z₂τ² = π(s² + |ψ|²ζ²), which leave
///   1 = A/τ² + B/(τ + k)²,   A = πs²/4z₂,   B = π|ψ|²z₁²/4z₂³,   k = |ψ|²/2z₂.
/// The right side falls and is convex, so that Newton's method goes up to the root from where it is above 1.
bool guess_near_pole(const Canonical& c, Vector2& y) noexcept {
  const double z0 = c.lateral[0], z1 = c.lateral[1];
  if (!(z1 > 0.0)) return false;
  const double per_lateral = 0.25 * pi / z1, slope = z0 / z1;
  const double a = per_lateral * c.forward_squared, b = per_lateral * c.bend_squared * slope * slope;
  const double k = 0.5 * c.bend_squared / z1;
  double tau = std::max(std::sqrt(a), std::sqrt(b) - k);
  constexpr double farthest = 0.5;
  for (int pass = 0; pass < 20 && tau < farthest; ++pass) {
    const double inner = 1.0 / tau, outer = 1.0 / (tau + k);
    const double from_inner = a * inner * inner, from_outer = b * outer * outer;
    const double excess = from_inner + from_outer - 1.0;
    if (!(excess > 0.02)) break;
    tau += 0.5 * excess / (from_inner * inner + from_outer * outer);
  }
  const double zeta = slope * tau / (tau + k);
  if (!(tau < farthest) || !(zeta < 1.0)) return false;
  const double radius = (pi - tau) / std::sqrt(tau * (2.0 * pi - tau));
  y = {{radius * zeta, radius}};
  return true;
}

/// The argument in (low, high) with the largest value of a function that rises and then falls, by golden sections.
template <class Function>
double highest(double low, double high, const Function& value_at) {
  constexpr double golden = 0.61803398874989484820;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double of_left = value_at(left), of_right = value_at(right);
  for (int pass = 0; pass < 45; ++pass) {
    if (of_left < of_right) {
      low = left, left = right, of_left = of_right;
      right = low + golden * (high - low), of_right = value_at(right);
    } else {
      high = right, right = left, of_right = of_left;
      left = high - golden * (high - low), of_left = value_at(left);
    }
  }
  return 0.5 * (low + high);
}

/// The maximum by nested search in 2π − λ₂ and λ₁, where a narrow ridge that bends leads Newton's method along it in
/// small steps: s nearly 0 and πz₁² a little above z₂|ψ|².
Vector2 nested_search(const Canonical& c) {
  const auto place = [](double log_gap, double share) -> Vector2 {
    const double gap = std::exp(log_gap), square = gap * (4.0 * pi - gap);  // 2π − λ₂, 4π² − λ₂²
    const double scale = 1.0 / std::sqrt(square * (1.0 - share * share));
    return {{scale * share * std::sqrt(square), scale * (2.0 * pi - gap)}};
  };
  const auto best_share = [&](double log_gap) {
    return highest(0.0, 1.0, [&](double share) { return DualFunction(c, Place(place(log_gap, share))).value; });
  };
  const double log_gap = highest(std::log(1e-20), std::log(2.0 * pi),
                                 [&](double at) { return DualFunction(c, Place(place(at, best_share(at)))).value; });
  return place(log_gap, best_share(log_gap));
}

}  // namespace

NilpotentSolution nilpotent_distance(const NilpotentOffset& offset, double enough) noexcept {
  NilpotentSolution out;
  const double bend_squared = norm_squared(offset.bend), horizontal = offset.forward * offset.forward + bend_squared;
  const double lateral = norm(offset.lateral);
  out.squared = horizontal;
  out.by_forward = 2.0 * offset.forward;
  out.by_bend = 2.0 * offset.bend;
  if (lateral == 0.0 || horizontal > enough) return out;

  // Axes: ψ first, or z second where ψ has no direction.
  const double bend = std::sqrt(bend_squared);
  const Vector2 axis = bend > 1e-150 ? offset.bend / bend : Vector2{{offset.lateral[1], -offset.lateral[0]}} / lateral;
  const double z0 = dot(axis, offset.lateral), z1 = cross(axis, offset.lateral);
  // A forward part that is smaller than rounding can show lifts λ* off the pole.
  const double least = 1e-20 * std::sqrt(lateral);
  const double forward = std::copysign(std::max(std::fabs(offset.forward), least), offset.forward);
  const Canonical canonical{forward * forward, bend_squared, {{std::fabs(z0), std::fabs(z1)}}};

  Place at(first_guess(canonical));
  DualFunction dual(canonical, at);
  if (Vector2 near_pole; guess_near_pole(canonical, near_pole)) {
    const Place other(near_pole);
    const DualFunction there(canonical, other);
    if (there.value > dual.value) at = other, dual = there;
  }
  const double rounding = 2e-15 * (horizontal + 4.0 * pi * lateral);
  constexpr int most_iterations = 60, patience = 15;
  for (; out.iterations < most_iterations; ++out.iterations) {
    if (out.iterations == patience) {
      const Place searched(nested_search(canonical));
      const DualFunction there(canonical, searched);
      if (there.value > dual.value) at = searched, dual = there;
    }
    if (horizontal + dual.value > enough) {
      out.squared = horizontal + dual.value;
      return out;
    }
    const Vector2 newton = dual.newton_step();
    const double decrement = 0.5 * dot(newton, dual.gradient);
    const Vector2 in_plane = (newton + dot(at.y, newton) * at.y) / (2.0 * pi * std::sqrt(at.distance_to_pole));
    const bool last = decrement <= 1e-9 * dual.bent;
    double share = 1.0;
    Place next(at.y + in_plane);
    DualFunction there(canonical, next);
    while (!improves(dual, decrement, there, rounding) && share > 1e-10) {
      share *= 0.5;
      next = Place(at.y + share * in_plane);
      there = DualFunction(canonical, next);
    }
    at = next;
    dual = there;
    if (last) break;
  }
  out.squared = horizontal + dual.value;
  const double sign0 = std::copysign(1.0, z0), sign1 = std::copysign(1.0, z1);
  const double l0 = sign0 * at.dual[0], l1 = sign1 * at.dual[1];
  out.dual = {{l0 * axis[0] - l1 * axis[1], l0 * axis[1] + l1 * axis[0]}};
  out.distance_to_pole = at.distance_to_pole;
  out.by_forward = 2.0 * forward * (1.0 - dual.q.value * at.u);
  const Vector2 along = bend * axis;
  out.by_bend = 2.0 * along - 0.5 * dual.q.value * bend * l0 * out.dual;
  return out;
}

}  // namespace bowstring::geodesics
