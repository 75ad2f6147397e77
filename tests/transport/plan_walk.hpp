#pragma once

#include <functional>
#include <vector>

#include "core/transport/one_sided.hpp"

namespace bowstring::testing {

/// A measure that moves with a parameter, and the body twists of its places per unit of it.
struct MovingMeasure {
  std::function<Measure(double)> at;
  std::function<std::vector<double>(double)> motion;  ///< count × 6
};

/// One place of a walk: the transport value to a measure that stands, and its derivative by the parameter.
struct WalkPoint {
  double parameter = 0.0, value = 0.0;
  double reported = 0.0;          ///< the gradient of the plan that was found, along the motion
  OneSidedDerivatives one_sided;  ///< their ends are the set of subgradients along the motion
  bool is_switch = false;         ///< the plan changes here
  bool multiple = false;
  double slack = 0.0;
  long pivots = 0;
  SparseEntries plan;
};

/// Walks from one parameter to another in equal steps, warm; where the plan has changed between two places, the
/// switches in between are located to 1e-13 of the way and stand in the walk too. Throws std::runtime_error with the
/// status of what fails.
std::vector<WalkPoint> walk_plans(TransportComparison& transport, const MovingMeasure& moving, const Measure& standing,
                                  double from, double to, int steps);

/// The unit square's corners in the plane z = 0, turned by an angle: W₂² to the square that stands is 2 − 2 cos θ up to
/// π/4, with period π/2.
MovingMeasure turning_square();

/// A closed curve of `count` points, x = ((1 + cos(3s)/4) cos s, (1 + cos(3s)/4) sin s, sin(2s)/2), that turns about
/// the z axis.
MovingMeasure turning_knot(int count);

}  // namespace bowstring::testing
