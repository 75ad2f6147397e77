#pragma once

#include <vector>

#include "study/study_data.hpp"

namespace bowstring::study {

/// What another alternative of an axis changes, everything else being equal.
struct Effect {
  static constexpr int solve_time = -1;

  int axis = 0;
  int from = 0, to = 0;  ///< alternatives; from −1: the baseline, in which the axis has no part
  int quantity = 0;      ///< or solve_time
  int pairs = 0;         ///< of converged runs
  double mean = 0.0, low = 0.0,
         high = 0.0;     ///< of `to` − `from`, with the 95 % interval by Student's t; NaN for one pair
  double largest = 0.0;  ///< difference of largest size
  int largest_run = 0;   ///< the run with `to` that has it
  /// The mean difference over the mean size of the quantity with `from`; NaN where that is 0.
  double relative = 0.0;
};

struct Effects {
  std::vector<Effect> quantities;  ///< the largest |relative| first, unknown ones last
  /// Of solve times: mean, low, high and largest are ratios `to`/`from`, the mean geometric; relative is mean − 1.
  std::vector<Effect> times;
};

/// Alternatives that state another problem than the first have no effect: nobody chooses between them.
/// For every axis with alternatives that are no numbers or two to six of them, without the axis of convergence and
/// samples: the differences from its first alternative, or from the runs in which it has no part where those pair up,
/// over pairs of runs that agree in everything else. Of pairs that differ in the mesh alone the finest counts: what a
/// coarse one adds to an effect is an error, and pairs that repeat each other would narrow the interval.
Effects find_effects(const StudyData& data);

}  // namespace bowstring::study
