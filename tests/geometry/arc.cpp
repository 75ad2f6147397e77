#include <doctest/doctest.h>

#include <cmath>

#include "tests/geometry/built_geometry.hpp"

namespace {

using namespace bowstring::testing;
using doctest::Approx;

const double pi = std::acos(-1.0);

TEST_CASE("an arc leaves the origin along +x and bends toward +y about (0, radius)") {
  for (const int dimension : {2, 3}) {
    const BuiltGeometry arc = built("arc", "radius = 40\nangle = \"135 deg\"\nnodes = 31", dimension);
    REQUIRE(arc.nodes() == 31);
    for (int i = 0; i < arc.nodes(); ++i) {
      CHECK(std::hypot(arc.at(i, 0), arc.at(i, 1) - 40.0) == Approx(40.0).epsilon(1e-14));
      if (dimension == 3) CHECK(arc.at(i, 2) == 0.0);
    }
    CHECK(arc.at(0, 0) == 0.0);
    CHECK(arc.at(0, 1) == 0.0);
    CHECK(arc.at(1, 1) > 0.0);
    CHECK(arc.length() == Approx(30.0 * 80.0 * std::sin(135.0 / 360.0 * pi / 30.0)).epsilon(1e-14));
    CHECK(unevenness(arc) < 1e-13);
    CHECK(arc.curve.first_tangent[0] == 1.0);
    CHECK(arc.curve.last_tangent[0] == Approx(-std::sqrt(0.5)).epsilon(1e-15));
    CHECK(arc.curve.last_tangent[1] == Approx(std::sqrt(0.5)).epsilon(1e-15));
    CHECK(tangent_error(arc) < 1e-3);
  }
}

TEST_CASE("a negative angle bends toward -y") {
  const BuiltGeometry up = built("arc", "radius = 40\nangle = 1.0\nnodes = 9", 2);
  const BuiltGeometry down = built("arc", "radius = 40\nangle = -1.0\nnodes = 9", 2);
  for (int i = 0; i < 9; ++i) {
    CHECK(down.at(i, 0) == up.at(i, 0));
    CHECK(down.at(i, 1) == -up.at(i, 1));
  }
  CHECK(down.curve.last_tangent[1] == -up.curve.last_tangent[1]);
}

TEST_CASE("an arc that is very flat keeps its height") {
  const BuiltGeometry arc = built("arc", "radius = 1e9\nangle = 1e-8\nnodes = 3", 2);
  CHECK(arc.at(2, 0) == Approx(10.0).epsilon(1e-14));
  CHECK(arc.at(2, 1) == Approx(5e-8).epsilon(1e-12));
}

TEST_CASE("an arc without angle is refused") {
  CHECK(build_geometry("arc", "radius = 40\nangle = 0\nnodes = 9", 2).status.text ==
        "geometry 'arc': 'angle' is 0; expected an angle other than 0; give one, or use geometry 'line'");
}

}  // namespace
