#include "enforcement/shared/bias.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bowstring::softening {

Bias bias_of(const SoftenedProblem& problem, const RowSides& sides, const std::vector<double>& rows,
             const std::vector<double>& multipliers) {
  Bias out;
  for (const int r : problem.soft_rows()) {
    const auto row = static_cast<std::size_t>(r);
    const double violation = sides.violation(r, rows[row]);
    if (violation > out.violation) out.violation = violation, out.worst_row = r;
    if (multipliers[row] == 0.0) continue;
    const double work = std::fabs(multipliers[row]) * sides.excess(r, rows[row], multipliers[row]);
    out.complementarity = std::max(out.complementarity, std::fabs(work));
    out.energy += work;
  }
  return out;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace bowstring::softening
