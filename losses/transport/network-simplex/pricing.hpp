#pragma once

#include <cstddef>
#include <vector>

#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// An arc that pays to enter: its reduced cost c − u − v is below zero by more than rounding.
struct Candidate {
  int row = -1, column = -1;
  long barred = 0;            ///< of its reduced cost, the part that counts first: see BarredPricing
  double reduced_cost = 0.0;  ///< the other part

  bool found() const noexcept { return row >= 0; }
};

/// Potentials of a tree and reduced costs. One number per node: u of a row, −v of a column, so that a part of the tree
/// moves by one number; +∞ of columns that are not in the tree, whose arcs then never pay.
class Pricing {
 public:
  /// No arc of the trees may cost +∞; other arcs may, and never pay.
  Pricing(const double* cost, int rows, int columns);

  void compute(const SpanningTree& tree);
  /// Takes the row's best arc for `best` where it pays more.
  void offer(int row, Candidate& best) const noexcept;
  /// `entered` has come in and parted the tree.
  void move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept;
  /// Of a tree's optimum: u of the rows, v of the columns; of places outside the tree anything.
  void hand_over(std::vector<double>& row, std::vector<double>& column) const;

 private:
  const double* cost_;
  int rows_, columns_;
  double largest_ = 0.0;  // |potential| since `compute`
  std::vector<double> potential_;
};

/// The same where costs of `barrier` and more come after all others: (1, 0) against (0, c), compared by the first part,
/// then by the second. What is barred can then neither drown the others in its rounding nor, infinite, make NaN.
class BarredPricing {
 public:
  BarredPricing(const double* cost, int rows, int columns, double barrier);

  void compute(const SpanningTree& tree);
  void offer(int row, Candidate& best) const noexcept;
  void move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept;
  /// Of an optimum without mass on barred arcs: plain numbers. Its potentials (p, q) are joined to t p + q with the
  /// least t ≥ 0 that leaves no arc below the barrier with a negative reduced cost.
  void hand_over(std::vector<double>& row, std::vector<double>& column) const;

 private:
  struct Potential {
    long barred = 0;
    double cost = 0.0;
    bool in_tree = false;
  };
  Potential cost_of(int row, int column) const noexcept;

  const double* cost_;
  int rows_, columns_;
  double barrier_;
  double largest_ = 0.0;
  std::vector<Potential> potential_;
};

/// From where on costs are to be barred: above a gap so wide that a plan without those beyond is better than any with
/// them, and their rounding would be felt in the others. +∞ where there is no such gap.
double find_barrier(const double* cost, std::size_t rows, std::size_t columns);

}  // namespace bowstring::simplex
