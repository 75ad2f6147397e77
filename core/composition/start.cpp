#include "core/composition/start.hpp"

#include <filesystem>

#include "core/composition/keys.hpp"
#include "core/composition/read_file.hpp"

namespace bowstring {
namespace {

/// Whether the state becomes the rest state.
bool read_rest(const Node& table, Report& report) {
  const Entry* rest = table.find("rest");
  if (rest == nullptr) return false;
  const Node& value = rest->value;
  if (value.is_text() && (value.text == "state-1" || value.text == "previous")) return value.text == "previous";
  report.error(value.position, "'rest' of [start] is " + description(value), "one of: state-1, previous",
               "write rest = \"previous\" where the state that it starts from is without stress in the vessels");
  return false;
}

}  // namespace

StartTable read_start(const Node& root, bool from_memory, Report& report) {
  StartTable start;
  const Entry* entry = root.find("start");
  if (entry == nullptr) return start;
  const Node& table = entry->value;
  const std::string mend = "write [start] with from = \"result.json\"";
  if (!check_is_table(table, "'start'", mend, report)) return start;
  check_keys(table, "[start]", {"from", "rest"}, "remove it", report);
  start.rest_is_previous = read_rest(table, report);
  const Entry* from = table.find("from");
  if (from == nullptr && from_memory) return start;
  if (from == nullptr) {
    report.error(table.position, "[start] has no 'from'", "a result document to start from",
                 "add from = \"result.json\", or remove the table");
    return start;
  }
  const Node& value = from->value;
  if (!value.is_text() || value.text.empty()) {
    report.error(value.position, "'from' of [start] is " + description(value), "text, the path of a result document",
                 "write from = \"result.json\"");
    return start;
  }
  const std::filesystem::path written(value.text);
  start.from =
      value.position.source ? (value.position.source->directory / written).lexically_normal().string() : value.text;
  start.position = value.position.text();
  start.name = "the start '" + value.text + "'";
  if (from_memory) return start;
  std::string text;
  if (const std::string why = read_file(start.from, text); !why.empty()) {
    const bool by_override = value.position.source != nullptr && value.position.line == 0;
    report.error(value.position, "cannot read " + start.name + " (" + why + ")",
                 "a result document, as `bowstring solve --out` writes it",
                 by_override ? "paths of --set are relative to the working directory"
                             : "paths are relative to the file that they stand in");
    return start;
  }
  std::vector<DocumentFlaw> flaws;
  start.state = std::make_shared<const RecordedState>(read_recorded_state(text, start.name, flaws));
  for (const DocumentFlaw& flaw : flaws) report.error(value.position, flaw.found, flaw.expected, flaw.mend);
  return start;
}

}  // namespace bowstring
