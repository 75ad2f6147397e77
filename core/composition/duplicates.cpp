#include "core/composition/duplicates.hpp"

#include <map>
#include <string>
#include <vector>

#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

struct Named {
  std::string table;
  const Node* entry;
};

/// What a table is called by: its name, or else the type of a term. A vessel has no other name.
bool has_label(const Node& entry, const std::string& table) {
  return entry.find("name") != nullptr || entry.find("type") != nullptr || table == "wire" || table == "loss";
}

void check_names_of(const Node& root, const std::vector<std::string>& tables, Report& report) {
  std::map<std::string, Named> named;
  for (const std::string& table : tables) {
    const Entry* list = root.find(table);
    if (list == nullptr) continue;
    for (const Node& entry : list->value.items) {
      if (!has_label(entry, table)) continue;
      const std::string label = label_of(entry, table);
      const auto [first, added] = named.emplace(label, Named{table, &entry});
      if (added) continue;
      const Entry* name = entry.find("name");
      report.error(name != nullptr ? name->value.position : entry.position,
                   "duplicate name: " + table + " '" + label + "', after the " + first->second.table + " at " +
                       first->second.entry->position.text(),
                   "a name for each", name != nullptr ? "rename one of the two" : "add name = \"<name>\" to each");
    }
  }
}

}  // namespace

void check_duplicates(const Node& root, Report& report) {
  check_names_of(root, {"vessel", "wire"}, report);
  check_names_of(root, {"energy"}, report);
  check_names_of(root, {"constraint"}, report);
  check_names_of(root, {"loss"}, report);
}

}  // namespace bowstring
