#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "core/interfaces/registry.hpp"

namespace bowstring {

/// What every reader of a table works with.
struct Reading {
  Registry& registry;
  Report& report;
  Status& plugin_failure;  ///< the first one
  int dimension = 0;       ///< of the scene; 0 where the file does not say it

  void keep_failure(const Status& status);
};

/// Where a plugin is chosen.
struct ComponentUse {
  Kind kind = Kind::energy;
  std::string owner;                    ///< "energy 'anchoring'": the table, for messages
  std::string default_type;             ///< where `type` is left out; "" where it may not be
  std::vector<std::string> structural;  ///< the table's keys that are not the plugin's, `type` among them
  bool owner_names_type = false;        ///< `owner` is complete; else "geometry 'sinusoid' of " is put before it
};

/// Looks the `type` of a table up in the registry and reads its other keys against the plugin's schema. The
/// descriptor is null where the type is unknown or its plugin cannot be loaded.
ComponentChoice read_component(const Node& table, const ComponentUse& use, Reading& reading);

/// The plugin that stands under a key of a table: a name alone, a table with `type` and the plugin's parameters, or,
/// where the key or the `type` is left out, `default_type`. `owner` is the table's: "vessel 'iliac'".
ComponentChoice read_component_of(const Node& table, const char* key, Kind kind, const char* default_type,
                                  const std::string& owner, Reading& reading);

}  // namespace bowstring
