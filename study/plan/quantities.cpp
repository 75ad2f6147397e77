#include "study/plan/quantities.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "study/plan/axes.hpp"

namespace bowstring::study {
namespace {

using Reduction = QuantityOfInterest::Reduction;

constexpr std::array<std::pair<const char*, Reduction>, 6> reductions{{{"max", Reduction::maximum},
                                                                       {"min", Reduction::minimum},
                                                                       {"sum", Reduction::sum},
                                                                       {"mean", Reduction::mean},
                                                                       {"rms", Reduction::root_mean_square},
                                                                       {"count", Reduction::count}}};

/// Endings of the document's keys, the longest first.
constexpr std::array<std::pair<const char*, const char*>, 7> endings{{{"_N_per_mm2", "N/mm^2"},
                                                                      {"_N_per_mm", "N/mm"},
                                                                      {"_per_mm", "1/mm"},
                                                                      {"_N_mm", "N mm"},
                                                                      {"_seconds", "s"},
                                                                      {"_mm", "mm"},
                                                                      {"_N", "N"}}};

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::string last_step(const std::string& path) { return path.substr(path.rfind('.') + 1); }

std::string without_unit(const std::string& name) {
  for (const auto& [ending, unit] : endings) {
    if (ends_with(name, ending)) return name.substr(0, name.size() - std::string(ending).size());
  }
  return name;
}

class Reader {
 public:
  explicit Reader(Report& report) : report_(report) {}

  std::vector<QuantityOfInterest> read(const Entry& entry) {
    const Node& value = entry.value;
    if (value.is_list()) {
      for (const Node& item : value.items) add("", item, item.position);
    } else if (value.is_table()) {
      for (const Entry& one : value.entries) add(one.key, one.value, one.position);
    }
    if (out_.empty() && report_.empty()) {
      report_.error(value.position, "'quantities' is " + description(value) + " without a quantity",
                    "a list of paths, or a table of columns and paths",
                    "write quantities = [\"quantities.peak_displacement_mm\"]");
    }
    return std::move(out_);
  }

 private:
  void add(const std::string& name, const Node& node, const Position& position) {
    const std::string whose = name.empty() ? "a quantity" : "quantity '" + name + "'";
    QuantityOfInterest quantity;
    quantity.position = position;
    if (node.is_text()) {
      quantity.path = node.text;
    } else if (node.is_table()) {
      check_keys(node, whose, {"path", "reduce"}, "remove it", report_);
      quantity.path = node.text_at("path");
      read_reduction(node, whose, quantity);
    }
    if (quantity.path.empty()) {
      report_.error(node.position, whose + " has no path", "a path of the result document",
                    "write \"quantities.peak_displacement_mm\", or { path = \"contacts.force_N\", reduce = \"max\" }");
      return;
    }
    quantity.unit = quantity.reduction == Reduction::count ? "" : unit_of_path(quantity.path);
    quantity.column = default_column(quantity);
    if (!name.empty()) {
      const std::string suffix = unit_suffix(quantity.unit);
      quantity.column = column_name(name);
      if (!suffix.empty() && !ends_with(quantity.column, "_" + suffix)) quantity.column += "_" + suffix;
    }
    const auto same = [&](const QuantityOfInterest& other) { return other.column == quantity.column; };
    if (std::any_of(out_.begin(), out_.end(), same)) {
      report_.error(position, "two quantities have the column '" + quantity.column + "'", "a name for each",
                    "write quantities as a table: name = \"path\"");
      return;
    }
    out_.push_back(std::move(quantity));
  }

  void read_reduction(const Node& node, const std::string& whose, QuantityOfInterest& quantity) {
    const Entry* reduce = node.find("reduce");
    if (reduce == nullptr) return;
    std::vector<std::string> names;
    for (const auto& [name, reduction] : reductions) {
      names.emplace_back(name);
      if (reduce->value.is_text() && reduce->value.text == name) quantity.reduction = reduction;
    }
    if (quantity.reduction != Reduction::none) return;
    report_.error(reduce->value.position, "'reduce' of " + whose + " is " + description(reduce->value),
                  "one of: " + comma_separated(names), "write reduce = \"max\"");
  }

  Report& report_;
  std::vector<QuantityOfInterest> out_;
};

}  // namespace

const char* reduction_name(Reduction reduction) noexcept {
  for (const auto& [name, value] : reductions) {
    if (value == reduction) return name;
  }
  return "";
}

std::string default_column(const QuantityOfInterest& quantity) {
  const bool named = quantity.path.rfind("energy.", 0) == 0 || quantity.path.rfind("losses.", 0) == 0;
  const std::string name = named ? quantity.path : last_step(quantity.path);
  const std::string reduction = reduction_name(quantity.reduction);
  std::string out = column_name(without_unit(name)) + (reduction.empty() ? "" : "_" + reduction);
  if (!quantity.unit.empty()) out += "_" + unit_suffix(quantity.unit);
  return out;
}

std::string unit_of_path(const std::string& path) {
  if (path.rfind("energy.", 0) == 0) return "N mm";
  const std::string key = last_step(path);
  if (path.find("seconds.") != std::string::npos) return "s";
  if (path.rfind("certificate.", 0) == 0) {
    if (key == "stationarity" || key == "min_multiplier") return "N";
    if (key == "complementarity") return "N mm";
  }
  for (const auto& [ending, unit] : endings) {
    if (ends_with(key, ending)) return unit;
  }
  return "";
}

std::vector<QuantityOfInterest> read_quantities(const Entry* entry, Report& report) {
  if (entry != nullptr) return Reader(report).read(*entry);
  Node paths;
  paths.type = Node::Type::list;
  for (const char* path : {"quantities.peak_displacement_mm", "quantities.mean_displacement_mm",
                           "quantities.contact_force_N", "energy.total"}) {
    paths.items.push_back(text_node(path, {}));
  }
  return Reader(report).read({"quantities", {}, std::move(paths)});
}

}  // namespace bowstring::study
