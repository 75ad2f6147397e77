#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/interfaces/transport.hpp"
#include "losses/transport/network-simplex/barred_cost.hpp"
#include "losses/transport/network-simplex/dense_costs.hpp"
#include "losses/transport/network-simplex/exact_answer.hpp"
#include "losses/transport/network-simplex/masses.hpp"
#include "losses/transport/network-simplex/row_kernels.hpp"
#include "plugins/sdk/plugin.hpp"

// What LEMON asks of a type of costs, besides.
namespace bowstring::simplex {

inline bool operator>(BarredCost a, BarredCost b) { return b < a; }
inline bool operator>=(BarredCost a, BarredCost b) { return !(a < b); }
inline BarredCost operator*(BarredCost a, int factor) { return factor * a; }
inline BarredCost operator/(BarredCost a, int divisor) { return {a.barred / divisor, a.cost / divisor}; }
inline BarredCost& operator-=(BarredCost& a, BarredCost b) { return a = a - b; }

}  // namespace bowstring::simplex

template <>
class std::numeric_limits<bowstring::simplex::BarredCost> {
 public:
  static constexpr bool is_signed = true;
  static constexpr bool is_exact = false;
  static constexpr bowstring::simplex::BarredCost max() noexcept { return {1L << 60, 0.0}; }
};

namespace {

using namespace bowstring;
using simplex::Arc;
using simplex::BarredCost;
using simplex::Masses;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Every row to every column: arc k is place k of the matrix.
class DenseGraph {
 public:
  DenseGraph(int rows, int columns) {
    graph_.reserveNode(rows + columns);
    graph_.reserveArc(rows * columns);
    for (int k = 0; k < rows + columns; ++k) graph_.addNode();
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) graph_.addArc(node(i), node(rows + j));
    }
  }
  const lemon::SmartDigraph& graph() const { return graph_; }
  lemon::SmartDigraph::Node node(int k) const { return lemon::SmartDigraph::nodeFromId(k); }
  lemon::SmartDigraph::Arc arc(int place) const { return lemon::SmartDigraph::arcFromId(place); }

 private:
  lemon::SmartDigraph graph_;
};

/// LEMON reads costs and supplies through maps; its own ones of such types do not compile as C++20.
template <class CostType>
struct CostMap {
  using Key = lemon::SmartDigraph::Arc;
  using Value = CostType;
  const double* cost;
  double barrier, factor;

  Value operator[](Key arc) const {
    const double of_arc = cost[lemon::SmartDigraph::id(arc)];
    if constexpr (std::is_same_v<Value, double>) {
      return factor * of_arc;
    } else {
      return of_arc < barrier ? BarredCost(factor * of_arc) : BarredCost(1, 0.0);
    }
  }
};

struct SupplyMap {
  using Key = lemon::SmartDigraph::Node;
  using Value = std::int64_t;
  const Masses& masses;

  Value operator[](Key node) const {
    const auto k = static_cast<std::size_t>(lemon::SmartDigraph::id(node));
    const std::size_t rows = masses.supply.size();
    return k < rows ? masses.supply[k] : -masses.demand[k - rows];
  }
};

template <class CostType>
struct Optimum {
  std::vector<Arc> plan;
  std::vector<CostType> row, column;
};

/// The power of two that brings the costs below the barrier to one: LEMON's artificial arcs cost one more than all
/// others, and small costs would be lost beside that.
double unit_of(const double* cost, std::size_t count, double barrier) {
  const double largest = simplex::largest_below(cost, count, barrier);
  return largest > 0.0 ? std::ldexp(1.0, std::max(std::ilogb(largest), -1000)) : 1.0;
}

BarredCost scaled(double factor, BarredCost value) { return {value.barred, factor * value.cost}; }
double scaled(double factor, double value) { return factor * value; }

template <class CostType>
Optimum<CostType> run(const DenseGraph& dense, const Masses& masses, const double* cost, double barrier) {
  using Method = lemon::NetworkSimplex<lemon::SmartDigraph, std::int64_t, CostType>;
  Method method(dense.graph());
  const double unit = unit_of(cost, masses.supply.size() * masses.demand.size(), barrier);
  method.supplyMap(SupplyMap{masses}).costMap(CostMap<CostType>{cost, barrier, 1.0 / unit});
  if (method.run() != Method::OPTIMAL) throw StatusError(Code::failed, "LEMON finds no optimum of this problem");
  Optimum<CostType> out;
  const int rows = static_cast<int>(masses.supply.size()), columns = static_cast<int>(masses.demand.size());
  for (int place = 0; place < rows * columns; ++place) {
    const std::int64_t mass = method.flow(dense.arc(place));
    if (mass > masses.noise) out.plan.push_back({place / columns, place % columns, mass});
  }
  for (int i = 0; i < rows; ++i) out.row.push_back(scaled(unit, -method.potential(dense.node(i))));
  for (int j = 0; j < columns; ++j) out.column.push_back(scaled(unit, method.potential(dense.node(rows + j))));
  return out;
}

/// A vertex of the optimal plans by the network simplex of LEMON (lemon.cs.elte.hu), cold every time.
class ExactLemon final : public Transport {
 public:
  explicit ExactLemon(const ParameterSet&) {}

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    return guard([&] { solve_or_throw(problem, out); });
  }

 private:
  static void solve_or_throw(const TransportProblem& problem, TransportAnswer& out) {
    const auto rows = static_cast<std::size_t>(problem.between->row_count());
    const auto columns = static_cast<std::size_t>(problem.between->column_count());
    if (rows * columns > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw StatusError(Code::unsupported, "LEMON numbers pairs by int, and there are more; choose the method 'exact'");
    }
    simplex::DenseCosts costs;
    costs.load(*problem.between);
    const Masses masses = simplex::masses_of(problem.weight_a, problem.weight_b);
    out = {};
    simplex::write_answer(problem, costs.data(), masses, find_vertex(costs.data(), masses), out);
    // Of each pair the graph has four int, the method two, and a mass, a cost and a state.
    out.memory_bytes = costs.memory_bytes() + rows * columns * (6 * sizeof(int) + sizeof(std::int64_t) * 4 + 1);
  }

  static simplex::Vertex find_vertex(const double* cost, const Masses& masses) {
    const std::size_t rows = masses.supply.size(), columns = masses.demand.size();
    const DenseGraph dense(static_cast<int>(rows), static_cast<int>(columns));
    const double barrier = simplex::find_barrier(cost, rows, columns);
    const bool forbids = std::any_of(cost, cost + rows * columns, [](double value) { return std::isinf(value); });
    if (barrier < infinity) {
      if (auto vertex = without_barred(dense, masses, cost, barrier)) return *std::move(vertex);
    }
    if (!forbids) {
      Optimum<double> found = run<double>(dense, masses, cost, infinity);
      return {std::move(found.plan), std::move(found.row), std::move(found.column), infinity};
    }
    if (auto vertex = without_barred(dense, masses, cost, infinity)) return *std::move(vertex);
    simplex::refuse_forbidden(run<BarredCost>(dense, masses, cost, infinity).plan, cost, masses);
  }

  /// Empty where a plan cannot do without barred arcs.
  static std::optional<simplex::Vertex> without_barred(const DenseGraph& dense, const Masses& masses,
                                                       const double* cost, double barrier) {
    Optimum<BarredCost> found = run<BarredCost>(dense, masses, cost, barrier);
    simplex::Vertex out{std::move(found.plan), {}, {}, barrier};
    const auto barred = [&](const Arc& arc) {
      return !(cost[static_cast<std::size_t>(arc.row) * masses.demand.size() + static_cast<std::size_t>(arc.column)] <
               barrier);
    };
    if (std::any_of(out.basis.begin(), out.basis.end(), barred)) return std::nullopt;
    simplex::join_potentials(cost, barrier, found.row, found.column, out.row, out.column);
    return out;
  }
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, ExactLemon>(
    bowstring::Kind::transport, "exact-lemon",
    "An optimal plan by the network simplex of the library LEMON, cold every time, with the same proof as 'exact'"))
