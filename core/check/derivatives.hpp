#pragma once

#include "core/check/check.hpp"
#include "core/check/states.hpp"

namespace bowstring::checking {

/// Every claimed derivative against central differences of fourth order along the retraction, at every state: along
/// each unknown of a small scene; along random directions, three in each field and one in all, of a large one.
void check_derivatives(Assembly& assembly, const std::vector<State>& states, const CheckOptions& options,
                       CheckReport& report);

}  // namespace bowstring::checking
