#pragma once

#include "core/check/check.hpp"
#include "core/check/states.hpp"

namespace bowstring::checking {

/// Moves the whole scene as one rigid body, at the last state: an energy whose laws all claim to be objective must not
/// change. Of the others, and of the ends, it is said which hold the scene in place.
void check_invariances(Assembly& assembly, const std::vector<State>& states, const CheckOptions& options,
                       CheckReport& report);

}  // namespace bowstring::checking
