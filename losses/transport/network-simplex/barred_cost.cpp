#include "losses/transport/network-simplex/barred_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bowstring::simplex {

double find_barrier(const double* cost, std::size_t rows, std::size_t columns) {
  constexpr int lowest = -1100, felt = 24;  // exponents of 2; what is that much smaller feels the rounding
  std::array<bool, 2200> has{};
  int largest_negative = lowest;
  for (std::size_t k = 0; k < rows * columns; ++k) {
    if (cost[k] == 0.0 || std::isinf(cost[k])) continue;
    const int exponent = std::ilogb(cost[k]);
    has[static_cast<std::size_t>(exponent - lowest)] = true;
    if (cost[k] < 0.0) largest_negative = std::max(largest_negative, exponent);
  }
  // A cycle through one barred pair has fewer than rows + columns others.
  const int wide = std::max(felt, std::ilogb(static_cast<double>(rows + columns)) + 3);
  int below = lowest - 1, gap_above = lowest, widest = wide;
  for (int exponent = lowest; exponent < lowest + static_cast<int>(has.size()); ++exponent) {
    if (!has[static_cast<std::size_t>(exponent - lowest)]) continue;
    if (below >= lowest && exponent - below > widest) {
      widest = exponent - below;
      gap_above = exponent;
    }
    below = exponent;
  }
  if (gap_above == lowest || largest_negative >= gap_above) return std::numeric_limits<double>::infinity();
  return std::ldexp(1.0, gap_above);
}

void join_potentials(const double* cost, double barrier, const std::vector<BarredCost>& row,
                     const std::vector<BarredCost>& column, std::vector<double>& joined_row,
                     std::vector<double>& joined_column) {
  double weight = 0.0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (std::size_t j = 0; j < column.size(); ++j) {
      const double of_pair = cost[i * column.size() + j];
      if (!(of_pair < barrier)) continue;
      const BarredCost reduced = BarredCost(of_pair) - row[i] - column[j];
      if (reduced.barred > 0) weight = std::max(weight, -reduced.cost / static_cast<double>(reduced.barred));
    }
  }
  const auto joined = [weight](BarredCost p) { return weight * static_cast<double>(p.barred) + p.cost; };
  joined_row.resize(row.size());
  joined_column.resize(column.size());
  std::transform(row.begin(), row.end(), joined_row.begin(), joined);
  std::transform(column.begin(), column.end(), joined_column.begin(), joined);
}

}  // namespace bowstring::simplex
