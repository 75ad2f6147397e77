#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "losses/transport/network-simplex/masses.hpp"
#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// min ⟨C, γ⟩ over plans γ ≥ 0 with given sums of rows and of columns, by the primal network simplex method on a dense
/// matrix. Masses are integers, so that sums are exact. It keeps its tree: the next call starts from it, whether costs
/// or masses have changed.
///
///   NetworkSimplex simplex;
///   simplex.set_masses(masses_of(weight_a, weight_b));
///   simplex.solve(costs);                          // row major, +∞ forbids
///   for (const Arc& arc : simplex.plan()) …        // mass > 0
///   simplex.solve(other_costs);                    // warm
class NetworkSimplex {
 public:
  /// Keeps the tree where the same places have mass and it can carry the new masses; else the next call starts cold.
  void set_masses(Masses masses);
  const Masses& masses() const noexcept { return masses_; }
  void forget() noexcept { tree_.clear(); }
  /// The next call starts warm.
  bool has_tree() const noexcept { return !tree_.empty(); }

  /// `cost`: rows × columns, row major; +∞ forbids. Costs that are huge beside the others, and that the plan does not
  /// need, do not drown these. False where there is no plan without forbidden pairs: then `plan` has as little mass as
  /// possible on them, and there are no potentials.
  bool solve(const double* cost);

  /// Arcs with more mass than noise, by node.
  std::vector<Arc> plan() const { return tree_.arcs(masses_.noise); }
  /// Arcs of the tree.
  std::vector<Arc> basis() const { return tree_.arcs(-1); }
  /// Potentials: row[i] + column[j] ≤ cost[i][j], equal on the plan. Places without mass have the largest ones that
  /// their pairs below the barrier allow; 0 where there are no such pairs.
  const std::vector<double>& row_potential() const noexcept { return row_potential_; }
  const std::vector<double>& column_potential() const noexcept { return column_potential_; }
  /// Costs from here on were found to be out of all proportion to those that the plan uses; else +∞.
  double barrier() const noexcept { return barrier_; }

  long pivots() const noexcept { return pivots_; }  ///< of the last call
  std::size_t memory_bytes() const noexcept;

 private:
  void start(const double* cost);
  template <class Prices>
  void pivot_to_optimum(Prices& prices);
  bool tree_has(const double* cost, double at_least, bool with_mass_only) const;
  bool drowned(const double* cost) const;
  void solve_plain(const double* cost);
  bool solve_barred(const double* cost, double barrier);
  void price_places_without_mass(const double* cost);

  Masses masses_;
  SpanningTree tree_;
  std::vector<int> order_;  // rows with mass, shuffled: rows along a curve are the worst order to price in
  std::vector<double> row_potential_, column_potential_;
  double barrier_ = 0.0;
  long pivots_ = 0;
};

}  // namespace bowstring::simplex
