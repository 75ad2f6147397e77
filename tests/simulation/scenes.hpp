#pragma once

#include <string>

#include "core/simulation/simulation.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::testing {

/// A file of the project's `scenes` folder.
std::string scene_file(const std::string& name);

/// planar-iliac-smooth.toml with 24 nodes: solved in some ten milliseconds.
Simulation small_planar();

/// A host of this program, which has no plugins of its own: it finds those of this build from the library.
PluginHost& plugins();

/// The first lines in which two documents differ, apart from `solver.seconds`, which no two solves have in common; ""
/// where there are none. Throws where one of them has no energy that is not 0: nothing would be compared.
std::string difference(const std::string& document, const std::string& other);

bool contains(const std::string& text, const std::string& part);

}  // namespace bowstring::testing
