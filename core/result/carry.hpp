#pragma once

#include <string>

#include "core/result/document.hpp"

namespace bowstring {

/// The state of a solution, to be handed to `prepare` or `start_from` of another scene: what its document holds, with
/// the same bits. `name` is what messages call it: "the state 'inserted'". Its position and whether it becomes the rest
/// state are the caller's to set.
CarriedState carry(const SessionRecord& session, const Solution& solution, const Readings& readings, std::string name);
CarriedState carry(const Session& session, const Solution& solution, const Readings& readings, std::string name);

}  // namespace bowstring
