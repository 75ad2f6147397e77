#include <doctest/doctest.h>

#include <cmath>

#include "tests/geometry/built_geometry.hpp"

namespace {

using bowstring::testing::build_geometry;
using bowstring::testing::built;
using bowstring::testing::BuiltGeometry;

TEST_CASE("a line runs from the origin along +x") {
  for (const int dimension : {2, 3}) {
    const BuiltGeometry line = built("line", "length = \"12 cm\"\nnodes = 7", dimension);
    REQUIRE(line.nodes() == 7);
    for (int i = 0; i < 7; ++i) {
      CHECK(line.at(i, 0) == doctest::Approx(20.0 * i).epsilon(1e-15));
      for (int k = 1; k < dimension; ++k) CHECK(line.at(i, k) == 0.0);
    }
    CHECK(line.curve.first_tangent[0] == 1.0);
    CHECK(line.curve.last_tangent[0] == 1.0);
    CHECK(line.curve.data.empty());
  }
}

TEST_CASE("origin and rotation place a line") {
  const BuiltGeometry plane =
      built("line", "length = 10\nnodes = 3\norigin = [1, \"2 mm\"]\nrotation = [\"30 deg\"]", 2);
  CHECK(plane.at(2, 0) == doctest::Approx(1.0 + 10.0 * std::sqrt(0.75)).epsilon(1e-15));
  CHECK(plane.at(2, 1) == doctest::Approx(7.0).epsilon(1e-15));
  CHECK(plane.curve.last_tangent[1] == doctest::Approx(0.5).epsilon(1e-15));
  const BuiltGeometry space =
      built("line", "length = 10\nnodes = 3\norigin = [1, 2, 3]\nrotation = [0, 0, \"90 deg\"]", 3);
  CHECK(space.at(2, 0) == doctest::Approx(1.0).epsilon(1e-14));
  CHECK(space.at(2, 1) == doctest::Approx(12.0).epsilon(1e-15));
  CHECK(space.at(2, 2) == 3.0);
}

TEST_CASE("what does not fit the scene is named") {
  CHECK(build_geometry("line", "length = 10\nnodes = 3\norigin = [1, 2, 3]", 2).status.text ==
        "'origin' has 3 numbers; expected 2 in a scene of dimension 2; give one coordinate for each axis");
  CHECK(!build_geometry("line", "length = 0\nnodes = 3", 2).status.ok());
  CHECK(!build_geometry("line", "length = 1\nnodes = 2", 2).status.ok());
  CHECK(!build_geometry("line", "length = 1", 2).status.ok());
}

}  // namespace
