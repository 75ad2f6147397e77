#include "losses/transport/network-simplex/start.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "losses/transport/network-simplex/row_kernels.hpp"

namespace bowstring::simplex {
namespace {

using Disturbed = std::pair<std::int64_t, long>;  // compared digit by digit

/// What is left of the masses while a plan grows.
class Remainder {
 public:
  explicit Remainder(const Masses& masses) {
    for (const std::int64_t mass : masses.supply) supply_.emplace_back(mass, mass > 0 ? 1 : 0);
    for (const std::int64_t mass : masses.demand) demand_.emplace_back(mass, 0);
    long rows = 0;
    for (const Disturbed& supply : supply_) rows += supply.second;
    demand_[static_cast<std::size_t>(root_column(masses))].second = rows;
  }

  bool row_done(int row) const { return supply_[static_cast<std::size_t>(row)] == Disturbed{}; }

  /// Sends what it can, and says whether the column has had enough.
  bool send(int row, int column, std::vector<Arc>& arcs) {
    Disturbed &supply = supply_[static_cast<std::size_t>(row)], &demand = demand_[static_cast<std::size_t>(column)];
    const Disturbed sent = std::min(supply, demand);
    arcs.push_back({row, column, sent.first});
    supply = {supply.first - sent.first, supply.second - sent.second};
    demand = {demand.first - sent.first, demand.second - sent.second};
    return demand == Disturbed{};
  }

 private:
  std::vector<Disturbed> supply_, demand_;
};

}  // namespace

int root_column(const Masses& masses) {
  int column = static_cast<int>(masses.demand.size()) - 1;
  while (masses.demand[static_cast<std::size_t>(column)] == 0) --column;
  return column;
}

std::vector<Arc> north_west_start(const Masses& masses) {
  Remainder left(masses);
  std::vector<Arc> arcs;
  int column = 0;
  for (int row = 0; row < static_cast<int>(masses.supply.size()); ++row) {
    while (!left.row_done(row)) {
      if (masses.demand[static_cast<std::size_t>(column)] == 0 || left.send(row, column, arcs)) ++column;
    }
  }
  return arcs;
}

std::vector<Arc> cheapest_start(const Masses& masses, const std::vector<int>& rows, const double* cost,
                                const std::vector<double>& add) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Remainder left(masses);
  std::vector<Arc> arcs;
  const std::size_t columns = masses.demand.size();
  std::vector<double> open(add);
  std::vector<bool> closed(columns);
  for (std::size_t j = 0; j < columns; ++j) {
    closed[j] = masses.demand[j] == 0;
    if (closed[j]) open[j] = infinity;
  }
  for (const int row : rows) {
    while (!left.row_done(row)) {
      const double* costs = cost + static_cast<std::size_t>(row) * columns;
      const Minimum least = row_minimum(costs, open.data(), static_cast<int>(columns));
      const int column = least.value < infinity
                             ? place_of(least, costs, open.data())
                             : static_cast<int>(std::find(closed.begin(), closed.end(), false) - closed.begin());
      if (!left.send(row, column, arcs)) continue;
      open[static_cast<std::size_t>(column)] = infinity;
      closed[static_cast<std::size_t>(column)] = true;
    }
  }
  return arcs;
}

}  // namespace bowstring::simplex
