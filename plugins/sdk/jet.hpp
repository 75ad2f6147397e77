#pragma once

#include <cmath>

#include "core/interfaces/place.hpp"

namespace bowstring {

/// A number with its first and second derivatives with respect to N variables: forward differentiation of second
/// order. Every operation is the chain rule
///   ∇f(a) = f' ∇a,   ∇²f(a) = f' ∇²a + f'' ∇a ∇aᵀ,
/// and its form for two arguments (Griewank and Walther, Evaluating Derivatives, ch. 3 and 13). Made for the few
/// numbers that a law reads; no allocation.
///
///   Jet<2> x = Jet<2>::variable(3.0, 0), y = Jet<2>::variable(4.0, 1);
///   Jet<2> r = sqrt(x * x + y * y);   // r.value = 5, r.gradient = (0.6, 0.8), r.hessian packed as (0,0), (1,0), (1,1)
///
/// Where a function has no derivative (sqrt and hypot at zero, log at zero) the derivatives are not finite.
template <int N>
struct Jet {
  static constexpr int variables = N;
  static constexpr int pairs = packed_size(N);

  double value = 0.0;
  double gradient[N] = {};
  double hessian[pairs] = {};  ///< packed lower triangle, `packed_index`

  constexpr Jet() = default;
  constexpr Jet(double constant) : value(constant) {}

  static constexpr Jet variable(double value, int index) {
    Jet jet(value);
    jet.gradient[index] = 1.0;
    return jet;
  }

  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend Jet operator+(const Jet& a) { return a; }
  friend Jet operator-(const Jet& a) { return compose(a, -a.value, -1.0, 0.0); }

  friend Jet operator+(const Jet& a, const Jet& b) { return sum(a, b, 1.0); }
  friend Jet operator-(const Jet& a, const Jet& b) { return sum(a, b, -1.0); }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return compose(a, b, {a.value * b.value, b.value, a.value, 0.0, 1.0, 0.0});
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double inverse = 1.0 / b.value;
    const double ratio = a.value * inverse;
    return compose(a, b, {ratio, inverse, -ratio * inverse, 0.0, -inverse * inverse, 2.0 * ratio * inverse * inverse});
  }

  friend Jet operator+(const Jet& a, double b) { return shifted(a, b); }
  friend Jet operator+(double a, const Jet& b) { return shifted(b, a); }
  friend Jet operator-(const Jet& a, double b) { return shifted(a, -b); }
  friend Jet operator-(double a, const Jet& b) { return compose(b, a - b.value, -1.0, 0.0); }
  friend Jet operator*(const Jet& a, double b) { return compose(a, a.value * b, b, 0.0); }
  friend Jet operator*(double a, const Jet& b) { return compose(b, a * b.value, a, 0.0); }
  friend Jet operator/(const Jet& a, double b) { return compose(a, a.value / b, 1.0 / b, 0.0); }
  friend Jet operator/(double a, const Jet& b) {
    const double inverse = 1.0 / b.value;
    return compose(b, a * inverse, -a * inverse * inverse, 2.0 * a * inverse * inverse * inverse);
  }

  friend bool operator==(const Jet& a, const Jet& b) { return a.value == b.value; }
  friend bool operator!=(const Jet& a, const Jet& b) { return a.value != b.value; }
  friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
  friend bool operator<=(const Jet& a, const Jet& b) { return a.value <= b.value; }
  friend bool operator>=(const Jet& a, const Jet& b) { return a.value >= b.value; }

  friend Jet sqrt(const Jet& a) {
    const double root = std::sqrt(a.value);
    return compose(a, root, 0.5 / root, -0.25 / (root * a.value));
  }
  friend Jet exp(const Jet& a) {
    const double e = std::exp(a.value);
    return compose(a, e, e, e);
  }
  friend Jet expm1(const Jet& a) {
    const double e = std::exp(a.value);
    return compose(a, std::expm1(a.value), e, e);
  }
  friend Jet log(const Jet& a) {
    const double inverse = 1.0 / a.value;
    return compose(a, std::log(a.value), inverse, -inverse * inverse);
  }
  friend Jet log1p(const Jet& a) {
    const double inverse = 1.0 / (1.0 + a.value);
    return compose(a, std::log1p(a.value), inverse, -inverse * inverse);
  }
  friend Jet sin(const Jet& a) {
    const double s = std::sin(a.value);
    return compose(a, s, std::cos(a.value), -s);
  }
  friend Jet cos(const Jet& a) {
    const double c = std::cos(a.value);
    return compose(a, c, -std::sin(a.value), -c);
  }
  friend Jet tan(const Jet& a) {
    const double t = std::tan(a.value);
    const double slope = 1.0 + t * t;
    return compose(a, t, slope, 2.0 * t * slope);
  }
  friend Jet asin(const Jet& a) {
    const double slope = 1.0 / std::sqrt((1.0 - a.value) * (1.0 + a.value));
    return compose(a, std::asin(a.value), slope, a.value * slope * slope * slope);
  }
  friend Jet acos(const Jet& a) {
    const double slope = -1.0 / std::sqrt((1.0 - a.value) * (1.0 + a.value));
    return compose(a, std::acos(a.value), slope, a.value * slope * slope * slope);
  }
  friend Jet atan(const Jet& a) {
    const double slope = 1.0 / (1.0 + a.value * a.value);
    return compose(a, std::atan(a.value), slope, -2.0 * a.value * slope * slope);
  }
  friend Jet sinh(const Jet& a) {
    const double s = std::sinh(a.value);
    return compose(a, s, std::cosh(a.value), s);
  }
  friend Jet cosh(const Jet& a) {
    const double c = std::cosh(a.value);
    return compose(a, c, std::sinh(a.value), c);
  }
  friend Jet tanh(const Jet& a) {
    const double t = std::tanh(a.value);
    const double slope = 1.0 - t * t;
    return compose(a, t, slope, -2.0 * t * slope);
  }
  /// |a|, with the derivative of the side that the sign of a zero names.
  friend Jet abs(const Jet& a) { return std::signbit(a.value) ? -a : a; }
  friend Jet fabs(const Jet& a) { return abs(a); }
  friend Jet min(const Jet& a, const Jet& b) { return b.value < a.value ? b : a; }
  friend Jet max(const Jet& a, const Jet& b) { return a.value < b.value ? b : a; }

  friend Jet pow(const Jet& a, double exponent) {
    // A factor of zero wins over the infinite power of a zero base: a² and a¹ are smooth there.
    const double first = exponent;
    const double second = exponent * (exponent - 1.0);
    return compose(a, std::pow(a.value, exponent), first == 0.0 ? 0.0 : first * std::pow(a.value, exponent - 1.0),
                   second == 0.0 ? 0.0 : second * std::pow(a.value, exponent - 2.0));
  }
  friend Jet pow(double base, const Jet& b) {
    const double power = std::pow(base, b.value);
    const double rate = std::log(base);
    return compose(b, power, power * rate, power * rate * rate);
  }
  /// For a base above zero.
  friend Jet pow(const Jet& a, const Jet& b) {
    const double power = std::pow(a.value, b.value);
    const double rate = std::log(a.value);
    const double ratio = b.value / a.value;
    return compose(a, b,
                   {power, power * ratio, power * rate, power * ratio * (b.value - 1.0) / a.value,
                    power * (1.0 / a.value + ratio * rate), power * rate * rate});
  }
  friend Jet hypot(const Jet& a, const Jet& b) {
    const double r = std::hypot(a.value, b.value);
    const double x = a.value / r;
    const double y = b.value / r;
    return compose(a, b, {r, x, y, y * y / r, -x * y / r, x * x / r});
  }
  friend Jet atan2(const Jet& b, const Jet& a) {
    const double r = std::hypot(a.value, b.value);
    const double x = a.value / r;
    const double y = b.value / r;
    const double square = r * r;
    return compose(b, a,
                   {std::atan2(b.value, a.value), x / r, -y / r, -2.0 * x * y / square, (y * y - x * x) / square,
                    2.0 * x * y / square});
  }

 private:
  /// Value and derivatives of a function of two numbers.
  struct Partials {
    double f, f_a, f_b, f_aa, f_ab, f_bb;
  };

  static Jet shifted(Jet a, double b) {
    a.value += b;
    return a;
  }

  static Jet sum(const Jet& a, const Jet& b, double sign) {
    Jet out(a.value + sign * b.value);
    for (int i = 0; i < N; ++i) out.gradient[i] = a.gradient[i] + sign * b.gradient[i];
    for (int k = 0; k < pairs; ++k) out.hessian[k] = a.hessian[k] + sign * b.hessian[k];
    return out;
  }

  static Jet compose(const Jet& a, double f, double slope, double second) {
    Jet out(f);
    for (int i = 0; i < N; ++i) {
      out.gradient[i] = slope * a.gradient[i];
      for (int j = 0; j <= i; ++j) {
        const int k = packed_index(i, j);
        out.hessian[k] = slope * a.hessian[k] + second * a.gradient[i] * a.gradient[j];
      }
    }
    return out;
  }

  static Jet compose(const Jet& a, const Jet& b, const Partials& p) {
    Jet out(p.f);
    for (int i = 0; i < N; ++i) {
      out.gradient[i] = p.f_a * a.gradient[i] + p.f_b * b.gradient[i];
      for (int j = 0; j <= i; ++j) {
        const int k = packed_index(i, j);
        out.hessian[k] = p.f_a * a.hessian[k] + p.f_b * b.hessian[k] + p.f_aa * a.gradient[i] * a.gradient[j] +
                         p.f_ab * (a.gradient[i] * b.gradient[j] + b.gradient[i] * a.gradient[j]) +
                         p.f_bb * b.gradient[i] * b.gradient[j];
      }
    }
    return out;
  }
};

}  // namespace bowstring
