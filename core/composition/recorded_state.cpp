#include "core/composition/recorded_state.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/composition/sha256.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* written_by_solve = "a result document, as `bowstring solve --out` writes it";

/// What stands there, short enough for a message.
std::string shown(const Json& value) {
  if (value.is_object()) return "a table";
  if (value.is_array()) return "a list";
  constexpr std::size_t longest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > longest ? text.substr(0, longest) + "…" : text;
}

class StateReader {
 public:
  StateReader(const Json& document, const std::string& name, std::vector<DocumentFlaw>& flaws)
      : document_(document), name_(name), flaws_(flaws) {}

  RecordedState read() {
    RecordedState out;
    if (!has_format()) return out;
    const Json* state = table_of(document_, "state", "");
    if (state == nullptr) return out;
    if (const Json* fields = table_of(*state, "fields", "state.")) read_numbers(*fields, "field", out.fields);
    if (const Json* groups = table_of(*state, "multipliers", "state.")) {
      read_numbers(*groups, "multipliers", out.multipliers);
    }
    read_manifolds(out.fields);
    return out;
  }

 private:
  void flaw(const std::string& found, const std::string& expected, const std::string& mend) {
    flaws_.push_back({name_ + " " + found, expected, mend});
  }

  bool has_format() {
    const auto format = document_.is_object() ? document_.find("format") : document_.end();
    if (format == document_.end()) {
      flaw("has no 'format'", written_by_solve, "name a file that was written with --out");
      return false;
    }
    if (*format == result_format) return true;
    flaw("has format " + shown(*format), "\"" + std::string(result_format) + "\"",
         "solve it again with this version, which reads no other");
    return false;
  }

  const Json* table_of(const Json& parent, const char* key, const std::string& path) {
    const auto found = parent.find(key);
    if (found != parent.end() && found->is_object()) return &*found;
    flaw((found == parent.end() ? "has no '" + path + key + "'" : "has " + shown(*found) + " as '" + path + key + "'"),
         "a table of numbers by name", "name a file that was written with --out");
    return nullptr;
  }

  void read_numbers(const Json& table, const char* kind, std::vector<NamedNumbers>& out) {
    for (const auto& [name, list] : table.items()) {
      const std::string owner = std::string(kind) + " '" + name + "'";
      NamedNumbers numbers;
      numbers.name = name;
      if (!list.is_array()) {
        flaw("has " + shown(list) + " as " + owner, "a list of numbers", "name a file that was written with --out");
        continue;
      }
      for (const Json& entry : list) {
        const double value = entry.is_number() ? entry.get<double>() : std::nan("");
        if (!std::isfinite(value)) {
          flaw("has " + shown(entry) + " as number " + std::to_string(numbers.values.size()) + " of " + owner,
               "finite numbers", "start from a result whose state is known");
          break;
        }
        numbers.values.push_back(value);
      }
      if (numbers.values.size() == list.size()) out.push_back(std::move(numbers));
    }
  }

  /// A direction and a rotation both store four numbers, with another meaning.
  void read_manifolds(std::vector<NamedNumbers>& fields) const {
    const Json none = Json::array();
    const auto problem = document_.find("problem");
    const Json& declared =
        problem != document_.end() && problem->is_object() && problem->contains("fields") ? (*problem)["fields"] : none;
    for (const Json& field : declared) {
      if (!field.is_object() || !field.contains("name") || !field.contains("manifold")) continue;
      for (NamedNumbers& numbers : fields) {
        if (field["name"] == numbers.name && field["manifold"].is_string()) {
          numbers.manifold = field["manifold"].get<std::string>();
        }
      }
    }
  }

  const Json& document_;
  const std::string& name_;
  std::vector<DocumentFlaw>& flaws_;
};

}  // namespace

RecordedState read_recorded_state(const std::string& text, const std::string& name, std::vector<DocumentFlaw>& flaws) {
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::exception& error) {
    std::string why = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
    if (const std::size_t bracket = why.find("] "); bracket != std::string::npos) why.erase(0, bracket + 2);
    flaws.push_back({name + " is no JSON (" + why + ")", written_by_solve, "name a file that was written with --out"});
    return {};
  }
  RecordedState out = StateReader(document, name, flaws).read();
  out.sha256 = sha256_hex(text);
  return out;
}

}  // namespace bowstring
