#include "core/contact/connected.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/contact/tubes.hpp"

namespace {

using namespace bowstring::contact;
using namespace bowstring::contact::testing;

constexpr GapShape squared{GapForm::squared, 0.0};

/// A straight tube, nodes 0.5 mm apart, whose radius falls from 6 to 3 mm within 2 mm at x = 20 mm.
Tube narrowing() {
  Tube out = tube(line, 0.0, 40.0, 81, 6.0);
  for (int i = 0; i < out.nodes(); ++i) {
    out.radius[static_cast<std::size_t>(i)] = 6.0 - 1.5 * std::min(std::max(out.node(i)[0] - 20.0, 0.0), 2.0);
  }
  return out;
}

}  // namespace

TEST_CASE("of two places beside a ridge the lower one is taken from both sides, whatever the gap's form") {
  const Tube vessel = narrowing();
  const Centerline curve = vessel.view(Interpolation::spline);
  for (const GapForm form : {GapForm::squared, GapForm::distance, GapForm::smooth_distance}) {
    const GapShape shape{form, 0.0};
    for (const double along : {24.0, 26.5}) {
      CAPTURE(along);
      const double x[] = {along, 2.9};
      const ClosestPoint wide = closest(curve, x, shape, whole(curve), 30.0);
      const ClosestPoint narrow = closest(curve, x, shape, whole(curve), 2.0 * along);
      REQUIRE(narrow.at.sigma() - wide.at.sigma() > 4.0);
      REQUIRE(std::abs(narrow.gap - wide.gap) > 0.05);
      const ClosestPoint& lower = narrow.gap < wide.gap ? narrow : wide;
      for (const ClosestPoint& from : {wide, narrow}) {
        const ClosestPoint found = lowest_connected(curve, tube_bounds(curve), x, shape, from);
        CHECK(found.at.sigma() == doctest::Approx(lower.at.sigma()).epsilon(1e-9));
        CHECK(found.gap == doctest::Approx(lower.gap).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("where nothing lower is connected the place stays as it is") {
  const Tube vessel = narrowing();
  const Centerline curve = vessel.view(Interpolation::spline);
  const double x[] = {10.0, 5.0};
  const ClosestPoint from = closest(curve, x, squared, whole(curve), 20.0);
  REQUIRE(from.gap < -0.5);
  const ClosestPoint found = lowest_connected(curve, tube_bounds(curve), x, squared, from);
  CHECK(found.at.sigma() == from.at.sigma());
  CHECK(found.gap == from.gap);
  const Centerline polyline = vessel.view(Interpolation::polyline);
  const double beside[] = {24.0, 2.9};
  const ClosestPoint at = gap_at(polyline, beside, squared, coordinate(48.0, 81));
  CHECK(lowest_connected(polyline, tube_bounds(polyline), beside, squared, at).at.sigma() == at.at.sigma());
}

TEST_CASE("another limb of a hairpin is lower and not connected") {
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 293, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  for (const double along : {1.0, 10.0, 30.0}) {
    CAPTURE(along);
    const double x[] = {along, -4.0};
    const ClosestPoint from = gap_at(curve, x, squared, coordinate((60.0 - along) * 292.0 / (120.0 + 8.0 * M_PI), 293));
    const ClosestPoint other = globally_closest(curve, x, squared);
    REQUIRE(other.gap < -1.0);
    REQUIRE(from.gap > 5.0);
    CHECK(lowest_connected(curve, tube_bounds(curve), x, squared, from).at.sigma() == from.at.sigma());
  }
}

TEST_CASE("the next turn of overlapping tubes is lower and not connected") {
  const auto turns = [](double angle) { return helix(angle, 20.0, 10.0); };
  const Tube vessel = tube(turns, 0.0, 6.0 * M_PI, 241, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  for (const double up : {5.5, 8.0, 10.0}) {
    CAPTURE(up);
    double x[3];
    const CurvePoint q = evaluate(curve, coordinate(100.0, 241));
    for (int k = 0; k < 3; ++k) x[k] = q.position[k];
    x[2] += up;
    const ClosestPoint from = closest(curve, x, squared, {90.0, 110.0}, 100.0);
    const ClosestPoint other = globally_closest(curve, x, squared);
    REQUIRE(other.gap < from.gap - 0.5);
    REQUIRE(other.at.sigma() > 150.0);
    CHECK(lowest_connected(curve, tube_bounds(curve), x, squared, from).at.sigma() ==
          doctest::Approx(from.at.sigma()).epsilon(1e-9));
  }
}
