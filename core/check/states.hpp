#pragma once

#include <string>
#include <vector>

#include "core/check/check.hpp"

namespace bowstring::checking {

/// A point that the scene can be evaluated at.
struct State {
  std::string name;  ///< "the start", "perturbed state 1"
  std::vector<double> q;
};

struct States {
  std::vector<State> list;
  std::vector<CheckLine> lines;  ///< on states that could not be evaluated, or only nearer to the start
};

/// Accepts q, begins an epoch where one is due, and evaluates everything once.
Status settle(Assembly& assembly, const std::vector<double>& q);

/// The start, and states smoothly away from it: each curve's positions by sines along it, 1 % of its length but no more
/// than a quarter of the smallest vessel radius, its orientations by 0.1 rad, its lengths by 2 %. Where one cannot be
/// evaluated the displacement is halved, six times at most.
States make_states(Assembly& assembly, int perturbed, unsigned seed);

/// What such a state is away from `q` by: n numbers.
std::vector<double> smooth_displacement(const Assembly& assembly, const std::vector<double>& q, unsigned seed);

/// n numbers whose size is between 0.3 and 1.
std::vector<double> random_numbers(int count, unsigned seed);

}  // namespace bowstring::checking
