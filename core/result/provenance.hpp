#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/registry.hpp"

namespace bowstring {

inline constexpr const char* bowstring_version = "0.1.0";

/// A plugin that a composition names, and the library that it came from.
struct PluginProvenance {
  Kind kind = Kind::energy;
  std::string name;
  ComponentOrigin origin;
};

/// What a result's numbers come from, beside the composition: the programs.
struct Provenance {
  std::string version;  ///< of Bowstring
  std::uint32_t interface_version = 0;
  std::string kernel_file;                ///< libbowstring; "" where it cannot be told
  std::string kernel_sha256;              ///< of that file; "" where it cannot be read
  std::vector<PluginProvenance> plugins;  ///< each once, by kind and name
};

/// Of the running kernel and of the plugins that a composition names, from the registry.
Provenance provenance_of(const Composition& composition, const Registry& registry);

/// `provenance` of a result document as JSON text.
std::string provenance_json(const Provenance& provenance);

}  // namespace bowstring
