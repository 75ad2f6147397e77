#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// What stands in the file and is idle in this scene by the structure of the composition alone, each as
/// "position: 'radius' of vessel 'iliac' has no effect: no constraint acts on it". What is idle for a reason of
/// mechanics (torsion in the plane) is told by whoever knows the mechanics.
std::vector<std::string> without_effect(const Node& root, const Composition& composition);

}  // namespace bowstring
