#pragma once

#include <string>

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// Reads the `ends` of a curve: two of a type's name or a table. Without `ends` both are pinned.
void read_ends(const Node& table, const std::string& owner, EndTable (&out)[2], Reading& reading);

}  // namespace bowstring
