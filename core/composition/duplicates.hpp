#pragma once

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// Reports curves, energies and constraints that share a name within their kind; vessels and wires are one kind,
/// because `on` refers to both.
void check_duplicates(const Node& root, Report& report);

}  // namespace bowstring
