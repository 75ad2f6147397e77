#include "plugins/sdk/jet.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

namespace bowstring {

namespace {

using J1 = Jet<1>;
using J2 = Jet<2>;

/// Central differences of order 4 of a function of N numbers, against the jet's derivatives.
template <int N, class Function>
void check_derivatives(const Function& f, const double (&x)[N], double tolerance = 1e-7) {
  Jet<N> variables[N];
  for (int i = 0; i < N; ++i) variables[i] = Jet<N>::variable(x[i], i);
  const Jet<N> jet = f(variables);

  const auto value = [&](int i, double a, int j, double b) {
    double moved[N];
    for (int k = 0; k < N; ++k) moved[k] = x[k];
    moved[i] += a;
    moved[j] += b;
    return f(moved);
  };
  const double h = 1e-3;
  const double weight[] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
  const double node[] = {-2.0 * h, -h, h, 2.0 * h};
  double norm = 0.0;
  CHECK(jet.value == doctest::Approx(value(0, 0.0, 0, 0.0)).epsilon(1e-14));
  for (int i = 0; i < N; ++i) {
    double slope = 0.0;
    for (int a = 0; a < 4; ++a) slope += weight[a] / h * value(i, node[a], i, 0.0);
    CHECK(std::fabs(jet.gradient[i] - slope) <= tolerance * (1.0 + std::fabs(slope)));
    norm += std::fabs(slope);
    for (int j = 0; j <= i; ++j) {
      double second = 0.0;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) second += weight[a] * weight[b] / (h * h) * value(i, node[a], j, node[b]);
      }
      CHECK(std::fabs(jet.hessian[packed_index(i, j)] - second) <= 100.0 * tolerance * (1.0 + std::fabs(second)));
      norm += std::fabs(second);
    }
  }
  REQUIRE(norm > 1e-3);
}

template <class Function>
void check_at(const Function& f, double x) {
  const double point[1] = {x};
  check_derivatives<1>([&](const auto* v) { return f(v[0]); }, point);
}

/// Value, first and second derivative as they are known.
void check_known(const J1& jet, double value, double slope, double second) {
  CHECK(jet.value == doctest::Approx(value).epsilon(1e-14));
  CHECK(jet.gradient[0] == doctest::Approx(slope).epsilon(1e-14));
  CHECK(jet.hessian[0] == doctest::Approx(second).epsilon(1e-13));
}

}  // namespace

TEST_CASE("known derivatives") {
  const J1 x = J1::variable(0.5, 0);
  check_known(x * x * x, 0.125, 0.75, 3.0);
  check_known(1.0 / x, 2.0, -4.0, 16.0);
  check_known(2.0 - x, 1.5, -1.0, 0.0);
  check_known(x / 4.0 + 1.0, 1.125, 0.25, 0.0);
  check_known(sqrt(x), std::sqrt(0.5), std::sqrt(0.5), -std::sqrt(0.5));
  check_known(exp(2.0 * x), std::exp(1.0), 2.0 * std::exp(1.0), 4.0 * std::exp(1.0));
  check_known(log(x), -std::log(2.0), 2.0, -4.0);
  check_known(sin(x), std::sin(0.5), std::cos(0.5), -std::sin(0.5));
  check_known(cos(x), std::cos(0.5), -std::sin(0.5), -std::cos(0.5));
  check_known(atan(x), std::atan(0.5), 0.8, -0.64);
  check_known(pow(x, 3.0), 0.125, 0.75, 3.0);
}

TEST_CASE("a product rule that is easy to get wrong: the mixed derivative") {
  const J2 x = J2::variable(3.0, 0), y = J2::variable(4.0, 1);
  const J2 r = sqrt(x * x + y * y);
  CHECK(r.value == 5.0);
  CHECK(r.gradient[0] == doctest::Approx(0.6));
  CHECK(r.gradient[1] == doctest::Approx(0.8));
  CHECK(r.hessian[packed_index(0, 0)] == doctest::Approx(16.0 / 125.0));
  CHECK(r.hessian[packed_index(1, 0)] == doctest::Approx(-12.0 / 125.0));
  CHECK(r.hessian[packed_index(1, 1)] == doctest::Approx(9.0 / 125.0));
  const J2 h = hypot(x, y);
  for (int k = 0; k < 3; ++k) CHECK(h.hessian[k] == doctest::Approx(r.hessian[k]));
}

TEST_CASE("functions of one number against differences") {
  using std::abs, std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::expm1, std::log, std::log1p,
      std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
  for (const double x : {0.1, 0.37, 0.8}) {
    check_at([](const auto& v) { return sqrt(v); }, x);
    check_at([](const auto& v) { return exp(v) + v; }, x);
    check_at([](const auto& v) { return expm1(v); }, x);
    check_at([](const auto& v) { return log(v); }, x);
    check_at([](const auto& v) { return log1p(v); }, x);
    check_at([](const auto& v) { return sin(v); }, x);
    check_at([](const auto& v) { return cos(v); }, x);
    check_at([](const auto& v) { return tan(v); }, x);
    check_at([](const auto& v) { return asin(v); }, x);
    check_at([](const auto& v) { return acos(v); }, x);
    check_at([](const auto& v) { return atan(v); }, x);
    check_at([](const auto& v) { return sinh(v); }, x);
    check_at([](const auto& v) { return cosh(v); }, x);
    check_at([](const auto& v) { return tanh(v); }, x);
    check_at([](const auto& v) { return abs(-v) * v; }, x);
    check_at([](const auto& v) { return pow(v, 2.5); }, x);
    check_at([](const auto& v) { return pow(2.0, v); }, x);
  }
}

TEST_CASE("functions of several numbers against differences") {
  using std::atan2, std::hypot, std::pow;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> between(0.5, 1.5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const double two[2] = {between(random), between(random)};
    check_derivatives<2>([](const auto* v) { return v[0] / v[1] - v[1] * v[0] * v[0]; }, two);
    check_derivatives<2>([](const auto* v) { return hypot(v[0], v[1]); }, two);
    check_derivatives<2>([](const auto* v) { return atan2(v[0], v[1]); }, two);
    check_derivatives<2>([](const auto* v) { return atan2(v[0], -1.0 * v[1]); }, two);
    check_derivatives<2>([](const auto* v) { return pow(v[0], v[1]); }, two);
    const double four[4] = {between(random), between(random), between(random), between(random)};
    check_derivatives<4>(
        [](const auto* v) {
          using std::exp, std::sqrt;
          auto sum = v[0] * v[1];
          sum += sqrt(v[2]) / v[3];
          sum -= exp(v[0] * v[3]);
          sum *= v[1] + 2.0;
          sum /= v[2] + v[0];
          return -sum;
        },
        four);
  }
}

TEST_CASE("powers are smooth at zero where the function is") {
  const J1 x = J1::variable(0.0, 0);
  check_known(pow(x, 2.0), 0.0, 0.0, 2.0);
  check_known(pow(x, 1.0), 0.0, 1.0, 0.0);
  check_known(pow(x, 0.0), 1.0, 0.0, 0.0);
}

TEST_CASE("where there is no derivative the jet says so") {
  const J2 x = J2::variable(0.0, 0), y = J2::variable(0.0, 1);
  CHECK_FALSE(std::isfinite(sqrt(x).gradient[0]));
  CHECK_FALSE(std::isfinite(hypot(x, y).gradient[0]));
}

TEST_CASE("comparisons look at the value") {
  const J1 one = J1::variable(1.0, 0);
  const J1 two(2.0);
  CHECK(one < two);
  CHECK(one <= 1.0);
  CHECK(two > 1.5);
  CHECK(2.0 >= two);
  CHECK(one == 1.0);
  CHECK(one != two);
  CHECK(max(one, two).gradient[0] == 0.0);
  CHECK(min(one, two).gradient[0] == 1.0);
}

}  // namespace bowstring
