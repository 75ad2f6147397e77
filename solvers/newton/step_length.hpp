#pragma once

#include "core/interfaces/problem.hpp"

namespace bowstring::newton {

/// The next step after a trial that could not be evaluated: as long as the step guard allows where it says how far the
/// trial moved, otherwise half.
double shortened(double step, const Status& trial, const Problem& problem) noexcept;

}  // namespace bowstring::newton
