#include <doctest/doctest.h>

#include <cmath>

#include "tests/geometry/built_geometry.hpp"

namespace {

using namespace bowstring::testing;
using doctest::Approx;

const double pi = std::acos(-1.0);
const char* const iliac = "chord = \"150 mm\"\namplitude = \"25 mm\"\nperiods = 1\n";

/// Arc length of y = 25 sin(2πx/150) from 0 to x by the trapezoidal rule with fine steps and its end
/// correction.
double arc_length(double x) {
  const int steps = 40000;
  const double k = 2.0 * pi / 150.0;
  const auto slope = [&](double at) { return 25.0 * k * std::cos(k * at); };
  const auto speed = [&](double at) { return std::hypot(1.0, slope(at)); };
  const auto speed_slope = [&](double at) { return -slope(at) * 25.0 * k * k * std::sin(k * at) / speed(at); };
  const double h = x / steps;
  double sum = 0.5 * (speed(0.0) + speed(x));
  for (int i = 1; i < steps; ++i) sum += speed(h * i);
  return h * sum - h * h / 12.0 * (speed_slope(x) - speed_slope(0.0));
}

TEST_CASE("uniform in x: the nodes of the preprint's planar case") {
  for (const int dimension : {2, 3}) {
    const BuiltGeometry curve =
        built("sinusoid", std::string(iliac) + "nodes = 80\nsampling = \"uniform-x\"", dimension);
    REQUIRE(curve.nodes() == 80);
    for (int i = 0; i < 80; ++i) {
      CHECK(curve.at(i, 0) == Approx(150.0 * i / 79.0).epsilon(1e-15));
      CHECK(std::abs(curve.at(i, 1) - 25.0 * std::sin(2.0 * pi * i / 79.0)) < 1e-13);
      if (dimension == 3) CHECK(curve.at(i, 2) == 0.0);
    }
    CHECK(unevenness(curve) > 0.1);
  }
}

TEST_CASE("uniform in arc length is the default, exact to rounding") {
  const BuiltGeometry curve = built("sinusoid", std::string(iliac) + "nodes = 41", 2);
  const double total = arc_length(150.0);
  CHECK(total == Approx(185.1).epsilon(3e-4));
  for (int i = 0; i < curve.nodes(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(arc_length(curve.at(i, 0)) - total * i / 40.0) < 1e-10);
    CHECK(std::abs(curve.at(i, 1) - 25.0 * std::sin(2.0 * pi * curve.at(i, 0) / 150.0)) < 1e-13);
  }
  CHECK(curve.at(40, 0) == 150.0);
}

TEST_CASE("its length is 185.1 mm") {
  const BuiltGeometry curve = built("sinusoid", std::string(iliac) + "nodes = 4001", 2);
  CHECK(std::abs(curve.length() - 185.1) < 0.05);
  CHECK(curve.length() == Approx(arc_length(150.0)).epsilon(1e-6));
  CHECK(unevenness(curve) < 1e-5);
}

TEST_CASE("end tangents are the curve's own") {
  const BuiltGeometry curve =
      built("sinusoid", "chord = 150\namplitude = -25\nperiods = 1.3\nnodes = 2001\nrotation = [0.4]", 2);
  CHECK(tangent_error(curve) < 1e-7);
  CHECK(std::hypot(curve.curve.last_tangent[0], curve.curve.last_tangent[1]) == Approx(1.0).epsilon(1e-15));
}

}  // namespace
