#include "core/composition/resolved_toml.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// JSON's escapes are TOML's, but for one character that TOML wants escaped as well.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char letter : Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (letter == '\x7f') {
      out += "\\u007F";
    } else {
      out += letter;
    }
  }
  return out;
}

bool is_bare(const std::string& key) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), plain);
}

std::string key_text(const std::string& key) { return is_bare(key) ? key : quoted(key); }

std::string value_text(const Json& value) {
  std::string inner;
  if (value.is_object()) {
    for (const auto& [key, entry] : value.items()) {
      inner += (inner.empty() ? " " : ", ") + key_text(key) + " = " + value_text(entry);
    }
    return "{" + inner + (inner.empty() ? "}" : " }");
  }
  if (value.is_array()) {
    for (const Json& entry : value) inner += (inner.empty() ? "" : ", ") + value_text(entry);
    return "[" + inner + "]";
  }
  return value.is_string() ? quoted(value.get<std::string>()) : value.dump();
}

std::string lines(const Json& table) {
  std::string out;
  for (const auto& [key, value] : table.items()) out += key_text(key) + " = " + value_text(value) + "\n";
  return out;
}

bool is_list_of_tables(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& entry) { return entry.is_object(); });
}

}  // namespace

std::string resolved_toml(const std::string& json) {
  const Json root = Json::parse(json);
  std::string values, tables;
  for (const auto& [key, value] : root.items()) {
    if (value.is_object()) {
      tables += "\n[" + key_text(key) + "]\n" + lines(value);
    } else if (is_list_of_tables(value)) {
      for (const Json& entry : value) tables += "\n[[" + key_text(key) + "]]\n" + lines(entry);
    } else {
      values += key_text(key) + " = " + value_text(value) + "\n";
    }
  }
  return values + tables;
}

std::string toml_value(const std::string& json) { return value_text(Json::parse(json)); }

std::string path_step(const std::string& key) {
  if (!key.empty() && key.find_first_of(".='\"") == std::string::npos) return key;
  const char quote = key.find('"') == std::string::npos ? '"' : '\'';
  return quote + key + quote;
}

}  // namespace bowstring
