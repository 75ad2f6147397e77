#pragma once

#include <string>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::newton {

/// By how much a row is outside of its bounds, ≥ 0. mm
double violation(const Problem& problem, Span<const double> rows, int row) noexcept;
double largest_violation(const Problem& problem, Span<const double> rows) noexcept;

/// Which rows fail by more than the tolerance, group by group: how many, the worst one, its edge, its amount. Empty:
/// none does.
std::string failing_rows(const Problem& problem, Span<const double> rows, double tolerance);

/// One row by name: "row 3 of 'lumen'".
std::string row_name(const Problem& problem, int row);

/// From the smallest of the coordinates to the largest: the scene's size, of which only the order matters. mm
double extent(Span<const double> q) noexcept;

/// Tells an energy that falls without a bound from one that is merely large: while it fell, the scene has outgrown
/// what it was at the start, or a wire that slides has.
class Growth {
 public:
  void start(const Problem& problem, Span<const double> q, double energy);
  /// Whether that is so, and then in which direction, with figures. `stuck`: the method finds no step any more, and
  /// less growth tells.
  bool unbounded(const Problem& problem, Span<const double> q, double energy, std::string& reason,
                 bool stuck = false) const;

 private:
  double energy_ = 0.0, extent_ = 0.0;
  std::vector<double> values_;
  mutable std::vector<double> now_;
};

}  // namespace bowstring::newton
