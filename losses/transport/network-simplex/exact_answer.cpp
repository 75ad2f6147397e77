#include "losses/transport/network-simplex/exact_answer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "plugins/sdk/guard.hpp"

namespace bowstring::simplex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tight = 1e-12;  // reduced costs up to here, relative to the scale of costs, count as none

double dot(Span<const double> weight, const std::vector<double>& potential) {
  double sum = 0.0;
  for (std::size_t k = 0; k < weight.size(); ++k) sum += weight[k] * potential[k];
  return sum;
}

double largest_error(Span<const double> weight, const std::vector<int>& place, const std::vector<double>& mass) {
  std::vector<double> left(weight.begin(), weight.end());
  for (std::size_t k = 0; k < mass.size(); ++k) left[static_cast<std::size_t>(place[k])] -= mass[k];
  double largest = 0.0;
  for (const double error : left) largest = std::max(largest, std::fabs(error));
  return largest;
}

double largest_cost(const double* cost, std::size_t count, double barrier) {
  double largest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double size = std::fabs(cost[k]);
    largest = size > largest && size < barrier ? size : largest;
  }
  return largest;
}

/// Sets of nodes that grow together.
class Sets {
 public:
  explicit Sets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }

  int of(int node) {
    while (above(node) != node) node = above(node) = above(above(node));
    return node;
  }
  /// False where they were together before.
  bool join(int a, int b) {
    a = of(a);
    b = of(b);
    above(a) = b;
    return a != b;
  }

 private:
  int& above(int node) { return above_[static_cast<std::size_t>(node)]; }
  std::vector<int> above_;
};

/// Whether a graph, its arcs as (from, to), has a cycle: what cannot be taken away from its ends.
bool has_cycle(std::vector<std::pair<int, int>> arcs, std::size_t nodes) {
  std::sort(arcs.begin(), arcs.end());
  std::vector<std::size_t> first(nodes + 1, 0);
  std::vector<int> incoming(nodes, 0), free;
  for (const auto& [from, to] : arcs) {
    ++first[static_cast<std::size_t>(from) + 1];
    ++incoming[static_cast<std::size_t>(to)];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (std::size_t k = 0; k < nodes; ++k) {
    if (incoming[k] == 0) free.push_back(static_cast<int>(k));
  }
  std::size_t taken = 0;
  for (; !free.empty(); ++taken) {
    const auto node = static_cast<std::size_t>(free.back());
    free.pop_back();
    for (std::size_t k = first[node]; k < first[node + 1]; ++k) {
      const int to = arcs[k].second;
      if (--incoming[static_cast<std::size_t>(to)] == 0) free.push_back(to);
    }
  }
  return taken < nodes;
}

struct Tight {
  int row, column;
  double reduced_cost;
};

/// What one look at all reduced costs tells.
struct Look {
  double violation = 0.0;
  double slack = infinity;   ///< the smallest that is not tight
  std::vector<Tight> tight;  ///< apart from places without mass
};

Look look_at_reduced_costs(const double* cost, const Masses& masses, const Vertex& vertex, double tolerance) {
  Look out;
  const std::size_t rows = vertex.row.size(), columns = vertex.column.size();
  std::vector<double> no_mass(columns, 0.0);
  for (std::size_t j = 0; j < columns; ++j) no_mass[j] = masses.demand[j] > 0 ? 0.0 : infinity;
  for (std::size_t i = 0; i < rows; ++i) {
    const double* of_row = cost + i * columns;
    const double without_mass = masses.supply[i] > 0 ? 0.0 : infinity;
    for (std::size_t j = 0; j < columns; ++j) {
      const double reduced = of_row[j] - vertex.row[i] - vertex.column[j];
      out.violation = -reduced > out.violation ? -reduced : out.violation;
      const double with_mass = reduced + no_mass[j] + without_mass;
      if (with_mass > tolerance) {
        out.slack = with_mass < out.slack ? with_mass : out.slack;
      } else {
        out.tight.push_back({static_cast<int>(i), static_cast<int>(j), with_mass});
      }
    }
  }
  return out;
}

void judge_uniqueness(const Look& look, const Vertex& vertex, TransportAnswer& out) {
  const int rows = static_cast<int>(vertex.row.size()), columns = static_cast<int>(vertex.column.size());
  const auto nodes = static_cast<std::size_t>(rows + columns);
  Sets with_mass(nodes), tree(nodes);
  for (const Arc& arc : vertex.plan) {
    with_mass.join(arc.row, rows + arc.column);
    tree.join(arc.row, rows + arc.column);
  }
  std::vector<std::pair<int, int>> of_plan;
  for (const Arc& arc : vertex.plan) of_plan.emplace_back(arc.row, arc.column);
  std::sort(of_plan.begin(), of_plan.end());
  std::vector<std::pair<int, int>> between;
  out.slack = look.slack;
  for (const Tight& arc : look.tight) {
    if (std::binary_search(of_plan.begin(), of_plan.end(), std::pair(arc.row, arc.column))) continue;
    if (!tree.join(arc.row, rows + arc.column)) out.slack = std::min(out.slack, std::max(arc.reduced_cost, 0.0));
    const int from = with_mass.of(arc.row), to = with_mass.of(rows + arc.column);
    if (from == to) out.multiple = true;
    between.emplace_back(from, to);
  }
  out.uniqueness_known = true;
  out.multiple = out.multiple || has_cycle(std::move(between), nodes);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

void write_answer(const TransportProblem& problem, const double* cost, const Masses& masses, const Vertex& vertex,
                  TransportAnswer& out) {
  const std::size_t columns = vertex.column.size();
  double largest_used = 0.0;
  for (const Arc& arc : vertex.plan) {
    const double mass = static_cast<double>(arc.mass) * masses.quantum;
    const double of_arc = cost[static_cast<std::size_t>(arc.row) * columns + static_cast<std::size_t>(arc.column)];
    out.plan.row.push_back(arc.row);
    out.plan.column.push_back(arc.column);
    out.plan.value.push_back(mass);
    out.value += mass * of_arc;
    largest_used = std::max(largest_used, std::fabs(of_arc));
  }
  out.transport_cost = out.value;
  const double of_a = dot(problem.weight_a, vertex.row), of_b = dot(problem.weight_b, vertex.column);
  const double total = std::accumulate(problem.weight_a.begin(), problem.weight_a.end(), 0.0);
  const double shift = 0.5 * (of_b - of_a) / total;
  out.dual_a = vertex.row;
  out.dual_b = vertex.column;
  for (double& dual : out.dual_a) dual += shift;
  for (double& dual : out.dual_b) dual -= shift;
  out.weight_gradient_a = out.dual_a;
  out.weight_gradient_b = out.dual_b;

  TransportCertificate& certificate = out.certificate;
  certificate.cost_scale = std::max(largest_used, largest_cost(cost, vertex.row.size() * columns, vertex.barrier));
  const Look look = look_at_reduced_costs(cost, masses, vertex, tight * certificate.cost_scale);
  certificate.marginal_a = largest_error(problem.weight_a, out.plan.row, out.plan.value);
  certificate.marginal_b = largest_error(problem.weight_b, out.plan.column, out.plan.value);
  certificate.dual_violation = look.violation;
  certificate.gap = out.gap = out.value - of_a - of_b;
  out.certified = true;
  judge_uniqueness(look, vertex, out);
}

void refuse_forbidden(const std::vector<Arc>& plan, const double* cost, const Masses& masses) {
  double forbidden = 0.0, whole = 0.0;
  const Arc* first = nullptr;
  for (const Arc& arc : plan) {
    const double mass = static_cast<double>(arc.mass) * masses.quantum;
    whole += mass;
    if (!std::isinf(
            cost[static_cast<std::size_t>(arc.row) * masses.demand.size() + static_cast<std::size_t>(arc.column)])) {
      continue;
    }
    forbidden += mass;
    if (first == nullptr) first = &arc;
  }
  throw StatusError(Code::invalid_input,
                    "of the mass " + number(whole) + " at least " + number(forbidden) +
                        " would have to cross forbidden pairs (cost +inf), some of it from row " +
                        std::to_string(first->row) + " to column " + std::to_string(first->column) +
                        "; expected a plan of allowed pairs; allow more of them, or choose the method 'unbalanced'");
}

}  // namespace bowstring::simplex
