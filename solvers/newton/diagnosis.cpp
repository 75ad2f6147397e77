#include "solvers/newton/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bowstring::newton {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double alike = 1.0 + 1e-9;  // a row is named where it is worse than those before it
constexpr double outgrown = 1e3;      // sizes of the scene at the start
constexpr double long_when_stuck = 2.0;
constexpr double overlong = 5.0;  // lengths of a sliding wire at the start: it coils

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char out[400];
  std::snprintf(out, sizeof out, format, numbers...);
  return out;
}

const RowGroup* group_of(const Problem& problem, int row) {
  for (const RowGroup& group : problem.summary().row_groups) {
    if (row >= group.first && row < group.first + group.count) return &group;
  }
  return nullptr;
}

/// " (edge 3)" of a place's own rows, counted from the group's first.
std::string edge_name(const Problem& problem, const RowGroup& group, int row) {
  int place = 0;
  for (const LocalRows& local : problem.local_rows()) {
    if (local.first_row < group.first) continue;
    if (row >= local.first_row && row < local.first_row + local.rows) return text(" (edge %d)", place);
    ++place;
  }
  return "";
}

}  // namespace

double violation(const Problem& problem, Span<const double> rows, int row) noexcept {
  return std::max({0.0, rows[at(row)] - problem.row_upper()[at(row)], problem.row_lower()[at(row)] - rows[at(row)]});
}

double largest_violation(const Problem& problem, Span<const double> rows) noexcept {
  double largest = 0.0;
  for (int r = 0; r < problem.rows(); ++r) largest = std::max(largest, violation(problem, rows, r));
  return largest;
}

std::string failing_rows(const Problem& problem, Span<const double> rows, double tolerance) {
  std::string out;
  for (const RowGroup& group : problem.summary().row_groups) {
    int count = 0, worst = -1;
    double largest = 0.0;
    for (int r = group.first; r < group.first + group.count; ++r) {
      const double off = violation(problem, rows, r);
      if (off > tolerance) ++count;
      if (off > alike * largest) largest = off, worst = r;
    }
    if (count == 0) continue;
    out += text("%s%d of %d rows of '%s' fail, row %d the most, by %.4g mm", out.empty() ? "" : "; ", count,
                group.count, group.name.c_str(), worst - group.first, largest) +
           edge_name(problem, group, worst);
  }
  const double largest = largest_violation(problem, rows);
  if (out.empty() && largest > tolerance) out = text("the rows fail by up to %.4g mm", largest);
  return out;
}

std::string row_name(const Problem& problem, int row) {
  const RowGroup* group = group_of(problem, row);
  if (group == nullptr) return text("row %d", row);
  return text("row %d of '%s'", row - group->first, group->name.c_str()) + edge_name(problem, *group, row);
}

double extent(Span<const double> q) noexcept {
  if (q.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(q.begin(), q.end());
  return *high - *low;
}

void Growth::start(const Problem& problem, Span<const double> q, double energy) {
  energy_ = energy;
  extent_ = extent(q);
  if (!(extent_ > 0.0)) extent_ = 1.0;
  values_.resize(at(problem.unknowns()));
  problem.values(q, values_);
}

bool Growth::unbounded(const Problem& problem, Span<const double> q, double energy, std::string& reason,
                       bool stuck) const {
  if (!(energy < energy_)) return false;
  const Span<const int> order = problem.order();
  const std::size_t inner = order.size() - at(problem.border());
  const double size = extent(q);
  const bool everything = size > outgrown * extent_;
  if (!everything && problem.border() == 0) return false;
  now_.resize(values_.size());
  problem.values(q, now_);
  int wire = -1;
  for (std::size_t k = inner; k < order.size(); ++k) {
    const std::size_t u = at(order[k]);
    if (u >= now_.size() || !(values_[u] > 0.0) || !(now_[u] > (stuck ? long_when_stuck : overlong) * values_[u]))
      continue;
    if (wire < 0 || now_[u] / values_[u] > now_[at(wire)] / values_[at(wire)]) wire = order[k];
  }
  if (!everything && wire < 0) return false;
  reason = text("the energy falls without a bound: from %.6g to %.6g N mm", energy_, energy);
  if (everything) reason += text(" while the scene grew from %.4g to %.4g mm", extent_, size);
  if (wire >= 0) {
    reason += text("%s the length of a sliding wire (unknown %d) grew from %.4g to %.4g mm",
                   everything ? ";" : " while", wire, values_[at(wire)], now_[at(wire)]);
    reason += ": what pushes it is more than its stiffness and the wall resist, and it coils";
    return true;
  }
  // Of the real unknowns, an edge's length may be what grows.
  const auto longest = std::max_element(now_.begin(), now_.end());
  if (longest != now_.end() && *longest > 0.1 * size) {
    reason +=
        text("; the length of an edge (unknown %d) is now %.4g mm", static_cast<int>(longest - now_.begin()), *longest);
  }
  return true;
}

}  // namespace bowstring::newton
