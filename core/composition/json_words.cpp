#include "core/composition/json_words.hpp"

namespace bowstring {

using Json = nlohmann::ordered_json;

std::string shown(const Json& value) {
  if (value.is_object()) return "a table";
  if (value.is_array()) return "a list";
  constexpr std::size_t longest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > longest ? text.substr(0, longest) + "…" : text;
}

const Json* find_key(const Json& table, const std::string& key) {
  const auto found = table.find(key);
  return found != table.end() ? &*found : nullptr;
}

std::string text_of(const Json& table, const char* key) {
  const Json* found = find_key(table, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : "";
}

std::string problem_of(const Json::exception& error) {
  std::string why = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
  if (const std::size_t bracket = why.find("] "); bracket != std::string::npos) why.erase(0, bracket + 2);
  // The library quotes what it read last, which may be half a letter.
  return Json::parse(Json(why).dump(-1, ' ', true, Json::error_handler_t::replace)).get<std::string>();
}

}  // namespace bowstring
