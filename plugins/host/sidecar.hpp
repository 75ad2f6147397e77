#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/interfaces/component.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// A component as it is known without opening its library.
struct OfferedComponent {
  Kind kind = Kind::energy;
  std::string name;
  std::string description;

  friend bool operator==(const OfferedComponent& a, const OfferedComponent& b) {
    return a.kind == b.kind && a.name == b.name && a.description == b.description;
  }
};

/// `NAME.bowstring.json`, which the build writes beside each plugin library:
///   {"file": "bowstring_NAME.so", "interface_version": 1, "abi_tag": "…",
///    "components": [{"kind": "energy", "name": "wire-bending", "description": "…"}]}
struct Sidecar {
  std::string library;  ///< absolute path; in the file relative to the sidecar
  std::uint32_t interface_version = 0;
  std::string abi_tag;
  std::vector<OfferedComponent> components;
};

inline constexpr std::string_view sidecar_suffix = ".bowstring.json";

/// `failed` with the file, what is wrong and how to mend it.
Status read_sidecar(const std::string& file, Sidecar& out);

/// Written under a temporary name and renamed, so that no reader meets half a file.
Status write_sidecar(const Sidecar& sidecar, const std::string& file);

/// A plugin that this project has, but that its build left out.
struct PluginNotBuilt {
  Kind kind = Kind::energy;
  std::string name;
  std::string option;   ///< Meson option that builds it
  std::string package;  ///< Debian package that it needs
};

/// `bowstring-plugins.json`, which the build writes beside the uninstalled binary and into the installed plugin
/// folder: {"sidecars": ["plugins/wire-bending.bowstring.json"],
///          "not_built": [{"kind": "solver", "name": "ipopt", "option": "ipopt", "package": "coinor-libipopt-dev"}]}
struct PluginList {
  std::vector<std::string> sidecars;  ///< absolute; in the file relative to it
  std::vector<PluginNotBuilt> not_built;
};

inline constexpr std::string_view plugin_list_name = "bowstring-plugins.json";

Status read_plugin_list(const std::string& file, PluginList& out);

/// The kind called `name`, as `kind_name` says it.
std::optional<Kind> kind_called(std::string_view name);

}  // namespace bowstring
