#pragma once

#include <string>
#include <vector>

#include "tests/recheck/rows.hpp"

namespace recheck {

/// What this program finds of one document.
struct Findings {
  std::string status;  ///< reported
  Worst stationarity;  ///< N
  double rounding_floor = 0.0;
  RowFindings rows;
  Worst energy_difference;    ///< N mm, terms and total against the reported ones
  double total_energy = 0.0;  ///< N mm
  double depth = 0.0;         ///< mm: the deepest place of a wire in a spline wall; NaN without contact
  std::vector<std::string> not_rechecked;
  std::vector<std::string> reasons;  ///< why it does not hold

  bool claims() const { return status == "converged"; }
};

/// Recomputes the certificate. Throws std::runtime_error where the document is not readable.
Findings recheck(const Result& result);

}  // namespace recheck
