#include "solvers/newton/sides.hpp"

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

}  // namespace bowstring::newton
