#pragma once

namespace bowstring::simplex {

struct Minimum {
  double value;
  int index;  ///< the first place that has it; −1 where all are +∞
};

/// min over j < count of cost[j] + add[j], neither of them NaN or −∞. The same bits whatever the processor's width.
Minimum row_minimum(const double* cost, const double* add, int count) noexcept;

}  // namespace bowstring::simplex
