#include "core/curve/arc_length.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using bowstring::ArcLength;
using doctest::Approx;

TEST_CASE("arc length of a polyline in the plane and in space") {
  CHECK(bowstring::polyline_arc({0, 0, 3, 4, 3, 5}, 2) == std::vector<double>{0.0, 5.0, 6.0});
  CHECK(bowstring::polyline_arc({1, 1, 1, 3, 4, 7}, 3) == std::vector<double>{0.0, 7.0});
}

TEST_CASE("even stations include both ends exactly") {
  const std::vector<double> station = bowstring::even_stations(0.7, 8);
  REQUIRE(station.size() == 8);
  CHECK(station.front() == 0.0);
  CHECK(station[3] == Approx(0.3).epsilon(1e-15));
  CHECK(station.back() == 0.7);
}

TEST_CASE("linear interpolation is constant beyond the ends") {
  const std::vector<double> x{1.0, 2.0, 4.0};
  const std::vector<double> y{10.0, 20.0, 0.0};
  CHECK(bowstring::interpolate_linearly(x, y, 0.0) == 10.0);
  CHECK(bowstring::interpolate_linearly(x, y, 1.25) == 12.5);
  CHECK(bowstring::interpolate_linearly(x, y, 2.0) == 20.0);
  CHECK(bowstring::interpolate_linearly(x, y, 3.0) == 10.0);
  CHECK(bowstring::interpolate_linearly(x, y, 5.0) == 0.0);
}

TEST_CASE("nearest index") {
  const std::vector<double> x{1.0, 2.0, 4.0};
  CHECK(bowstring::nearest_index(x, -1.0) == 0);
  CHECK(bowstring::nearest_index(x, 1.6) == 1);
  CHECK(bowstring::nearest_index(x, 2.9) == 1);
  CHECK(bowstring::nearest_index(x, 3.1) == 2);
  CHECK(bowstring::nearest_index(x, 9.0) == 2);
}

/// Perimeter of an ellipse by the trapezoidal rule, which converges geometrically on a period.
double perimeter(double a, double b) {
  const int steps = 400;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = 4.0 * std::acos(0.0) * i / steps;
    sum += std::hypot(a * std::sin(t), b * std::cos(t));
  }
  return 4.0 * std::acos(0.0) * sum / steps;
}

TEST_CASE("arc length of an ellipse") {
  const double a = 5.0;
  const double b = 1.0;
  const double half_pi = std::acos(0.0);
  const ArcLength arc([&](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); }, {0.0, 4.0 * half_pi});
  const double exact = perimeter(a, b);
  CHECK(exact == Approx(21.010044).epsilon(1e-7));
  CHECK(arc.total() == Approx(exact).epsilon(1e-13));
  CHECK(arc.at(half_pi) == Approx(0.25 * exact).epsilon(1e-13));
  CHECK(arc.at(0.0) == 0.0);
  CHECK(arc.at(4.0 * half_pi) == Approx(exact).epsilon(1e-13));
}

TEST_CASE("the parameter at an arc length is the inverse, to rounding") {
  // Speed 1 + 0.999 cos t nearly stops at t = π: p(t) = t + 0.999 sin t.
  const double end = 4.0 * std::acos(0.0);
  const ArcLength arc([](double t) { return 1.0 + 0.999 * std::cos(t); }, {0.0, end});
  CHECK(arc.total() == Approx(end).epsilon(1e-13));
  for (const double fraction : {1e-9, 0.1, 0.4999, 0.5, 0.7, 1.0 - 1e-9}) {
    const double t = arc.parameter_at(fraction * end);
    CAPTURE(fraction);
    CHECK(std::abs(t + 0.999 * std::sin(t) - fraction * end) < 1e-12);
  }
  CHECK(arc.parameter_at(-1.0) == 0.0);
  CHECK(arc.parameter_at(end + 1.0) == end);
}

TEST_CASE("even parameters divide the curve evenly") {
  const ArcLength arc([](double t) { return 3.0 * t * t + 1.0; }, {0.0, 1.0, 2.0});
  const std::vector<double> t = arc.even_parameters(11);
  REQUIRE(t.size() == 11);
  for (std::size_t i = 0; i < t.size(); ++i) {
    CHECK(std::abs(t[i] * t[i] * t[i] + t[i] - static_cast<double>(i)) < 1e-12);
  }
}

}  // namespace
