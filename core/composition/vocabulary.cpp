#include "core/composition/vocabulary.hpp"

#include "core/composition/tree.hpp"

namespace bowstring {

const std::vector<std::string>& list_table_names() {
  static const std::vector<std::string> names{"vessel", "wire", "energy", "constraint", "loss", "step"};
  return names;
}

const std::vector<std::string>& single_table_names() {
  static const std::vector<std::string> names{"scene", "enforcement",  "solver",    "certificate",
                                              "start", "continuation", "multistart"};
  return names;
}

const std::vector<std::string>& top_level_names() {
  static const std::vector<std::string> names{"schema",       "title",       "base",   "plugin-path", "set",
                                              "scene",        "vessel",      "wire",   "energy",      "constraint",
                                              "loss",         "enforcement", "solver", "certificate", "start",
                                              "continuation", "multistart",  "step"};
  return names;
}

const std::vector<std::string>& overridable_names() {
  static const std::vector<std::string> names{"title",      "scene",        "vessel",      "wire",   "energy",
                                              "constraint", "loss",         "enforcement", "solver", "certificate",
                                              "start",      "continuation", "multistart",  "step"};
  return names;
}

const std::vector<std::string>& later_table_names() {
  static const std::vector<std::string> names{"residual", "readout", "axes"};
  return names;
}

std::string label_of(const Node& entry, std::string_view table) {
  if (entry.is_text()) return entry.text;
  std::string label = entry.text_at("name");
  if (label.empty()) label = entry.text_at("type");
  return label.empty() ? std::string(table) : label;
}

}  // namespace bowstring
