#include "core/contact/centerline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/contact/tubes.hpp"

namespace {

using namespace bowstring::contact;
using namespace bowstring::contact::testing;

/// (x, y) of the classical smooth test curve.
std::vector<double> sinusoid(double x) { return {x, 25.0 * std::sin(2.0 * M_PI * x / 150.0)}; }

double distance_to_node(const Tube& tube, const Centerline& curve, int node) {
  const CurvePoint q = evaluate(curve, coordinate(node, curve.nodes));
  double d[3] = {};
  for (int k = 0; k < tube.dimension; ++k) {
    d[k] = q.position[k] - tube.points[static_cast<std::size_t>(node * tube.dimension + k)];
  }
  return norm(d, 3);
}

/// Slope of log(error) over log(spacing) by least squares.
double fitted_order(const std::vector<double>& spacing, const std::vector<double>& error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(spacing.size());
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    const double x = std::log(spacing[i]), y = std::log(error[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

TEST_CASE("stencil weights are a partition of unity and agree with the curve") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Interpolation interpolation : {Interpolation::polyline, Interpolation::spline}) {
    for (int nodes = 2; nodes <= 9; ++nodes) {
      const Tube tube = crooked_tube(3, nodes, random);
      const Centerline curve = tube.view(interpolation);
      for (int segment = 0; segment < nodes - 1; ++segment) {
        for (const double u : {0.0, uniform(random), 1.0}) {
          CAPTURE(nodes);
          CAPTURE(segment);
          CAPTURE(u);
          const Stencil w = stencil(interpolation, {segment, u}, nodes);
          REQUIRE(w.nodes.first >= 0);
          REQUIRE(w.nodes.first + w.nodes.count <= nodes);
          REQUIRE(w.nodes.count <= max_stencil);
          double sums[3] = {}, q[3] = {}, q1[3] = {}, q2[3] = {}, r[3] = {};
          for (int k = 0; k < w.nodes.count; ++k) {
            const int node = w.nodes.first + k;
            const double weights[3] = {w.value[k], w.slope[k], w.second[k]};
            for (int m = 0; m < 3; ++m) {
              sums[m] += weights[m];
              r[m] += weights[m] * tube.radius[static_cast<std::size_t>(node)];
            }
            for (int i = 0; i < 3; ++i) {
              const double p = tube.points[static_cast<std::size_t>(node * 3 + i)];
              q[i] += w.value[k] * p;
              q1[i] += w.slope[k] * p;
              q2[i] += w.second[k] * p;
            }
          }
          CHECK(sums[0] == doctest::Approx(1.0).epsilon(1e-14));
          CHECK(std::abs(sums[1]) < 1e-14);
          CHECK(std::abs(sums[2]) < 1e-14);
          const CurvePoint point = evaluate(curve, {segment, u});
          REQUIRE(norm(point.slope, 3) > 0.1);
          for (int i = 0; i < 3; ++i) {
            CHECK(std::abs(q[i] - point.position[i]) < 1e-12);
            CHECK(std::abs(q1[i] - point.slope[i]) < 1e-12);
            CHECK(std::abs(q2[i] - point.second[i]) < 1e-12);
          }
          CHECK(std::abs(r[0] - point.radius) < 1e-12);
          CHECK(std::abs(r[1] - point.radius_slope) < 1e-12);
          CHECK(std::abs(r[2] - point.radius_second) < 1e-12);
        }
      }
    }
  }
}

TEST_CASE("derivatives of the curve agree with differences") {
  std::mt19937 random(12);
  const Tube tube = crooked_tube(3, 7, random);
  for (const Interpolation interpolation : {Interpolation::polyline, Interpolation::spline}) {
    const Centerline curve = tube.view(interpolation);
    for (int segment = 0; segment < 6; ++segment) {
      const double u = 0.37, step = 1e-5;
      const CurvePoint here = evaluate(curve, {segment, u});
      const CurvePoint low = evaluate(curve, {segment, u - step}), high = evaluate(curve, {segment, u + step});
      REQUIRE(norm(here.slope, 3) > 0.1);
      for (int i = 0; i < 3; ++i) {
        CHECK(here.slope[i] == doctest::Approx((high.position[i] - low.position[i]) / (2 * step)).epsilon(1e-8));
        CHECK(std::abs(here.second[i] - (high.slope[i] - low.slope[i]) / (2 * step)) < 1e-8);
      }
      CHECK(std::abs(here.radius_slope - (high.radius - low.radius) / (2 * step)) < 1e-8);
      CHECK(std::abs(here.radius_second - (high.radius_slope - low.radius_slope) / (2 * step)) < 1e-8);
    }
  }
}

TEST_CASE("the spline is C² across knots and ends at its end nodes") {
  std::mt19937 random(13);
  for (int nodes = 3; nodes <= 8; ++nodes) {
    const Tube tube = crooked_tube(3, nodes, random);
    const Centerline curve = tube.view(Interpolation::spline);
    for (int knot = 1; knot + 1 < nodes; ++knot) {
      const CurvePoint before = evaluate(curve, {knot - 1, 1.0}), after = evaluate(curve, {knot, 0.0});
      REQUIRE(norm(after.second, 3) > 1e-2);
      for (int i = 0; i < 3; ++i) {
        CHECK(std::abs(before.position[i] - after.position[i]) < 1e-12);
        CHECK(std::abs(before.slope[i] - after.slope[i]) < 1e-12);
        CHECK(std::abs(before.second[i] - after.second[i]) < 1e-12);
      }
      CHECK(std::abs(before.radius_second - after.radius_second) < 1e-12);
    }
    CHECK(distance_to_node(tube, curve, 0) < 1e-12);
    CHECK(distance_to_node(tube, curve, nodes - 1) < 1e-12);
    // The reflected point beyond an end leaves no curvature there.
    CHECK(norm(evaluate(curve, {0, 0.0}).second, 3) < 1e-12);
    CHECK(norm(evaluate(curve, {nodes - 2, 1.0}).second, 3) < 1e-12);
  }
}

TEST_CASE("the spline passes the nodes of a smooth curve to fourth order") {
  std::vector<double> spacing, inner, next_to_end;
  for (const int nodes : {21, 41, 81, 161, 321}) {
    const Tube vessel = tube(sinusoid, 0.0, 150.0, nodes, 6.0);
    const Centerline curve = vessel.view(Interpolation::spline);
    double largest = 0.0;
    for (int i = nodes / 5; i <= nodes - 1 - nodes / 5; ++i) {
      largest = std::max(largest, distance_to_node(vessel, curve, i));
    }
    spacing.push_back(150.0 / (nodes - 1));
    inner.push_back(largest);
    // The sinusoid has no curvature at its own ends: an end at its crest shows the order there.
    const Tube crest = tube(sinusoid, 37.5, 150.0, nodes, 6.0);
    next_to_end.push_back(distance_to_node(crest, crest.view(Interpolation::spline), 1));
  }
  REQUIRE(inner.back() > 1e-9);
  CHECK(fitted_order(spacing, inner) == doctest::Approx(4.0).epsilon(0.02));
  CHECK(fitted_order(spacing, next_to_end) == doctest::Approx(2.0).epsilon(0.02));
}

TEST_CASE("the spline follows a straight line exactly") {
  const Tube straight = tube(line, 0.0, 30.0, 7, 5.0);
  const Centerline curve = straight.view(Interpolation::spline);
  for (const double sigma : {0.0, 0.3, 2.0, 4.75, 6.0}) {
    const CurvePoint q = evaluate(curve, coordinate(sigma, 7));
    CHECK(q.position[0] == doctest::Approx(5.0 * sigma).epsilon(1e-14));
    CHECK(std::abs(q.position[1]) < 1e-14);
    CHECK(q.radius == doctest::Approx(5.0).epsilon(1e-14));
  }
}

TEST_CASE("coordinates are clipped to the curve") {
  CHECK(coordinate(-1.0, 5).sigma() == 0.0);
  CHECK(coordinate(std::numeric_limits<double>::quiet_NaN(), 5).sigma() == 0.0);
  CHECK(coordinate(4.0, 5).segment == 3);
  CHECK(coordinate(4.0, 5).u == 1.0);
  CHECK(coordinate(9.0, 5).sigma() == 4.0);
  CHECK(coordinate(2.0, 5).segment == 2);
  CHECK(coordinate(2.0, 5).u == 0.0);
}

TEST_CASE("nodal curvature and the folding of a tube") {
  const auto circle = [](double angle) -> std::vector<double> {
    return {10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0};
  };
  Tube ring = tube(circle, 0.0, 4.0, 23, 6.0);
  ring.radius[9] = 7.0;
  SUBCASE("a circle's own, exactly, with the place of the largest R κ") {
    CHECK(largest_curvature(ring.points.data(), 3, 23).value == doctest::Approx(0.1).epsilon(1e-12));
    const NodeMaximum fold = tube_folds(ring.view(Interpolation::spline));
    CHECK(fold.value == doctest::Approx(0.7).epsilon(1e-12));
    CHECK(fold.node == 9);
  }
  SUBCASE("a fold back onto itself") {
    const double reversal[] = {0.0, 0.0, 2.0, 0.0, 1.0, 0.0};
    CHECK(nodal_curvature(reversal, 2, 1) == doctest::Approx(4.0 / 3.0));
    const double exact[] = {0.0, 0.0, 2.0, 0.0, 0.0, 0.0};
    CHECK(nodal_curvature(exact, 2, 1) == doctest::Approx(1.0));
  }
  SUBCASE("coincident nodes") {
    const double twice[] = {0.0, 0.0, 2.0, 0.0, 2.0, 0.0};
    CHECK(std::isinf(nodal_curvature(twice, 2, 1)));
  }
  SUBCASE("no interior node") { CHECK(largest_curvature(ring.points.data(), 3, 2).node == -1); }
}
