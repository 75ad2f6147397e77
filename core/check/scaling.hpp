#pragma once

#include "core/check/check.hpp"
#include "core/check/states.hpp"

namespace bowstring::checking {

/// Orders of magnitude per field and per group of rows, with a note where they differ by more than 1e6 or a row's
/// gradient is far from 1.
void check_scaling(Assembly& assembly, const std::vector<State>& states, CheckReport& report);

}  // namespace bowstring::checking
