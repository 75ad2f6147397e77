#include "core/result/recorded_result.hpp"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/json_words.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

struct Part {
  const char* key;
  Json::value_t type;
};

/// What every document has, of whatever it is the result.
constexpr Part parts[] = {
    {"status", Json::value_t::string},      {"composition", Json::value_t::object},
    {"provenance", Json::value_t::object},  {"solver", Json::value_t::object},
    {"certificate", Json::value_t::object}, {"energy", Json::value_t::object},
    {"quantities", Json::value_t::object},  {"curves", Json::value_t::array},
    {"contacts", Json::value_t::array},     {"supports", Json::value_t::array},
    {"state", Json::value_t::object},
};

const char* type_text(Json::value_t type) {
  if (type == Json::value_t::object) return "a table";
  return type == Json::value_t::array ? "a list" : "text";
}

class ResultReader {
 public:
  ResultReader(const Json& document, const std::string& name, std::vector<DocumentFlaw>& flaws)
      : document_(document), name_(name), flaws_(flaws) {}

  void read(RecordedResult& out) {
    if (!has_format()) return;
    for (const Part& part : parts) check(document_, part, "");
    const Json& states = list(document_, "states");
    for (std::size_t k = 0; k < states.size(); ++k) {
      const std::string owner = "states." + std::to_string(k) + ".";
      if (!states[k].is_object()) {
        flaw("has " + shown(states[k]) + " as entry " + std::to_string(k) + " of 'states'", "a table");
        continue;
      }
      check(states[k], parts[1], owner);
      check(states[k], parts[2], owner);
    }
    if (!flaws_.empty()) return;
    const Json& first = states.empty() ? document_ : states.front();
    if (!states.empty() && !asked_composition(first).contains("step")) {
      flaw("has states, but a composition without 'step'", "the steps in the composition of the first state");
      return;
    }
    out.status = document_["status"].get<std::string>();
    out.composition = asked_composition(first).dump();
    out.provenance = read_provenance(document_["provenance"].dump());
    for (const Json& state : states) add_plugins(read_provenance(state["provenance"].dump()), out.provenance);
    read_start(first["provenance"], out);
    out.predecessor = text_of(table(document_, "study"), "predecessor");
  }

 private:
  void flaw(const std::string& found, const std::string& expected) {
    flaws_.push_back({name_ + " " + found, expected, name_a_written_file});
  }

  bool has_format() {
    const auto format = document_.is_object() ? document_.find("format") : document_.end();
    if (!document_.is_object() || format == document_.end()) {
      flaw("is JSON " + std::string(document_.is_object() ? "without 'format'" : "that is " + shown(document_)),
           written_by_solve);
      return false;
    }
    if (*format == result_format) return true;
    flaws_.push_back({name_ + " has format " + shown(*format), "\"" + std::string(result_format) + "\"",
                      "solve it again with this version, which reads no other"});
    return false;
  }

  void check(const Json& parent, const Part& part, const std::string& owner) {
    const auto found = parent.find(part.key);
    if (found == parent.end()) {
      flaw("has no '" + owner + part.key + "'", type_text(part.type));
    } else if (found->type() != part.type) {
      flaw("has " + shown(*found) + " as '" + owner + part.key + "'", type_text(part.type));
    }
  }

  static const Json& list(const Json& parent, const char* key) {
    static const Json none = Json::array();
    const auto found = parent.find(key);
    return found != parent.end() && found->is_array() ? *found : none;
  }
  static const Json& table(const Json& parent, const char* key) {
    static const Json none = Json::object();
    const auto found = parent.find(key);
    return found != parent.end() && found->is_object() ? *found : none;
  }

  /// A walk may have left the composition with another value than it was given.
  static const Json& asked_composition(const Json& state) {
    const Json& before = table(table(state, "continuation"), "asked_composition");
    return before.empty() ? state["composition"] : before;
  }

  static void add_plugins(const Provenance& more, Provenance& out) {
    for (const PluginProvenance& plugin : more.plugins) {
      const auto same = [&](const PluginProvenance& one) { return one.kind == plugin.kind && one.name == plugin.name; };
      if (std::none_of(out.plugins.begin(), out.plugins.end(), same)) out.plugins.push_back(plugin);
    }
  }

  static void read_start(const Json& provenance, RecordedResult& out) {
    const auto start = provenance.find("start");
    if (start == provenance.end() || !start->is_object()) return;
    out.start = StartOrigin{text_of(*start, "file"), text_of(*start, "sha256")};
  }

  const Json& document_;
  const std::string& name_;
  std::vector<DocumentFlaw>& flaws_;
};

}  // namespace

RecordedResult read_result(std::string text, const std::string& name, std::vector<DocumentFlaw>& flaws) {
  RecordedResult out;
  try {
    const Json document = Json::parse(text);
    ResultReader(document, name, flaws).read(out);
  } catch (const Json::exception& error) {
    flaws.push_back({name + " is no JSON (" + problem_of(error) + ")", written_by_solve, name_a_written_file});
  }
  out.text = std::move(text);
  return out;
}

}  // namespace bowstring
