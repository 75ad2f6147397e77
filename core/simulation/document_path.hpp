#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace bowstring {

/// What a path leads to: one value, or, where it names a key behind a list, that key's value in every entry.
struct Selection {
  std::vector<const nlohmann::ordered_json*> values;
  bool of_every_entry = false;
};

/// Follows a path from the root of a document; "" is the root itself. Returns "", or what was wrong with the path.
std::string follow_path(const nlohmann::ordered_json& root, const std::string& path, Selection& out);

/// The `name` of a list's entry, or else its `type`; "" without both.
std::string entry_label(const nlohmann::ordered_json& entry);

/// "null", "text", "a list of 80", "a table", for messages.
std::string json_description(const nlohmann::ordered_json& value);

}  // namespace bowstring
