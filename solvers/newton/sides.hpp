#pragma once

#include <functional>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::newton {

/// One finite side of an inequality row or of a bounded unknown: sign·(value − bound) ≤ 0.
struct Side {
  int index = 0;  ///< row, or unknown
  double sign = 1.0;
  double bound = 0.0;
  double violation(double value) const noexcept { return sign * (value - bound); }
};

std::vector<Side> sides_of_rows(const Problem& problem);
std::vector<Side> sides_of_unknowns(const Problem& problem);
std::vector<int> equality_rows(const Problem& problem);

/// out: how far each side of an unknown is from its bound at q. `values`: room for all unknowns' values.
void read_room(const Problem& problem, const std::vector<Side>& sides, Span<const double> q,
               std::vector<double>& values, std::vector<double>& out);

/// Moves unknowns that are nearer to their bound than `least` of it, or beyond, to that distance inside; where there
/// are two bounds, to no more than a quarter of what lies between.
void pull_inside(const Problem& problem, const std::vector<Side>& sides, std::vector<double>& q,
                 const std::function<double(const Side&)>& least);

}  // namespace bowstring::newton
