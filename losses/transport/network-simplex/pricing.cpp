#include "losses/transport/network-simplex/pricing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "losses/transport/network-simplex/row_minimum.hpp"

namespace bowstring::simplex {
namespace {

/// What rounding may amount to in a reduced cost, relative to the largest potential: it has gathered over some pivots.
constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();

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
  if (reduced < best.reduced_cost && reduced < -rounding * largest_) best = {row, least.index, 0, reduced};
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
      potential_(static_cast<std::size_t>(rows + columns)) {}

BarredPricing::Potential BarredPricing::cost_of(int row, int column) const noexcept {
  const double cost = cost_[place(row, column, columns_)];
  return cost < barrier_ ? Potential{0, cost, true} : Potential{1, 0.0, true};
}

void BarredPricing::compute(const SpanningTree& tree) {
  const int root = tree.root();
  potential_[static_cast<std::size_t>(root)] = {0, 0.0, true};
  largest_ = 0.0;
  for (int node = tree.next(root); node != root; node = tree.next(node)) {
    const int parent = tree.parent(node);
    const Potential& above = potential_[static_cast<std::size_t>(parent)];
    const bool is_row = node < rows_;
    const Potential arc = is_row ? cost_of(node, parent - rows_) : cost_of(parent, node - rows_);
    const int sign = is_row ? 1 : -1;
    const Potential here{above.barred + sign * arc.barred, above.cost + sign * arc.cost, true};
    potential_[static_cast<std::size_t>(node)] = here;
    largest_ = std::max(largest_, std::fabs(here.cost));
  }
}

void BarredPricing::offer(int row, Candidate& best) const noexcept {
  const Potential& above = potential_[static_cast<std::size_t>(row)];
  for (int j = 0; j < columns_; ++j) {
    const Potential& column = potential_[static_cast<std::size_t>(rows_ + j)];
    if (!column.in_tree) continue;
    const Potential arc = cost_of(row, j);
    const long barred = arc.barred + column.barred - above.barred;
    const double reduced = arc.cost + column.cost - above.cost;
    if (std::pair(barred, reduced) >= std::pair(best.barred, best.reduced_cost)) continue;
    if (barred < 0 || reduced < -rounding * largest_) best = {row, j, barred, reduced};
  }
}

void BarredPricing::move(const SpanningTree& tree, const SpanningTree::Part& part, const Candidate& entered) noexcept {
  const int sign = part.has_entering_row ? 1 : -1;
  int node = part.first;
  for (int k = 0; k < part.count; ++k, node = tree.next(node)) {
    Potential& potential = potential_[static_cast<std::size_t>(node)];
    potential.barred += sign * entered.barred;
    potential.cost += sign * entered.reduced_cost;
    largest_ = std::max(largest_, std::fabs(potential.cost));
  }
}

void BarredPricing::hand_over(std::vector<double>& row, std::vector<double>& column) const {
  double weight = 0.0;
  for (int i = 0; i < rows_; ++i) {
    const Potential& above = potential_[static_cast<std::size_t>(i)];
    for (int j = 0; above.in_tree && j < columns_; ++j) {
      const Potential& below = potential_[static_cast<std::size_t>(rows_ + j)];
      const Potential arc = cost_of(i, j);
      const long barred = below.barred - above.barred;
      if (!below.in_tree || arc.barred != 0 || barred <= 0) continue;
      weight = std::max(weight, (above.cost - arc.cost - below.cost) / static_cast<double>(barred));
    }
  }
  const auto joined = [weight](const Potential& p) { return weight * static_cast<double>(p.barred) + p.cost; };
  row.resize(static_cast<std::size_t>(rows_));
  column.resize(static_cast<std::size_t>(columns_));
  std::transform(potential_.begin(), potential_.begin() + rows_, row.begin(), joined);
  std::transform(potential_.begin() + rows_, potential_.end(), column.begin(),
                 [&](const Potential& p) { return -joined(p); });
}

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

}  // namespace bowstring::simplex
