#pragma once

#include <cstddef>
#include <vector>

#include "losses/transport/network-simplex/barred_cost.hpp"
#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// An arc that pays to enter: its reduced cost c − u − v is below zero by more than rounding.
struct Candidate {
  int row = -1, column = -1;
  long barred = 0;            ///< of its reduced cost, the part that counts first: see BarredCost
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
  /// The largest |potential| since then.
  double largest() const noexcept { return largest_; }
  /// Takes the row's best arc for `best` where it pays more.
  void offer(int row, Candidate& best) const noexcept;
  /// `entered` has come in and parted the tree.
  void move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept;
  /// Of a tree's optimum: u of the rows, v of the columns; of places outside the tree anything.
  void hand_over(std::vector<double>& row, std::vector<double>& column) const;

 private:
  const double* cost_;
  int rows_, columns_;
  double largest_ = 0.0;
  std::vector<double> potential_;
};

/// The same where costs of `barrier` and more are barred.
class BarredPricing {
 public:
  BarredPricing(const double* cost, int rows, int columns, double barrier);

  void compute(const SpanningTree& tree);
  double largest() const noexcept { return largest_; }
  void offer(int row, Candidate& best) const noexcept;
  void move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept;
  /// Of an optimum without mass on barred arcs, as plain numbers.
  void hand_over(std::vector<double>& row, std::vector<double>& column) const;

 private:
  BarredCost cost_of(int row, int column) const noexcept;

  const double* cost_;
  int rows_, columns_;
  double barrier_;
  double largest_ = 0.0;
  std::vector<BarredCost> potential_;
};

}  // namespace bowstring::simplex
