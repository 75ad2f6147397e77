#include <doctest/doctest.h>

#include <cmath>

#include "core/curve/bend_chain.hpp"
#include "tests/geometry/built_geometry.hpp"

namespace {

using namespace bowstring::testing;
using doctest::Approx;

const double pi = std::acos(-1.0);

TEST_CASE("arcs are the chain of their segments, nodes uniform in arc length") {
  const BuiltGeometry arcs =
      built("arcs",
            "segments = [{ length = \"60 mm\" }, { length = \"40 mm\", bend = \"70 deg\", plane = \"30 "
            "deg\" }, { length = 50, bend = -1 }]\nnodes = 151",
            3);
  const bowstring::BendChain chain({{60.0, 0.0, 0.0}, {40.0, 70.0 / 180.0 * pi, pi / 6.0}, {50.0, -1.0, 0.0}});
  REQUIRE(arcs.nodes() == 151);
  for (int i = 0; i < 151; ++i) {
    const bowstring::Vector3 point = chain.position(i);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(arcs.at(i, k) - point[k]) < 1e-12);
  }
  CHECK(arcs.length() == Approx(150.0).epsilon(1e-4));
  CHECK(unevenness(arcs) < 1e-3);
  CHECK(tangent_error(arcs) < 1e-4);
  CHECK(arcs.curve.label.empty());
}

TEST_CASE("named segments label their nodes") {
  const BuiltGeometry arcs = built("arcs",
                                   "segments = [{ length = 10, name = \"cfa\" }, { length = 20, bend = 1 }, "
                                   "{ length = 10, name = \"cia\" }]\n"
                                   "nodes = 9",
                                   3);
  CHECK(arcs.curve.label == std::vector<std::string>{"cfa", "cfa", "", "", "", "", "cia", "cia", "cia"});
}

TEST_CASE("in the plane a bend's sign chooses its side") {
  const BuiltGeometry arcs = built(
      "arcs", "segments = [{ length = 40, bend = \"90 deg\" }, { length = 40, bend = \"-90 deg\" }]\nnodes = 81", 2);
  CHECK(arcs.curve.last_tangent[0] == Approx(1.0).epsilon(1e-15));
  CHECK(std::abs(arcs.curve.last_tangent[1]) < 1e-15);
  // Point symmetric about the joint.
  for (int i = 0; i < 40; ++i) {
    CHECK(arcs.at(i, 0) + arcs.at(80 - i, 0) == Approx(2.0 * arcs.at(40, 0)).epsilon(1e-13));
    CHECK(arcs.at(i, 1) + arcs.at(80 - i, 1) == Approx(2.0 * arcs.at(40, 1)).epsilon(1e-13));
  }
  CHECK(arcs.at(40, 1) > 10.0);
}

TEST_CASE("segments that are missing or leave the plane are named") {
  CHECK(build_geometry("arcs", "segments = []\nnodes = 9", 3).status.text ==
        "geometry 'arcs': 'segments' is empty; expected at least one segment; give one, as in segments = [{ "
        "length = \"60 mm\" }, { length = \"40 mm\", bend = \"70 deg\" }]");
  CHECK(build_geometry("arcs",
                       "segments = [{ length = 10, plane = 1 }, { length = 10, bend = 1, plane = 1 }, { length = 10, "
                       "bend = 2, plane = 0.5 }]\nnodes = 9",
                       2)
            .status.text ==
        "segment 2 bends out of the plane ('plane' is not 0) in a scene of dimension 2; expected plane = 0; "
        "give 'bend' a sign instead, positive toward +y, or set dimension = 3 in [scene]\n"
        "segment 3 bends out of the plane ('plane' is not 0) in a scene of dimension 2; expected plane = 0; "
        "give 'bend' a sign instead, positive toward +y, or set dimension = 3 in [scene]");
}

}  // namespace
