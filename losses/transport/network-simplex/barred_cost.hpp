#pragma once

#include <cstddef>
#include <vector>

namespace bowstring::simplex {

/// A cost where some come after all others, forbidden pairs and costs that are out of all proportion: these are (1, 0)
/// against (0, c). Compared by the first part, then by the second. What is barred can then neither drown the others in
/// its rounding nor, infinite, make NaN.
struct BarredCost {
  long barred = 0;
  double cost = 0.0;

  constexpr BarredCost() = default;
  constexpr BarredCost(double of_pair) : cost(of_pair) {}  // NOLINT: a cost that is not barred
  constexpr BarredCost(long how_often, double rest) : barred(how_often), cost(rest) {}
  /// Costs of `barrier` and more are barred.
  static BarredCost of(double cost, double barrier) {
    return cost < barrier ? BarredCost(0, cost) : BarredCost(1, 0.0);
  }

  friend BarredCost operator+(BarredCost a, BarredCost b) { return {a.barred + b.barred, a.cost + b.cost}; }
  friend BarredCost operator-(BarredCost a, BarredCost b) { return {a.barred - b.barred, a.cost - b.cost}; }
  friend BarredCost operator-(BarredCost a) { return {-a.barred, -a.cost}; }
  friend BarredCost operator*(int factor, BarredCost a) { return {factor * a.barred, factor * a.cost}; }
  friend bool operator<(BarredCost a, BarredCost b) {
    return a.barred < b.barred || (a.barred == b.barred && a.cost < b.cost);
  }
  BarredCost& operator+=(BarredCost other) { return *this = *this + other; }
};

/// From where on costs are to be barred: above a gap so wide that a plan without those beyond is better than any with
/// them, and their rounding would be felt in the others. +∞ where there is no such gap.
double find_barrier(const double* cost, std::size_t rows, std::size_t columns);

/// The potentials (p, q) of an optimum without mass on barred arcs as plain numbers t p + q, with the least t ≥ 0 that
/// leaves no arc below the barrier with a negative reduced cost.
void join_potentials(const double* cost, double barrier, const std::vector<BarredCost>& row,
                     const std::vector<BarredCost>& column, std::vector<double>& joined_row,
                     std::vector<double>& joined_column);

}  // namespace bowstring::simplex
