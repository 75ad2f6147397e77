#include "solvers/newton/sides.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring::newton {

namespace {

void add(std::vector<Side>& sides, int index, double lower, double upper) {
  if (std::isfinite(upper)) sides.push_back({index, 1.0, upper});
  if (std::isfinite(lower)) sides.push_back({index, -1.0, lower});
}

}  // namespace

std::vector<Side> sides_of_rows(const Problem& problem) {
  std::vector<Side> sides;
  for (int r = 0; r < problem.rows(); ++r) {
    const double lower = problem.row_lower()[static_cast<std::size_t>(r)];
    const double upper = problem.row_upper()[static_cast<std::size_t>(r)];
    if (lower != upper) add(sides, r, lower, upper);
  }
  return sides;
}

std::vector<Side> sides_of_unknowns(const Problem& problem) {
  std::vector<Side> sides;
  for (int u = 0; u < problem.unknowns(); ++u) {
    add(sides, u, problem.lower()[static_cast<std::size_t>(u)], problem.upper()[static_cast<std::size_t>(u)]);
  }
  return sides;
}

std::vector<int> equality_rows(const Problem& problem) {
  std::vector<int> rows;
  for (int r = 0; r < problem.rows(); ++r) {
    if (problem.row_lower()[static_cast<std::size_t>(r)] == problem.row_upper()[static_cast<std::size_t>(r)]) {
      rows.push_back(r);
    }
  }
  return rows;
}

void read_room(const Problem& problem, const std::vector<Side>& sides, Span<const double> q,
               std::vector<double>& values, std::vector<double>& out) {
  out.clear();
  if (sides.empty()) return;
  values.resize(static_cast<std::size_t>(problem.unknowns()));
  problem.values(q, values);
  for (const Side& side : sides) out.push_back(-side.violation(values[static_cast<std::size_t>(side.index)]));
}

void pull_inside(const Problem& problem, const std::vector<Side>& sides, std::vector<double>& q,
                 const std::function<double(const Side&)>& least) {
  std::vector<double> values, room, delta(static_cast<std::size_t>(problem.unknowns()), 0.0);
  read_room(problem, sides, q, values, room);
  bool any = false;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto unknown = static_cast<std::size_t>(sides[k].index);
    double push = least(sides[k]);
    const double between = problem.upper()[unknown] - problem.lower()[unknown];
    if (std::isfinite(between)) push = std::min(push, 0.25 * between);
    if (room[k] >= push) continue;
    delta[unknown] = sides[k].bound - sides[k].sign * push - values[unknown];
    any = true;
  }
  if (!any) return;
  std::vector<double> moved(q.size());
  problem.retract(q, delta, moved);
  q = moved;
}

}  // namespace bowstring::newton
