#include "losses/transport/network-simplex/network_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "losses/transport/network-simplex/barred_cost.hpp"
#include "losses/transport/network-simplex/pricing.hpp"
#include "losses/transport/network-simplex/start.hpp"

namespace bowstring::simplex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool same_places(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if ((a[k] > 0) != (b[k] > 0)) return false;
  }
  return true;
}

std::vector<int> shuffled_rows(const std::vector<std::int64_t>& supply) {
  std::vector<int> out;
  for (std::size_t i = 0; i < supply.size(); ++i) {
    if (supply[i] > 0) out.push_back(static_cast<int>(i));
  }
  std::mt19937 random(1);  // std::shuffle differs from library to library
  for (std::size_t k = out.size(); k > 1; --k) std::swap(out[k - 1], out[random() % k]);
  return out;
}

/// What the arcs cost, by mass on forbidden pairs first.
std::pair<double, double> value_of(const std::vector<Arc>& arcs, const double* cost, std::size_t columns) {
  double forbidden = 0.0, sum = 0.0;
  for (const Arc& arc : arcs) {
    if (arc.mass == 0) continue;
    const double of_arc = cost[static_cast<std::size_t>(arc.row) * columns + static_cast<std::size_t>(arc.column)];
    (std::isinf(of_arc) ? forbidden : sum) += static_cast<double>(arc.mass) * (std::isinf(of_arc) ? 1.0 : of_arc);
  }
  return {forbidden, sum};
}

/// −min over rows with mass of each column's costs: what is added to them then is ≥ 0, and 0 somewhere.
std::vector<double> column_reduction(const std::vector<int>& rows, const double* cost, std::size_t columns) {
  std::vector<double> least(columns, infinity);
  for (const int row : rows) {
    const double* of_row = cost + static_cast<std::size_t>(row) * columns;
    for (std::size_t j = 0; j < columns; ++j) least[j] = of_row[j] < least[j] ? of_row[j] : least[j];
  }
  for (double& value : least) value = std::isinf(value) ? 0.0 : -value;
  return least;
}

}  // namespace

void NetworkSimplex::set_masses(Masses masses) {
  const bool same = masses.supply == masses_.supply && masses.demand == masses_.demand;
  const bool kept =
      has_tree() && (same || (same_places(masses.supply, masses_.supply) &&
                              same_places(masses.demand, masses_.demand) && tree_.carry(masses.supply, masses.demand)));
  masses_ = std::move(masses);
  if (kept) return;
  tree_.clear();
  order_ = shuffled_rows(masses_.supply);
}

void NetworkSimplex::start(const double* cost) {
  const std::size_t columns = masses_.demand.size();
  const int rows = static_cast<int>(masses_.supply.size());
  std::vector<Arc> corner = north_west_start(masses_);
  std::vector<Arc> cheapest = cheapest_start(masses_, order_, cost, column_reduction(order_, cost, columns));
  const bool along = value_of(corner, cost, columns) <= value_of(cheapest, cost, columns);
  tree_.build(rows, static_cast<int>(columns), rows + root_column(masses_), along ? corner : cheapest);
}

template <class Prices>
void NetworkSimplex::pivot_to_optimum(Prices& prices) {
  // A row is a block of a size that suits; short ones are taken together.
  const std::size_t columns = masses_.demand.size(), block = std::min(1 + 64 / columns, order_.size());
  // Potentials that are moved gather rounding, and what pays has to exceed that of the largest one since they were
  // computed. So they are computed anew now and then, and the end is looked at once more after many moves, or where the
  // largest one has become much smaller.
  constexpr long moves = 128, few = 32;
  prices.compute(tree_);
  for (bool again = true; again;) {
    const long before = pivots_;
    std::size_t at = 0, without = 0;
    while (without < order_.size()) {
      Candidate best;
      for (std::size_t k = 0; k < block; ++k) {
        prices.offer(order_[at], best);
        if (++at == order_.size()) at = 0;
      }
      without += block;
      if (!best.found()) continue;
      without = 0;
      prices.move(tree_, tree_.exchange(best.row, best.column), best);
      if ((++pivots_ - before) % moves == 0) prices.compute(tree_);
    }
    if (pivots_ == before) break;
    const double largest = prices.largest();
    prices.compute(tree_);
    again = pivots_ - before > few || prices.largest() < 0.5 * largest;
  }
  prices.hand_over(row_potential_, column_potential_);
}

/// Whether an arc of the tree costs that much.
bool NetworkSimplex::tree_has(const double* cost, double at_least, bool with_mass_only) const {
  const int rows = static_cast<int>(masses_.supply.size()), root = tree_.root();
  for (int node = tree_.next(root); node != root; node = tree_.next(node)) {
    if (with_mass_only && tree_.mass_to_parent(node) <= masses_.noise) continue;
    const int row = node < rows ? node : tree_.parent(node), column = (node < rows ? tree_.parent(node) : node) - rows;
    const std::size_t place = static_cast<std::size_t>(row) * masses_.demand.size() + static_cast<std::size_t>(column);
    if (cost[place] >= at_least) return true;
  }
  return false;
}

/// Whether potentials are so much larger than what the plan costs that their rounding may be felt in it.
bool NetworkSimplex::drowned(const double* cost) const {
  constexpr double felt = 1 << 24;
  double largest = 0.0;
  for (const int row : order_) largest = std::max(largest, std::fabs(row_potential_[static_cast<std::size_t>(row)]));
  return !tree_has(cost, largest / felt, true);
}

void NetworkSimplex::solve_plain(const double* cost) {
  Pricing prices(cost, static_cast<int>(masses_.supply.size()), static_cast<int>(masses_.demand.size()));
  pivot_to_optimum(prices);
}

bool NetworkSimplex::solve_barred(const double* cost, double barrier) {
  BarredPricing prices(cost, static_cast<int>(masses_.supply.size()), static_cast<int>(masses_.demand.size()), barrier);
  pivot_to_optimum(prices);
  return !tree_has(cost, barrier, true);
}

bool NetworkSimplex::solve(const double* cost) {
  pivots_ = 0;
  barrier_ = infinity;
  if (!has_tree()) start(cost);
  const bool plain = !tree_has(cost, infinity, false);
  if (plain) solve_plain(cost);
  if (!plain || drowned(cost)) {
    const double barrier = find_barrier(cost, masses_.supply.size(), masses_.demand.size());
    if (barrier < infinity && solve_barred(cost, barrier)) {
      barrier_ = barrier;
    } else if (barrier < infinity || !plain) {
      // Without mass on forbidden pairs the tree may still have an empty one.
      if (!solve_barred(cost, infinity)) return false;
    }
  }
  price_places_without_mass(cost);
  return true;
}

void NetworkSimplex::price_places_without_mass(const double* cost) {
  const std::size_t rows = masses_.supply.size(), columns = masses_.demand.size();
  const auto room = [&](std::size_t i, std::size_t j, double potential) {
    const double of_pair = cost[i * columns + j];
    return of_pair < barrier_ ? of_pair - potential : infinity;
  };
  for (std::size_t j = 0; j < columns; ++j) {
    if (masses_.demand[j] > 0) continue;
    double least = infinity;
    for (const int row : order_) {
      const auto i = static_cast<std::size_t>(row);
      least = std::min(least, room(i, j, row_potential_[i]));
    }
    column_potential_[j] = std::isinf(least) ? 0.0 : least;
  }
  for (std::size_t i = 0; i < rows; ++i) {
    if (masses_.supply[i] > 0) continue;
    double least = infinity;
    for (std::size_t j = 0; j < columns; ++j) least = std::min(least, room(i, j, column_potential_[j]));
    row_potential_[i] = std::isinf(least) ? 0.0 : least;
  }
}

std::size_t NetworkSimplex::memory_bytes() const noexcept {
  return tree_.memory_bytes() + order_.capacity() * sizeof(int) +
         (masses_.supply.capacity() + masses_.demand.capacity()) * sizeof(std::int64_t) +
         2 * (row_potential_.capacity() + column_potential_.capacity()) * sizeof(double);
}

}  // namespace bowstring::simplex
