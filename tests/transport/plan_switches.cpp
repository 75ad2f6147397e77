#include <doctest/doctest.h>

#include <cmath>

#include "plugins/host/plugin_host.hpp"
#include "tests/transport/plan_walk.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

const double pi = std::acos(-1.0);

TransportComparison exact() {
  static PluginHost plugins;
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open({"exact", "euclidean", {}}, plugins, refusal);
  INFO(refusal.text());
  REQUIRE(out);
  return std::move(*out);
}

double value(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult result;
  const Status status = transport.compare(a, b, result, false);
  INFO(status.text);
  REQUIRE(status.ok());
  return result.answer.value;
}

/// What the subgradient set has to hold at every place of a walk, a switch or not.
void check_brackets(TransportComparison& transport, const MovingMeasure& moving, const Measure& standing,
                    const WalkPoint& at) {
  const double scale = 1.0 + std::fabs(at.one_sided.before) + std::fabs(at.one_sided.after);
  CHECK(at.one_sided.after <= at.one_sided.before + 1e-9 * scale);
  CHECK(at.reported >= at.one_sided.after - 1e-9 * scale);
  CHECK(at.reported <= at.one_sided.before + 1e-9 * scale);
  // One-sided differences of second order.
  const double h = 1e-5;
  const auto beyond = [&](double steps) { return value(transport, moving.at(at.parameter + steps * h), standing); };
  const double after = (-3.0 * at.value + 4.0 * beyond(1) - beyond(2)) / (2.0 * h);
  const double before = (3.0 * at.value - 4.0 * beyond(-1) + beyond(-2)) / (2.0 * h);
  CHECK(std::fabs(after - at.one_sided.after) < 1e-6 * scale);
  CHECK(std::fabs(before - at.one_sided.before) < 1e-6 * scale);
}

}  // namespace

TEST_CASE("a square turned through its switch") {
  TransportComparison transport = exact();
  const MovingMeasure square = turning_square();
  const std::vector<WalkPoint> walk = walk_plans(transport, square, square.at(0.0), 0.01, 0.5 * pi - 0.01, 40);
  int switches = 0;
  for (const WalkPoint& point : walk) {
    const double theta = point.parameter, nearest = theta <= 0.25 * pi ? theta : 0.5 * pi - theta;
    CHECK(point.value == doctest::Approx(2.0 - 2.0 * std::cos(nearest)).epsilon(1e-13));
    check_brackets(transport, square, square.at(0.0), point);
    if (std::fabs(theta - 0.25 * pi) > 1e-9) {
      CHECK_FALSE(point.multiple);
      CHECK(point.slack > 0.0);
      const double slope = (theta < 0.25 * pi ? 2.0 : -2.0) * std::sin(nearest);
      CHECK(point.reported == doctest::Approx(slope).epsilon(1e-12));
      continue;
    }
    switches += point.is_switch;
    CHECK(point.multiple);
    CHECK(point.one_sided.before == doctest::Approx(std::sqrt(2.0)).epsilon(1e-9));
    CHECK(point.one_sided.after == doctest::Approx(-std::sqrt(2.0)).epsilon(1e-9));
  }
  CHECK(switches == 1);
}

TEST_CASE("a closed curve turned through many switches") {
  TransportComparison transport = exact();
  const MovingMeasure knot = turning_knot(24);
  const Measure standing = turning_knot(24).at(0.0);
  const std::vector<WalkPoint> walk = walk_plans(transport, knot, standing, 0.02, 2.0, 40);
  int switches = 0;
  double widest = 0.0;
  for (const WalkPoint& point : walk) {
    switches += point.is_switch;
    if (point.is_switch) {
      CHECK(point.one_sided.before > point.one_sided.after);
      widest = std::max(widest, point.one_sided.before - point.one_sided.after);
    }
  }
  REQUIRE(switches > 5);
  CHECK(widest > 1e-3);
  for (std::size_t k = 0; k < walk.size(); k += 5) {
    const bool near_another = (k > 0 && walk[k].parameter - walk[k - 1].parameter < 3e-5) ||
                              (k + 1 < walk.size() && walk[k + 1].parameter - walk[k].parameter < 3e-5);
    if (!near_another) check_brackets(transport, knot, standing, walk[k]);
  }
}

TEST_CASE("a rigid shift costs the square of its size, and standing still nothing") {
  TransportComparison transport = exact();
  const Measure standing = turning_knot(40).at(0.0);
  CHECK(value(transport, standing, standing) == 0.0);
  double before = 0.0;
  for (const double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
    Measure shifted = standing;
    for (std::size_t i = 0; i < shifted.count(); ++i) {
      shifted.position[3 * i] += 2.0 * size;
      shifted.position[3 * i + 1] -= 1.0 * size;
      shifted.position[3 * i + 2] += 2.0 * size;
    }
    CHECK(value(transport, shifted, standing) == doctest::Approx(9.0 * size * size).epsilon(1e-9));
    const double turned = value(transport, turning_knot(40).at(size), standing) / (size * size);
    REQUIRE(turned > 0.1);
    if (size < 1e-1) CHECK(turned == doctest::Approx(before).epsilon(0.05));
    before = turned;
  }
}

TEST_CASE("a shift across a symmetric tie goes down on both sides, at once") {
  // The first point stands in the middle between two others, and moves sideways; its partner's mass takes what is left.
  TransportComparison transport = exact();
  const Measure standing{{-1, 0, 0, 1, 0, 0}, {}, {0.5, 0.5}};
  MovingMeasure moving;
  moving.at = [](double s) { return Measure{{s, 0.5, 0, 0, -0.5, 0}, {}, {0.5, 0.5}}; };
  moving.motion = [](double) {
    std::vector<double> twist(12, 0.0);
    twist[3] = 1.0;
    return twist;
  };
  const auto closed = [](double s) { return 0.5 * ((1.0 - std::fabs(s)) * (1.0 - std::fabs(s)) + 0.25) + 0.5 * 1.25; };
  for (const double s : {-0.2, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.2}) {
    CHECK(value(transport, moving.at(s), standing) == doctest::Approx(closed(s)).epsilon(1e-14));
  }
  TransportResult result;
  REQUIRE(transport.compare(moving.at(0.0), standing, result).ok());
  CHECK(result.answer.multiple);
  OneSidedDerivatives derivatives;
  REQUIRE(one_sided_derivatives(transport, moving.at(0.0), standing, result, moving.motion(0.0),
                                std::vector<double>(12, 0.0), derivatives)
              .ok());
  CHECK(derivatives.before == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(derivatives.after == doctest::Approx(-1.0).epsilon(1e-12));
  // A shift of all points is no switch: it changes every plan's cost by the same.
  std::vector<double> all = moving.motion(0.0);
  all[9] = 1.0;
  REQUIRE(
      one_sided_derivatives(transport, moving.at(0.0), standing, result, all, std::vector<double>(12, 0.0), derivatives)
          .ok());
  CHECK(derivatives.before == doctest::Approx(derivatives.after).scale(1.0).epsilon(1e-12));
}
