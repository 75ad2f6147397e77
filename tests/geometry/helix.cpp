#include <doctest/doctest.h>

#include <cmath>

#include "tests/geometry/built_geometry.hpp"

namespace {

using namespace bowstring::testing;
using doctest::Approx;

const double pi = std::acos(-1.0);

TEST_CASE("a helix winds about +x from (0, radius, 0)") {
  const BuiltGeometry helix = built("helix", "chord = \"150 mm\"\nradius = \"15 mm\"\nturns = 1\nnodes = 61", 3);
  REQUIRE(helix.nodes() == 61);
  for (int i = 0; i < 61; ++i) {
    const double phase = 2.0 * pi * i / 60.0;
    CHECK(helix.at(i, 0) == Approx(2.5 * i).epsilon(1e-15));
    CHECK(std::abs(helix.at(i, 1) - 15.0 * std::cos(phase)) < 1e-13);
    CHECK(std::abs(helix.at(i, 2) - 15.0 * std::sin(phase)) < 1e-13);
  }
  CHECK(unevenness(helix) < 1e-13);
}

TEST_CASE("its length is 177.15 mm and its end tangents are the curve's own") {
  const BuiltGeometry helix = built("helix", "chord = 150\nradius = 15\nturns = 1\nnodes = 4001", 3);
  CHECK(std::abs(helix.length() - 177.15) < 0.01);
  CHECK(helix.length() == Approx(std::hypot(150.0, 30.0 * pi)).epsilon(1e-6));
  CHECK(tangent_error(helix) < 1e-8);
}

TEST_CASE("negative turns wind left, and the whole is placed by its axis") {
  const BuiltGeometry helix =
      built("helix",
            "chord = 20\nradius = 5\nturns = -2.25\nnodes = 401\norigin = [1, 2, 3]\nrotation = [0, 0, \"90 deg\"]", 3);
  CHECK(helix.at(0, 0) == Approx(-4.0).epsilon(1e-14));  // (0, 5, 0) turned to (−5, 0, 0)
  CHECK(helix.at(0, 1) == Approx(2.0).epsilon(1e-14));
  CHECK(helix.at(400, 1) == Approx(22.0).epsilon(1e-14));
  CHECK(helix.at(400, 2) == Approx(-2.0).epsilon(1e-13));
  CHECK(helix.at(1, 2) < 3.0);
  CHECK(tangent_error(helix) < 2e-5);
}

TEST_CASE("a helix needs space") {
  CHECK(build_geometry("helix", "chord = 150\nradius = 15\nnodes = 60", 2).status.text ==
        "a helix in a scene of dimension 2; expected dimension 3; set dimension = 3 in [scene], or use a "
        "planar geometry such as 'sinusoid'");
}

}  // namespace
