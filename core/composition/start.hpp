#pragma once

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// [start]: empty where the file has none. Reads the document that it names, unless a state is handed over in memory;
/// whether it fits is known when the scene has been built.
StartTable read_start(const Node& root, bool from_memory, Report& report);

}  // namespace bowstring
