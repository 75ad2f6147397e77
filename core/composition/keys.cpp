#include "core/composition/keys.hpp"

#include <algorithm>

#include "core/composition/nearest.hpp"

namespace bowstring {

bool contains_name(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool check_keys(const Node& table, const std::string& owner, const std::vector<std::string>& known,
                const std::string& help, Report& report) {
  return check_keys(table, owner, known, {}, help, report);
}

bool check_keys(const Node& table, const std::string& owner, const std::vector<std::string>& known,
                const std::vector<std::string>& later, const std::string& help, Report& report) {
  bool all_known = true;
  for (const Entry& entry : table.entries) {
    if (contains_name(known, entry.key)) continue;
    all_known = false;
    const std::string expected = "one of: " + comma_separated(known);
    if (contains_name(later, entry.key)) {
      report.error(entry.position, "key '" + entry.key + "' in " + owner + " is not available in this version",
                   expected, "remove it");
      continue;
    }
    const std::vector<std::string> near = nearest_names(entry.key, known);
    report.error(entry.position, "unknown key '" + entry.key + "' in " + owner, expected,
                 near.empty() ? help : did_you_mean(near));
  }
  return all_known;
}

bool check_is_table(const Node& node, const std::string& owner, const std::string& mend, Report& report) {
  if (node.is_table()) return true;
  report.error(node.position, owner + " is " + description(node), "a table", mend);
  return false;
}

}  // namespace bowstring
