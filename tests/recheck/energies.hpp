#pragma once

#include <string>
#include <vector>

#include "tests/recheck/curve_model.hpp"

namespace recheck {

/// Energy of one term of the composition, N mm; adds its derivatives to `gradient`. Throws UnknownTerm for a type, or a
/// form of its parameters, that this program does not know.
double energy(const Json& term, const CurveModel& model, Tape& tape, std::vector<double>& gradient);

struct UnknownTerm {
  std::string what;
};

}  // namespace recheck
