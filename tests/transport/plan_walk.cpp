#include "tests/transport/plan_walk.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "core/transport/check_measure.hpp"

namespace bowstring::testing {
namespace {

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.text);
}

bool same_plan(const SparseEntries& p, const SparseEntries& q) {
  const auto sorted = [](const SparseEntries& plan) {
    std::vector<std::tuple<int, int, long>> out;
    for (std::size_t k = 0; k < plan.value.size(); ++k) {
      out.emplace_back(plan.row[k], plan.column[k], std::lround(1e9 * plan.value[k]));
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  return sorted(p) == sorted(q);
}

class Walk {
 public:
  Walk(TransportComparison& transport, const MovingMeasure& moving, const Measure& standing)
      : transport_(transport), moving_(moving), standing_(standing) {}

  WalkPoint look(double parameter) {
    const Measure a = moving_.at(parameter);
    const std::vector<double> motion = moving_.motion(parameter), still(6 * standing_.count(), 0.0);
    TransportResult result;
    require(transport_.compare(a, standing_, result));
    WalkPoint point;
    point.parameter = parameter;
    point.value = result.answer.value;
    point.multiple = result.answer.multiple;
    point.slack = result.answer.slack;
    point.pivots = result.answer.iterations;
    point.plan = result.answer.plan;
    for (std::size_t i = 0; i < a.count(); ++i) {
      for (std::size_t e = 0; e < 3; ++e)
        point.reported += result.gradient_a.position[3 * i + e] * motion[6 * i + 3 + e];
    }
    require(one_sided_derivatives(transport_, a, standing_, result, motion, still, point.one_sided));
    return point;
  }

  /// The first place beyond `from` where the plan is another one, to within `tolerance`; `to` has another plan.
  WalkPoint first_switch(const WalkPoint& from, WalkPoint to, double tolerance) {
    double low = from.parameter;
    while (to.parameter - low > tolerance) {
      const double middle = 0.5 * (low + to.parameter);
      if (middle <= low || middle >= to.parameter) break;
      WalkPoint between = look(middle);
      if (same_plan(between.plan, from.plan)) {
        low = middle;
      } else {
        to = std::move(between);
      }
    }
    to.is_switch = true;
    return to;
  }

 private:
  TransportComparison& transport_;
  const MovingMeasure& moving_;
  const Measure& standing_;
};

/// Points that turn about the z axis.
MovingMeasure turning(std::vector<double> points) {
  const auto turned = [points = std::move(points)](double angle) {
    std::vector<double> out(points.size());
    for (std::size_t i = 0; i < points.size(); i += 3) {
      out[i] = std::cos(angle) * points[i] - std::sin(angle) * points[i + 1];
      out[i + 1] = std::sin(angle) * points[i] + std::cos(angle) * points[i + 1];
      out[i + 2] = points[i + 2];
    }
    return out;
  };
  MovingMeasure moving;
  moving.at = [turned](double angle) {
    Measure measure;
    measure.position = turned(angle);
    measure.weight = uniform_weights(measure.count());
    return measure;
  };
  moving.motion = [turned](double angle) {
    const std::vector<double> at = turned(angle);
    std::vector<double> twist(2 * at.size(), 0.0);
    for (std::size_t i = 0; i < at.size(); i += 3) {
      twist[2 * i + 3] = -at[i + 1];
      twist[2 * i + 4] = at[i];
    }
    return twist;
  };
  return moving;
}

}  // namespace

std::vector<WalkPoint> walk_plans(TransportComparison& transport, const MovingMeasure& moving, const Measure& standing,
                                  double from, double to, int steps) {
  Walk walk(transport, moving, standing);
  const double tolerance = 1e-13 * std::fabs(to - from);
  std::vector<WalkPoint> points{walk.look(from)};
  for (int k = 1; k <= steps; ++k) {
    const WalkPoint next = walk.look(from + (to - from) * k / steps);
    while (!same_plan(points.back().plan, next.plan)) {
      points.push_back(walk.first_switch(points.back(), next, tolerance));
      if (points.back().parameter >= next.parameter) break;
    }
    if (points.back().parameter < next.parameter) points.push_back(next);
  }
  return points;
}

MovingMeasure turning_square() { return turning({1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0}); }

MovingMeasure turning_knot(int count) {
  std::vector<double> points;
  for (int i = 0; i < count; ++i) {
    const double s = 2.0 * std::acos(-1.0) * i / count, r = 1.0 + 0.25 * std::cos(3.0 * s);
    points.insert(points.end(), {r * std::cos(s), r * std::sin(s), 0.5 * std::sin(2.0 * s)});
  }
  return turning(std::move(points));
}

}  // namespace bowstring::testing
