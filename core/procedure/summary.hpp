#pragma once

#include "core/procedure/records.hpp"

namespace bowstring {

/// What a document says of a solution of this session beside its own. What cannot be read is left out.
StateSummary summarise(Session& session, const Solution& solution);

/// N mm; NaN where a term is not known.
double total_energy(const StateSummary& state);

}  // namespace bowstring
