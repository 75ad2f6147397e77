#include "losses/transport/network-simplex/pricing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "losses/transport/network-simplex/row_kernels.hpp"

namespace bowstring::simplex {
namespace {

/// What rounding may amount to in a reduced cost, relative to the largest potential: it has gathered over some pivots.
constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();

/// Of a column outside the tree, more often than any arc of it is barred.
constexpr long never = 1L << 40;

std::size_t place(int row, int column, int columns) noexcept {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

}  // namespace

Pricing::Pricing(const double* cost, int rows, int columns)
    : cost_(cost),
      rows_(rows),
      columns_(columns),
      potential_(static_cast<std::size_t>(rows + columns), std::numeric_limits<double>::infinity()) {}

void Pricing::compute(const SpanningTree& tree) {
  const int root = tree.root();
  potential_[static_cast<std::size_t>(root)] = 0.0;
  largest_ = 0.0;
  for (int node = tree.next(root); node != root; node = tree.next(node)) {
    const int parent = tree.parent(node);
    const double above = potential_[static_cast<std::size_t>(parent)];
    potential_[static_cast<std::size_t>(node)] = node < rows_ ? above + cost_[place(node, parent - rows_, columns_)]
                                                              : above - cost_[place(parent, node - rows_, columns_)];
    largest_ = std::max(largest_, std::fabs(potential_[static_cast<std::size_t>(node)]));
  }
}

void Pricing::offer(int row, Candidate& best) const noexcept {
  const double* cost = cost_ + place(row, 0, columns_);
  const double* columns = &potential_[static_cast<std::size_t>(rows_)];
  const double above = potential_[static_cast<std::size_t>(row)];
  const Minimum least = row_minimum(cost, columns, columns_);
  const double reduced = least.value - above;
  if (!(reduced < best.reduced_cost && reduced < -rounding * largest_)) return;
  best = {row, place_of(least, cost, columns), 0, reduced};
}

void Pricing::move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept {
  const double by = part.has_entering_row ? entered.reduced_cost : -entered.reduced_cost;
  int node = part.first;
  for (int k = 0; k < part.count; ++k, node = tree.next(node)) {
    double& potential = potential_[static_cast<std::size_t>(node)];
    potential += by;
    largest_ = std::max(largest_, std::fabs(potential));
  }
}

void Pricing::hand_over(std::vector<double>& row, std::vector<double>& column) const {
  row.assign(potential_.begin(), potential_.begin() + rows_);
  column.resize(static_cast<std::size_t>(columns_));
  std::transform(potential_.begin() + rows_, potential_.end(), column.begin(), [](double p) { return -p; });
}

BarredPricing::BarredPricing(const double* cost, int rows, int columns, double barrier)
    : cost_(cost),
      rows_(rows),
      columns_(columns),
      barrier_(barrier),
      potential_(static_cast<std::size_t>(rows + columns), BarredCost(never, 0.0)) {}

BarredCost BarredPricing::cost_of(int row, int column) const noexcept {
  return BarredCost::of(cost_[place(row, column, columns_)], barrier_);
}

void BarredPricing::compute(const SpanningTree& tree) {
  const int root = tree.root();
  potential_[static_cast<std::size_t>(root)] = {};
  largest_ = 0.0;
  for (int node = tree.next(root); node != root; node = tree.next(node)) {
    const int parent = tree.parent(node);
    const BarredCost above = potential_[static_cast<std::size_t>(parent)];
    const BarredCost here =
        node < rows_ ? above + cost_of(node, parent - rows_) : above - cost_of(parent, node - rows_);
    potential_[static_cast<std::size_t>(node)] = here;
    largest_ = std::max(largest_, std::fabs(here.cost));
  }
}

void BarredPricing::offer(int row, Candidate& best) const noexcept {
  const BarredCost above = potential_[static_cast<std::size_t>(row)];
  for (int j = 0; j < columns_; ++j) {
    const BarredCost reduced = cost_of(row, j) + potential_[static_cast<std::size_t>(rows_ + j)] - above;
    if (!(reduced < BarredCost(best.barred, best.reduced_cost))) continue;
    if (reduced.barred < 0 || reduced.cost < -rounding * largest_) best = {row, j, reduced.barred, reduced.cost};
  }
}

void BarredPricing::move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept {
  const BarredCost by = (part.has_entering_row ? 1 : -1) * BarredCost(entered.barred, entered.reduced_cost);
  int node = part.first;
  for (int k = 0; k < part.count; ++k, node = tree.next(node)) {
    BarredCost& potential = potential_[static_cast<std::size_t>(node)];
    potential += by;
    largest_ = std::max(largest_, std::fabs(potential.cost));
  }
}

void BarredPricing::hand_over(std::vector<double>& row, std::vector<double>& column) const {
  std::vector<BarredCost> of_row(potential_.begin(), potential_.begin() + rows_), of_column;
  // Rows outside the tree ask for nothing, as columns outside it do.
  for (BarredCost& potential : of_row) {
    if (potential.barred >= never) potential.barred = -never;
  }
  for (int j = 0; j < columns_; ++j) of_column.push_back(-potential_[static_cast<std::size_t>(rows_ + j)]);
  join_potentials(cost_, barrier_, of_row, of_column, row, column);
}

}  // namespace bowstring::simplex
