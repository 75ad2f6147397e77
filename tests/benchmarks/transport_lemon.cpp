// LEMON's network simplex by itself, on problems that `benchmark-transport make` has written: the seconds of its run()
// alone, without the graph, the maps and any check.
//
//   benchmark-transport-lemon FILE REPEATS

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "transport_problems.hpp"

namespace {

using Graph = lemon::SmartDigraph;
using Method = lemon::NetworkSimplex<Graph, std::int64_t, double>;

/// Weights in quanta of 2^-40 of the whole, the rest to the first; uniform ones as counts.
std::vector<std::int64_t> masses(const std::vector<double>& weight) {
  bool alike = true;
  for (const double w : weight) alike = alike && w == weight.front();
  constexpr double whole = 1099511627776.0;
  std::vector<std::int64_t> out;
  std::int64_t left = static_cast<std::int64_t>(whole);
  for (const double w : weight) {
    out.push_back(alike ? 1 : std::llround(w * whole));
    left -= out.back();
  }
  if (!alike) out.front() += left;
  return out;
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return 2;
  const bench::Problems problems = bench::read_problems(words[1]);
  const int rows = problems.rows, columns = problems.columns;
  Graph graph;
  graph.reserveNode(rows + columns);
  graph.reserveArc(rows * columns);
  for (int k = 0; k < rows + columns; ++k) graph.addNode();
  for (int k = 0; k < rows * columns; ++k) {
    graph.addArc(Graph::nodeFromId(k / columns), Graph::nodeFromId(rows + k % columns));
  }
  const std::vector<std::int64_t> supply = masses(problems.weight_a), demand = masses(problems.weight_b);
  Graph::NodeMap<std::int64_t> supplies(graph);
  std::int64_t all = 0;
  for (int i = 0; i < rows; ++i) {
    supplies[Graph::nodeFromId(i)] = supply[static_cast<std::size_t>(i)];
    all += supply[static_cast<std::size_t>(i)];
  }
  for (int j = 0; j < columns; ++j) supplies[Graph::nodeFromId(rows + j)] = -demand[static_cast<std::size_t>(j)];
  Graph::ArcMap<double> costs(graph);
  std::vector<double> seconds, value;
  for (int repeat = 0; repeat < std::stoi(words[2]); ++repeat) {
    for (const std::vector<double>& cost : problems.cost) {
      for (int k = 0; k < rows * columns; ++k) costs[Graph::arcFromId(k)] = cost[static_cast<std::size_t>(k)];
      Method method(graph);
      method.costMap(costs).supplyMap(supplies);
      const double start = bench::seconds_now();
      const bool found = method.run() == Method::OPTIMAL;
      seconds.push_back(bench::seconds_now() - start);
      if (!found) return 1;
      if (repeat == 0) value.push_back(method.totalCost<double>() / static_cast<double>(all));
    }
  }
  std::printf("{");
  bench::print_numbers("seconds", seconds, ", ");
  bench::print_numbers("value", value, "}\n");
  return 0;
}
