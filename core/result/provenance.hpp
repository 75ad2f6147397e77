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

/// Of the running kernel and of the plugins that are chosen, from the registry.
Provenance provenance_of(const std::vector<const ComponentChoice*>& chosen, const Registry& registry);
/// The same of all plugins that a composition names.
Provenance provenance_of(const Composition& composition, const Registry& registry);

/// `provenance` of a result document as JSON text.
std::string provenance_json(const Provenance& provenance);

/// The programs of such a text, which must be a JSON object; what it does not say is empty.
Provenance read_provenance(const std::string& json);

/// The same programs as they are here: the running kernel, and from the registry the plugins of the recorded kinds and
/// names. One that nobody offers has no file.
Provenance provenance_here(const Provenance& recorded, const Registry& registry);

/// What the two sides of a comparison are called: "sha256 ab12… then, cd34… here".
struct SideNames {
  std::string first = "then", second = "here";
};

/// In what two provenances differ, each in a sentence: versions, kernel, and of each plugin that both name the file's
/// content, its ABI, and whether there is one. Where files lie is no difference.
std::vector<std::string> provenance_differences(const Provenance& a, const Provenance& b, const SideNames& names = {});

}  // namespace bowstring
