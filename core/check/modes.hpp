#pragma once

#include "core/check/check.hpp"
#include "core/check/states.hpp"

namespace bowstring::checking {

/// What nothing holds at the start: rigid motions, turns about tangents, and other near-zero modes.
void check_modes(Assembly& assembly, const std::vector<State>& states, CheckReport& report);

}  // namespace bowstring::checking
