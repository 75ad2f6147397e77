#pragma once

#include <string>

#include "core/interfaces/registry.hpp"
#include "core/result/quantities.hpp"

namespace bowstring {

inline constexpr const char* bowstring_version = "0.1.0";

/// The `bowstring.result/1` document as JSON text, numbers with 17 significant digits. `docs/results.md` describes
/// every key.
std::string result_document(const Session& session, const Solution& solution, const Readings& readings,
                            const Registry& registry);

}  // namespace bowstring
