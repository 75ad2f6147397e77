#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/procedure/state_result.hpp"

namespace bowstring {

/// `provenance`: JSON text (core/result/provenance.hpp).
SessionRecord record_of(const Session& session, std::string provenance);

/// The `bowstring.result/1` document as JSON text, numbers with 17 significant digits: of the last of these states,
/// the others under `states`. `docs/results.md` describes every key. `study`: JSON text, which run of a study it is.
std::string result_document(const std::vector<StateResult>& states, const std::string& study = "null");

/// The small tables of the document alone, each as it stands there: `status`, `reason`, `certificate`, `energy`,
/// `quantities`.
std::string result_scalars(const StateResult& result);

}  // namespace bowstring
