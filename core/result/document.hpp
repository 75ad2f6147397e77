#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"
#include "core/procedure/state_result.hpp"

namespace bowstring {

inline constexpr const char* bowstring_version = "0.1.0";

/// `provenance` of a document as JSON text, which asks the registry for every plugin's file.
std::string provenance_json(const Session& session, const Registry& registry);

SessionRecord record_of(const Session& session, std::string provenance);

/// The `bowstring.result/1` document as JSON text, numbers with 17 significant digits: of the last of these states,
/// the others under `states`. `docs/results.md` describes every key.
std::string result_document(const std::vector<StateResult>& states);

/// The small tables of the document alone, each as it stands there: `status`, `reason`, `certificate`, `energy`,
/// `quantities`.
std::string result_scalars(const StateResult& result);

}  // namespace bowstring
