#include "losses/transport/network-simplex/exact_answer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "losses/transport/network-simplex/row_kernels.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::simplex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double none = 1e-12;  // reduced costs up to here, relative to the scale of costs, count as none

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

using Link = std::pair<int, int>;  // from one node to another

/// Whether a graph has a cycle: whether something is left when all that nothing leads to is taken away, again and
/// again.
bool has_cycle(const std::vector<Link>& links, std::size_t nodes) {
  std::vector<std::size_t> first(nodes + 1, 0);
  std::vector<int> incoming(nodes, 0), to(links.size()), free;
  for (const auto& [a, b] : links) {
    ++first[static_cast<std::size_t>(a) + 1];
    ++incoming[static_cast<std::size_t>(b)];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> filled(first.begin(), first.end() - 1);
  for (const auto& [a, b] : links) to[filled[static_cast<std::size_t>(a)]++] = b;
  for (std::size_t k = 0; k < nodes; ++k) {
    if (incoming[k] == 0) free.push_back(static_cast<int>(k));
  }
  std::size_t taken = 0;
  for (; !free.empty(); ++taken) {
    const auto node = static_cast<std::size_t>(free.back());
    free.pop_back();
    for (std::size_t k = first[node]; k < first[node + 1]; ++k) {
      if (--incoming[static_cast<std::size_t>(to[k])] == 0) free.push_back(to[k]);
    }
  }
  return taken < nodes;
}

/// Potentials as what is added to costs, and what that tells.
struct Look {
  double violation = 0.0;
  double slack = infinity;  ///< the smallest reduced cost that is more than none
  long within = 0;          ///< how many are none
};

/// −v of the columns, +∞ of those without mass: their pairs can carry none.
std::vector<double> added_with_mass(const Masses& masses, const Vertex& vertex) {
  std::vector<double> add(vertex.column.size());
  for (std::size_t j = 0; j < add.size(); ++j) add[j] = masses.demand[j] > 0 ? -vertex.column[j] : infinity;
  return add;
}

/// Of pairs of places with mass; the violation of all.
Look look_at_reduced_costs(const double* cost, const Masses& masses, const Vertex& vertex, double tolerance) {
  Look out;
  const std::size_t rows = vertex.row.size(), columns = vertex.column.size();
  const int count = static_cast<int>(columns);
  std::vector<double> add(columns);
  for (std::size_t j = 0; j < columns; ++j) add[j] = -vertex.column[j];
  const std::vector<double> add_with_mass = added_with_mass(masses, vertex);
  const bool all_have_mass = add == add_with_mass;
  for (std::size_t i = 0; i < rows; ++i) {
    const double* of_row = cost + i * columns;
    const bool has_mass = masses.supply[i] > 0;
    if (!has_mass || !all_have_mass) {
      out.violation = std::max(out.violation, vertex.row[i] - row_minimum(of_row, add.data(), count).value);
    }
    if (!has_mass) continue;
    const RowLook look = look_at_row(of_row, add_with_mass.data(), vertex.row[i], tolerance, count);
    out.violation = std::max(out.violation, -look.least);
    out.slack = std::min(out.slack, look.slack);
    out.within += look.within;
  }
  return out;
}

/// Visits the pairs of places with mass that have no reduced cost and are no arcs with mass themselves, until `visit`
/// says false.
template <class Visit>
void for_each_idle_tight_arc(const double* cost, const Masses& masses, const Vertex& vertex, double tolerance,
                             const Visit& visit) {
  std::vector<Link> with_mass;
  for (const Arc& arc : vertex.basis) {
    if (arc.mass > masses.noise) with_mass.emplace_back(arc.row, arc.column);
  }
  std::sort(with_mass.begin(), with_mass.end());
  const std::vector<double> add = added_with_mass(masses, vertex);
  const std::size_t columns = vertex.column.size();
  auto next = with_mass.begin();
  for (std::size_t i = 0; i < vertex.row.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const Link arc(static_cast<int>(i), static_cast<int>(j));
      const double reduced = cost[i * columns + j] + add[j] - vertex.row[i];
      if (next != with_mass.end() && *next == arc) {
        ++next;
      } else if (masses.supply[i] > 0 && reduced <= tolerance && !visit(arc, reduced)) {
        return;
      }
    }
  }
}

bool is_tight(const Arc& arc, const double* cost, const Vertex& vertex, double tolerance) {
  const auto i = static_cast<std::size_t>(arc.row), j = static_cast<std::size_t>(arc.column);
  return cost[i * vertex.column.size() + j] - vertex.row[i] - vertex.column[j] <= tolerance;
}

/// Whether arcs without reduced cost are those of the basis and no others. They then form no cycle in any direction.
bool only_basis_is_tight(const double* cost, const Look& look, const Vertex& vertex, double tolerance) {
  return look.within == static_cast<long>(vertex.basis.size()) &&
         std::all_of(vertex.basis.begin(), vertex.basis.end(),
                     [&](const Arc& arc) { return is_tight(arc, cost, vertex, tolerance); });
}

void judge_uniqueness(const double* cost, const Masses& masses, const Look& look, const Vertex& vertex,
                      double tolerance, TransportAnswer& out) {
  out.uniqueness_known = true;
  out.multiple = false;
  out.slack = look.slack;
  if (only_basis_is_tight(cost, look, vertex, tolerance)) return;
  const std::size_t columns = vertex.column.size();
  const int first_column = static_cast<int>(vertex.row.size());
  Sets tree(vertex.row.size() + columns);
  for (const Arc& arc : vertex.basis) {
    if (arc.mass > masses.noise) tree.join(arc.row, first_column + arc.column);
  }
  Sets with_mass = tree;
  const std::size_t nodes = vertex.row.size() + columns;
  std::vector<Link> between;
  std::size_t enough = 8 * nodes;  // ties may be many, and a few of them tell
  for_each_idle_tight_arc(cost, masses, vertex, tolerance, [&](const Link& arc, double reduced) {
    const int column = first_column + arc.second;
    between.emplace_back(with_mass.of(arc.first), with_mass.of(column));
    out.multiple = between.back().first == between.back().second;
    if (!tree.join(arc.first, column)) out.slack = std::min(out.slack, std::max(reduced, 0.0));
    if (between.size() < enough) return !out.multiple;
    enough *= 2;
    out.multiple = out.multiple || has_cycle(between, nodes);
    return !out.multiple;
  });
  out.multiple = out.multiple || has_cycle(between, nodes);
  if (out.multiple) out.slack = 0.0;
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
  out.plan.row.reserve(vertex.basis.size());
  out.plan.column.reserve(vertex.basis.size());
  out.plan.value.reserve(vertex.basis.size());
  double largest_used = 0.0;
  for (const Arc& arc : vertex.basis) {
    if (arc.mass <= masses.noise) continue;
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
  certificate.cost_scale = std::max(largest_used, largest_below(cost, vertex.row.size() * columns, vertex.barrier));
  const double tolerance = none * certificate.cost_scale;
  const Look look = look_at_reduced_costs(cost, masses, vertex, tolerance);
  certificate.marginal_a = largest_error(problem.weight_a, out.plan.row, out.plan.value);
  certificate.marginal_b = largest_error(problem.weight_b, out.plan.column, out.plan.value);
  certificate.dual_violation = look.violation;
  certificate.gap = out.gap = out.value - of_a - of_b;
  out.certified = true;
  judge_uniqueness(cost, masses, look, vertex, tolerance, out);
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
