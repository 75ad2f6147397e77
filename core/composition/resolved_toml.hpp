#pragma once

#include <string>

namespace bowstring {

/// A resolved composition (JSON text, core/composition/resolved.hpp) as the TOML text that `load_composition` reads:
/// it resolves to the same JSON, byte for byte. The text must be a JSON object.
std::string resolved_toml(const std::string& json);

/// A value of a composition, JSON text, as TOML writes it on one line: what an override takes.
std::string toml_value(const std::string& json);

/// A step of a path, in quotes where it could not stand without them.
std::string path_step(const std::string& key);

}  // namespace bowstring
