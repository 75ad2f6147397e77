#pragma once

#include <string>
#include <vector>

#include "core/transport/transport_comparison.hpp"

namespace bowstring {

struct Spread {
  double median = 0.0, least = 0.0, most = 0.0;
};

/// The median, the least and the most of some numbers; zeros of none.
Spread spread_of(std::vector<double> numbers);

/// What comparisons cost that follow each other in small steps, as those of a line search or of a sweep do.
struct RepeatRecord {
  int count = 0;
  long seed = 0;
  double step = 0.0;  ///< mm: how far each place of the first measure moves from one comparison to the next
  Spread warm, cold;  ///< s: costs and solve, without gradients; cold: the last few of the same measures again
  Spread iterations;  ///< of the warm ones
  Spread cold_iterations;
};

/// Mean distance of the places of a measure to their nearest neighbours, mm; 0 of a single place.
double mean_spacing(const Measure& measure);

/// `count` comparisons, each after every place of `a` has moved by 0.1 of the mean spacing in a direction that is drawn
/// by `seed`; orientations stay. `comparison` has compared `a` and `b` before, and goes on from there.
Status repeat_comparison(TransportComparison& comparison, const Measure& a, const Measure& b, int count, long seed,
                         RepeatRecord& out);

}  // namespace bowstring
