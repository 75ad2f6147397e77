#pragma once

#include <vector>

#include "core/procedure/procedure.hpp"

namespace bowstring::apps {

/// Runs a procedure as a person at a terminal wants it: with a line of progress on stderr, drawn over and over on a
/// terminal and silent elsewhere, and an interrupt that ends it with the best point so far.
std::vector<StateResult> run_watched(Procedure& procedure);

}  // namespace bowstring::apps
