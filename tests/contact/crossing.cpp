#include "core/contact/crossing.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/contact/gap.hpp"
#include "tests/contact/tubes.hpp"

namespace {

using namespace bowstring::contact;
using namespace bowstring::contact::testing;

WirePolyline wire_of(const std::vector<double>& points, int dimension) {
  return {static_cast<int>(points.size()) / dimension, points.data(), nullptr};
}

/// The largest depth at the wire's nodes, each measured from its nearest place.
double deepest_node(const Centerline& curve, const std::vector<double>& points) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(curve.dimension)) {
    deepest = std::max(deepest, globally_closest(curve, points.data() + i, {GapForm::distance, 0.0}).gap);
  }
  return deepest;
}

/// The deepest of all samples, by a search at every one of them, each from the one before.
Penetration deepest_of_all(const Centerline& curve, const WirePolyline& wire, int parts) {
  Penetration out;
  double sigma = 0.0;
  const int d = curve.dimension;
  for (int segment = 0; segment + 1 < wire.nodes; ++segment) {
    for (int k = segment == 0 ? 0 : 1; k <= parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      double x[3] = {};
      for (int i = 0; i < d; ++i) {
        const double* p = wire.points + segment * d + i;
        x[i] = (1.0 - t) * p[0] + t * p[d];
      }
      const double radius = (1.0 - t) * wire.radius[segment] + t * wire.radius[segment + 1];
      const GapShape shape{GapForm::squared, radius};
      const bool first = segment == 0 && k == 0;
      const ClosestPoint at = first ? globally_closest(curve, x, shape) : closest(curve, x, shape, whole(curve), sigma);
      sigma = at.at.sigma();
      const double depth = at.distance - at.clearance;
      if (first || depth > out.depth) out = {depth, 0.0, segment, t, sigma, at.distance};
    }
  }
  return out;
}

/// A wire of straight chords inside a tube, between its ends: `share` of the clearance from the middle, turning.
std::vector<double> wavy_wire(const Tube& vessel, int nodes, double share, std::vector<double>& radius,
                              std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  std::vector<double> points;
  radius.clear();
  const double phase = 3.0 * uniform(random);
  for (int i = 0; i < nodes; ++i) {
    const double sigma = 1.0 + (curve.segments() - 2.0) * i / (nodes - 1);
    const CurvePoint q = evaluate(curve, coordinate(sigma, curve.nodes));
    radius.push_back(0.4 + 0.1 * uniform(random));
    const double off = share * (q.radius - radius.back()), turn = 0.4 * i + phase;
    const double across[3] = {0.0, off * std::cos(turn), curve.dimension == 3 ? off * std::sin(turn) : 0.0};
    for (int k = 0; k < curve.dimension; ++k) points.push_back(q.position[k] + across[k]);
  }
  return points;
}

}  // namespace

TEST_CASE("what the walk passes by is not the deepest, and what it approximates on its way is exact in the end") {
  std::mt19937 random(7);
  int deep = 0;
  for (const int dimension : {2, 3}) {
    for (const int nodes : {15, 60, 400}) {
      for (const double share : {0.0, 0.5, 0.95, 1.05}) {
        CAPTURE(dimension);
        CAPTURE(nodes);
        CAPTURE(share);
        const Tube vessel = crooked_tube(dimension, 40, random);
        std::vector<double> radius;
        const std::vector<double> points = wavy_wire(vessel, nodes, share, radius, random);
        const WirePolyline wire{nodes, points.data(), radius.data()};
        const Centerline curve = vessel.view(Interpolation::spline);
        const WallCheck check = check_wall(curve, wire);
        const Penetration dense = deepest_of_all(curve, wire, 16), deepest = deepest_of_all(curve, wire, 20);
        REQUIRE(dense.depth != 0.0);
        deep += dense.depth > -0.5 ? 1 : 0;
        CHECK(check.dense.depth == doctest::Approx(dense.depth).epsilon(1e-13));
        CHECK(check.dense.segment == dense.segment);
        CHECK(check.dense.t == dense.t);
        CHECK(check.dense.vessel_coordinate == doctest::Approx(dense.vessel_coordinate).epsilon(1e-12));
        CHECK(check.dense.distance == doctest::Approx(dense.distance).epsilon(1e-13));
        CHECK(check.crossing.deepest.depth == doctest::Approx(deepest.depth).epsilon(1e-13));
        CHECK(check.crossing.deepest.segment == deepest.segment);
        CHECK(check.crossing.deepest.t == deepest.t);
        const CrossingCheck alone = check_crossing(curve, wire);
        CHECK(alone.deepest.depth == doctest::Approx(deepest.depth).epsilon(1e-13));
        CHECK(alone.crossed() == check.crossing.crossed());
        CHECK(alone.allowance == check.crossing.allowance);
        CHECK(max_penetration_dense(curve, wire).depth == doctest::Approx(dense.depth).epsilon(1e-13));
      }
    }
  }
  CHECK(deep > 4);
}

TEST_CASE("a zigzag wire that leaves the tube between its nodes is found, with amount and place") {
  const double bend = 30.0, radius = 5.0, turn = 0.4;
  const auto arc = [=](double s) -> std::vector<double> {
    return {bend * std::sin(s / bend), bend * (1.0 - std::cos(s / bend))};
  };
  const Tube vessel = tube(arc, 0.0, 90.0, 91, radius);
  // Pairs of nodes on the inner and the outer wall in turn; the chord of an inner pair cuts the wall.
  std::vector<double> points, arcs{0.0};
  const double side[] = {0.0, -1.0, 1.0, 1.0, -1.0, -1.0, 0.0};
  for (int i = 0; i < 7; ++i) {
    const double angle = 0.1 + turn * i, rho = bend - side[i] * radius;
    points.push_back(rho * std::sin(angle));
    points.push_back(bend - rho * std::cos(angle));
    if (i > 0) {
      arcs.push_back(arcs.back() + std::hypot(points[points.size() - 2] - points[points.size() - 4],
                                              points[points.size() - 1] - points[points.size() - 3]));
    }
  }
  for (const Interpolation interpolation : {Interpolation::polyline, Interpolation::spline}) {
    const Centerline curve = vessel.view(interpolation);
    REQUIRE(deepest_node(curve, points) < 0.01);
    const CrossingCheck check = check_crossing(curve, wire_of(points, 2));
    const double amount = (bend - radius) * (1.0 - std::cos(0.5 * turn));
    CHECK(check.deepest.depth == doctest::Approx(amount).epsilon(1e-4));
    CHECK(check.deepest.segment == 2);
    CHECK(check.deepest.t == doctest::Approx(0.5));
    CHECK(check.deepest.wire_arc == doctest::Approx(0.5 * (arcs[2] + arcs[3])).epsilon(1e-12));
    CHECK(check.deepest.vessel_coordinate == doctest::Approx(bend * (0.1 + 2.5 * turn)).epsilon(1e-4));
    CHECK(max_penetration_dense(curve, wire_of(points, 2)).depth == doctest::Approx(amount).epsilon(1e-4));
  }
}

TEST_CASE("a wire inside is not deep, and its own radius counts") {
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 73, 6.0);
  const Tube wire = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 61, 0.5);
  const Centerline curve = vessel.view(Interpolation::spline);
  CrossingCheck check = check_crossing(curve, {61, wire.points.data(), nullptr});
  CHECK(check.deepest.depth < -5.8);
  CHECK_FALSE(check.crossed());
  check = check_crossing(curve, {61, wire.points.data(), wire.radius.data()});
  CHECK(check.deepest.depth < -5.3);
  CHECK(check.deepest.depth > -5.5);
  const double longest = std::hypot(wire.points[2] - wire.points[0], wire.points[3] - wire.points[1]);
  const double curvature = largest_curvature(vessel.points.data(), 2, 73).value;
  CHECK(check.allowance == doctest::Approx(curvature * longest * longest / 4.0 + 5.5 / 20.0).epsilon(1e-3));
}

TEST_CASE("a wire that takes a shortcut between the limbs of a hairpin is found") {
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 73, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  std::vector<double> points;
  for (double x = 60.0; x >= 30.0; x -= 5.0) points.insert(points.end(), {x, 6.0});
  for (double x = 30.0; x <= 60.0; x += 5.0) points.insert(points.end(), {x, -6.0});
  REQUIRE(deepest_node(curve, points) < 0.0);
  const CrossingCheck check = check_crossing(curve, wire_of(points, 2));
  CHECK(check.crossed());
  // Measured from the upper limb to the end: 14 mm away from its axis.
  CHECK(check.deepest.depth == doctest::Approx(14.0 - 6.0).epsilon(1e-6));
  CHECK(check.deepest.vessel_coordinate < 30.0);
}

TEST_CASE("a wire that skips a turn of overlapping tubes is inside of one everywhere, and still found") {
  const auto turns = [](double angle) { return helix(angle, 20.0, 10.0); };
  const Tube vessel = tube(turns, 0.0, 6.0 * M_PI, 241, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  std::vector<double> points;
  for (int i = 0; i <= 20; ++i) {
    const double angle = M_PI + 0.1 * i;
    const std::vector<double> p = turns(angle + (i >= 10 ? 2.0 * M_PI : 0.0));
    points.insert(points.end(), p.begin(), p.end());
  }
  const WirePolyline wire = wire_of(points, 3);
  double own_branch = -1.0;
  for (int segment = 0; segment + 1 < wire.nodes; ++segment) {
    for (int k = 0; k <= 20; ++k) {
      double x[3];
      for (int i = 0; i < 3; ++i) {
        const double* p = wire.points + 3 * segment + i;
        x[i] = p[0] + 0.05 * k * (p[3] - p[0]);
      }
      own_branch = std::max(own_branch, globally_closest(curve, x, {GapForm::distance, 0.0}).gap);
    }
  }
  REQUIRE(own_branch < 0.0);
  const CrossingCheck check = check_crossing(curve, wire);
  CHECK(check.crossed());
  CHECK(check.deepest.depth == doctest::Approx(4.0).epsilon(0.02));
  CHECK(check.deepest.segment >= 9);

  SUBCASE("the same wire without the skip") {
    for (int i = 10; i <= 20; ++i) points[static_cast<std::size_t>(3 * i + 2)] -= 10.0;
    CHECK_FALSE(check_crossing(curve, wire).crossed());
  }
}

TEST_CASE("a wire that starts partway, against the direction, or ends inside") {
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 73, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  std::vector<double> points;
  for (double s = 110.0; s >= 30.0; s -= 4.0) {
    const std::vector<double> p = hairpin(60.0, 8.0)(s);
    points.insert(points.end(), {p[0], p[1] + 1.0});
  }
  const CrossingCheck check = check_crossing(curve, wire_of(points, 2));
  CHECK_FALSE(check.crossed());
  CHECK(check.deepest.depth < -4.0);
  // A wire bound to the other limb by its start is measured from there.
  CHECK(check_crossing(curve, wire_of(points, 2), 5.0).crossed());
}

TEST_CASE("beyond its end the tube continues straight") {
  const Tube vessel = tube(line, 0.0, 50.0, 26, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  const std::vector<double> out{-20.0, 2.0, 10.0, 2.0, 40.0, 3.0, 80.0, 3.0};
  const CrossingCheck inside = check_crossing(curve, wire_of(out, 2));
  CHECK(inside.deepest.depth == doctest::Approx(-3.0).epsilon(1e-12));
  CHECK_FALSE(inside.crossed());
  const std::vector<double> sideways{10.0, 2.0, 40.0, 3.0, 60.0, 9.0, 62.0, 9.0};
  CHECK(check_crossing(curve, wire_of(sideways, 2)).deepest.depth == doctest::Approx(3.0).epsilon(1e-12));
}

TEST_CASE("σ follows at most ten times as far as the wire moves") {
  // Past the centre of the bend the closest point would run around most of the half circle, 25 mm.
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 293, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  const std::vector<double> points{-0.01, 0.5, -0.01, -0.5};
  const Penetration at = deepest_penetration(curve, wire_of(points, 2), 1);
  const double edge = (120.0 + 8.0 * M_PI) / 292.0;
  CHECK(edge * at.vessel_coordinate == doctest::Approx(60.0 + 10.0).epsilon(0.01));
  CHECK(at.depth > 2.0);
}

TEST_CASE("the allowance of a mesh") {
  const auto circle = [](double angle) -> std::vector<double> {
    return {20.0 * std::cos(angle), 20.0 * std::sin(angle)};
  };
  Tube vessel = tube(circle, 0.0, 3.0, 61, 6.0);
  vessel.radius[7] = 5.0;
  const std::vector<double> points{0.0, 0.0, 3.0, 0.0, 3.0, 4.0};
  const double radius[] = {0.5, 1.0, 0.5};
  const Centerline curve = vessel.view(Interpolation::spline);
  CHECK(crossing_allowance(curve, {3, points.data(), radius}) ==
        doctest::Approx(16.0 / 80.0 + 4.0 / 20.0).epsilon(1e-10));
  const std::vector<double> coarse{0.0, 0.0, 40.0, 0.0};
  CHECK(crossing_allowance(curve, wire_of(coarse, 2)) == doctest::Approx(5.0 + 5.0 / 20.0));
}

TEST_CASE("NaN in a wire or vessel is no pass") {
  Tube vessel = tube(line, 0.0, 50.0, 26, 6.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> points{0.0, 0.0, 10.0, 1.0, nan, 1.0, 30.0, 0.0};
  const CrossingCheck check = check_crossing(vessel.view(Interpolation::spline), wire_of(points, 2));
  CHECK(std::isnan(check.deepest.depth));
  CHECK(check.deepest.segment == 1);
  CHECK(check.crossed());
  vessel.points[21] = nan;
  const std::vector<double> straight{0.0, 0.0, 50.0, 0.0};
  CHECK(check_crossing(vessel.view(Interpolation::spline), wire_of(straight, 2)).crossed());
}

namespace {

/// A straight tube of 6 mm that narrows to 3 mm within 3⅓ mm from 80 mm on, and widens again from 110 mm on.
Tube stenosis() {
  Tube out = tube(line, 0.0, 200.0, 321, 6.0);
  for (int i = 0; i < out.nodes(); ++i) {
    const double s = out.node(i)[0];
    const double narrow =
        std::min(std::clamp((s - 80.0) / 3.3333, 0.0, 1.0), std::clamp((113.3333 - s) / 3.3333, 0.0, 1.0));
    out.radius[static_cast<std::size_t>(i)] = 6.0 - 3.0 * narrow;
  }
  return out;
}

/// A straight wire off the middle, its nodes in order or in reverse.
std::vector<double> straight_wire(double off, bool reversed) {
  std::vector<double> points;
  for (int i = 0; i <= 100; ++i) points.insert(points.end(), {2.0 * (reversed ? 100 - i : i), off});
  return points;
}

}  // namespace

TEST_CASE("past a ridge of the wall the wire is measured from the ball that it goes on in") {
  const Tube vessel = stenosis();
  const Centerline curve = vessel.view(Interpolation::spline);
  const std::vector<double> radius(101, 0.0);
  for (const bool reversed : {false, true}) {
    CAPTURE(reversed);
    const std::vector<double> points = straight_wire(2.9, reversed);
    const WirePolyline wire{101, points.data(), radius.data()};
    // The place that was nearest before the ridge is left behind.
    REQUIRE(deepest_of_all(curve, wire, 20).depth > 1.0);
    REQUIRE(deepest_node(curve, points) == doctest::Approx(-0.1).epsilon(0.1));
    const WallCheck check = check_wall(curve, wire);
    CHECK_FALSE(check.crossing.crossed());
    CHECK(check.crossing.deepest.depth == doctest::Approx(-0.1).epsilon(0.1));
    CHECK(check.dense.depth == doctest::Approx(-0.1).epsilon(0.1));
    CHECK(max_penetration_dense(curve, wire).depth == doctest::Approx(-0.1).epsilon(0.1));
  }
}

TEST_CASE("a wire that leaves the tube beside a ridge is found, by how much it does") {
  const Tube vessel = stenosis();
  const Centerline curve = vessel.view(Interpolation::spline);
  for (const bool reversed : {false, true}) {
    CAPTURE(reversed);
    const std::vector<double> points = straight_wire(3.5, reversed);
    const CrossingCheck check = check_crossing(curve, wire_of(points, 2));
    CHECK(check.crossed());
    CHECK(check.deepest.depth == doctest::Approx(0.5).epsilon(1e-2));
    CHECK(check.exit.depth > check.allowance);
  }
}
