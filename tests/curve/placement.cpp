#include "core/curve/placement.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using namespace bowstring;
using doctest::Approx;

const double quarter = std::acos(0.0);

ParameterSet placed_at(const std::vector<double>& origin, const std::vector<double>& rotation) {
  ParameterSet set;
  const auto give = [&set](const char* key, const std::vector<double>& numbers) {
    if (numbers.empty()) return;
    set.values.emplace_back();
    set.values.back().key = key;
    set.values.back().type = ParameterType::vector;
    set.values.back().vector = numbers;
  };
  give("origin", origin);
  give("rotation", rotation);
  return set;
}

LocalCurve corner() {
  LocalCurve curve;
  curve.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}};
  curve.last_tangent = {0, 1, 0};
  return curve;
}

void check_numbers(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(found[i] - expected[i]) < 1e-14);
  }
}

TEST_CASE("without origin and rotation a curve stays as it is") {
  CurveGraph graph;
  REQUIRE(place(corner(), {}, 3, graph).ok());
  REQUIRE(graph.curves.size() == 1);
  check_numbers(graph.curves[0].points, {0, 0, 0, 2, 0, 0, 2, 1, 0});
  check_numbers(graph.curves[0].first_tangent, {1, 0, 0});
  check_numbers(graph.curves[0].last_tangent, {0, 1, 0});
}

TEST_CASE("in the plane an angle turns about the local origin, then the origin is added") {
  CurveGraph graph;
  REQUIRE(place(corner(), placed_at({10, 20}, {quarter}), 2, graph).ok());
  check_numbers(graph.curves[0].points, {10, 20, 10, 22, 9, 22});
  check_numbers(graph.curves[0].first_tangent, {0, 1});
  check_numbers(graph.curves[0].last_tangent, {-1, 0});
}

TEST_CASE("in space the rotation is a rotation vector") {
  CurveGraph graph;
  REQUIRE(place(corner(), placed_at({1, 2, 3}, {0, -quarter, 0}), 3, graph).ok());
  check_numbers(graph.curves[0].points, {1, 2, 3, 1, 2, 5, 1, 3, 5});
  const double third = 4.0 * quarter / 3.0 / std::sqrt(3.0);
  graph = {};
  REQUIRE(place(corner(), placed_at({}, {third, third, third}), 3, graph).ok());  // x → y → z → x
  check_numbers(graph.curves[0].points, {0, 0, 0, 0, 2, 0, 0, 2, 1});
}

TEST_CASE("small rotations and rotations by almost π keep lengths") {
  for (const double angle : {1e-300, 1e-8, 2.0 * quarter - 1e-8, 2.0 * quarter}) {
    CurveGraph graph;
    REQUIRE(place(corner(), placed_at({}, {0, 0, angle}), 3, graph).ok());
    const std::vector<double>& p = graph.curves[0].points;
    CAPTURE(angle);
    CHECK(p[3] == Approx(2.0 * std::cos(angle)).epsilon(1e-15));
    CHECK(std::abs(p[4] - 2.0 * std::sin(angle)) < 1e-15);
    CHECK(std::hypot(p[6], p[7], p[8]) == Approx(std::sqrt(5.0)).epsilon(1e-15));
  }
}

TEST_CASE("wrong numbers of entries are named together") {
  CurveGraph graph;
  const Status plane = place(corner(), placed_at({1, 2, 3}, {1, 2, 3}), 2, graph);
  CHECK(plane.code == Code::invalid_input);
  CHECK(plane.text ==
        "'origin' has 3 numbers; expected 2 in a scene of dimension 2; give one coordinate for each axis\n"
        "'rotation' has 3 numbers; expected 1 in a scene of dimension 2; give the angle, as in [\"30 deg\"]");
  const Status space = place(corner(), placed_at({}, {1}), 3, graph);
  CHECK(space.text ==
        "'rotation' has 1 number; expected 3 in a scene of dimension 3; give a rotation vector: the axis "
        "times the angle, as in [0, 0, \"30 deg\"]");
  CHECK(graph.curves.empty());
}

}  // namespace
