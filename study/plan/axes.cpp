#include "study/plan/axes.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/read_value_range.hpp"
#include "core/composition/toml_text.hpp"
#include "core/composition/units.hpp"
#include "study/plan/samples.hpp"

namespace bowstring::study {
namespace {

namespace fs = std::filesystem;

constexpr long most_alternatives = 1000000;

/// How an axis says its alternatives.
const std::vector<std::string>& form_names() {
  static const std::vector<std::string> names{"values", "linear",         "log", "alternatives", "base",
                                              "sobol",  "latin-hypercube"};
  return names;
}

/// A number as a value of a composition reads it back, with its unit.
std::string quantity_value(double number, const std::string& unit, bool whole) {
  const std::string digits = whole ? std::to_string(static_cast<long>(number)) : decimal(number);
  return unit.empty() ? digits : "\"" + digits + " " + unit + "\"";
}

std::string with_unit(const std::string& digits, const std::string& unit) {
  return unit.empty() ? digits : digits + " " + unit;
}

std::string quantity_label(double number, const std::string& unit) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", number);
  return with_unit(digits, unit);
}

/// The number and unit that a value is; empty where it is none.
std::optional<Quantity> number_with_unit(const Node& node) {
  if (node.type == Node::Type::integer) return Quantity{static_cast<double>(node.integer), ""};
  if (node.type == Node::Type::number) return Quantity{node.number, ""};
  return node.is_text() ? split_quantity(node.text) : std::nullopt;
}

/// The number of a quantity in `unit`; empty where it does not convert.
std::optional<double> in_unit(const Quantity& quantity, const std::string& unit) {
  if (quantity.unit == unit) return quantity.number;
  if (quantity.unit.empty() || unit.empty()) return std::nullopt;
  const UnitConversion conversion = convert_unit(quantity.unit, unit);
  if (conversion.outcome != UnitOutcome::converted) return std::nullopt;
  return conversion(quantity.number);
}

std::string label_of_value(const Node& value) {
  if (value.is_text()) return value.text;
  if (value.is_table() && !value.text_at("type").empty()) return value.text_at("type");
  return toml_value(value);
}

/// Reads one entry of [axes].
class AxisReader {
 public:
  AxisReader(const Entry& entry, const std::string& study_file, Report& report)
      : name_(entry.key), position_(entry.position), table_(entry.value), study_file_(study_file), report_(report) {}

  void read(std::vector<Axis>& axes, std::vector<AxisGroup>& groups) {
    const std::size_t before = axes.size();
    const std::string* form = find_form();
    if (form == nullptr) return;
    const Entry& what = *table_.find(*form);
    int count = 0;
    if (*form == "sobol" || *form == "latin-hypercube") {
      count = read_sample(what, axes);
    } else {
      Axis axis = started(name_);
      if (*form == "values") {
        read_values(what.value, axis);
      } else if (*form == "alternatives") {
        read_alternatives(what.value, axis);
      } else if (*form == "base") {
        read_bases(what.value, axis);
      } else {
        read_range(what, *form == "log", axis);
      }
      count = static_cast<int>(axis.data.label.size());
      if (count > 0) axes.push_back(std::move(axis));
    }
    if (axes.size() == before || count == 0) return;
    AxisGroup group;
    group.count = count;
    for (std::size_t k = before; k < axes.size(); ++k) {
      finish(axes[k]);
      group.axes.push_back(static_cast<int>(k));
    }
    groups.push_back(std::move(group));
  }

 private:
  std::string owner() const { return "axis '" + name_ + "'"; }

  void fail(const Position& position, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(position, found, expected, mend);
  }

  const std::string* find_form() {
    if (!check_is_table(table_, owner(),
                        "write it as in T = { path = \"energy.axial-tension.tension\", values = [5, 10] }", report_)) {
      return nullptr;
    }
    std::vector<const std::string*> found;
    for (const std::string& form : form_names()) {
      if (table_.find(form) != nullptr) found.push_back(&form);
    }
    if (found.size() != 1) {
      fail(found.size() > 1 ? table_.find(*found[1])->position : position_,
           owner() +
               (found.empty() ? " does not say its values" : " has both '" + *found[0] + "' and '" + *found[1] + "'"),
           "one of: " + comma_separated(form_names()), found.empty() ? "add one of them" : "leave one of them");
      return nullptr;
    }
    const std::string& form = *found.front();
    std::vector<std::string> known{form};
    const bool sample = form == "sobol" || form == "latin-hypercube";
    if (form == "values" || form == "linear" || form == "log") known.emplace_back("path");
    if (form == "values") known.emplace_back("labels");
    if (form == "linear" || form == "log" || sample) known.emplace_back("count");
    if (sample) known.emplace_back("seed");
    check_keys(table_, owner(), known, "remove it", report_);
    return found.front();
  }

  Axis started(const std::string& name) const {
    Axis axis;
    axis.data.name = name;
    axis.position = position_.text();
    return axis;
  }

  std::vector<std::string> read_paths(const Node& table, const std::string& whose, const Position& place) {
    const Entry* entry = table.find("path");
    if (entry == nullptr) {
      fail(place, whose + " has no 'path'", "the path of what it sets",
           "add path = \"energy.axial-tension.tension\", as --set takes it");
      return {};
    }
    const std::vector<Node> single{entry->value};
    std::vector<std::string> paths;
    for (const Node& item : entry->value.is_list() ? entry->value.items : single) {
      if (item.is_text() && !item.text.empty()) {
        paths.push_back(item.text);
      } else {
        fail(item.position, "'path' of " + whose + " is " + description(item), "text, or a list of texts",
             "write path = \"energy.axial-tension.tension\"");
      }
    }
    return paths;
  }

  Override change(const std::string& path, const std::string& value, const Position& position) const {
    return {path, value, position.text(), position.source ? position.source->directory.string() : "", false};
  }

  void add(Axis& axis, const std::string& label, std::vector<Override> overrides, std::string base = "") const {
    axis.data.label.push_back(label);
    axis.overrides.push_back(std::move(overrides));
    axis.base.push_back(std::move(base));
  }

  void read_values(const Node& values, Axis& axis) {
    const std::vector<std::string> paths = read_paths(table_, owner(), position_);
    if (!values.is_list() || values.items.empty()) {
      fail(values.position,
           "'values' of " + owner() + " is " + (values.is_list() ? "an empty list" : description(values)),
           "a list of values", "write values = [first, second]");
      return;
    }
    for (const Node& value : values.items) {
      std::vector<Override> overrides;
      for (const std::string& path : paths) overrides.push_back(change(path, toml_value(value), value.position));
      add(axis, label_of_value(value), std::move(overrides));
    }
    axis.data.paths = paths;
    if (!distinct(axis.data.label)) {
      for (std::size_t i = 0; i < values.items.size(); ++i) axis.data.label[i] = toml_value(values.items[i]);
    }
    read_labels(values.items.size(), axis);
    read_numbers(values.items, axis);
    check_distinct(values, axis);
  }

  void read_labels(std::size_t count, Axis& axis) {
    const Entry* labels = table_.find("labels");
    if (labels == nullptr) return;
    const bool texts = labels->value.is_list() && labels->value.items.size() == count &&
                       std::all_of(labels->value.items.begin(), labels->value.items.end(),
                                   [](const Node& item) { return item.is_text() && !item.text.empty(); });
    if (!texts) {
      fail(labels->value.position, "'labels' of " + owner() + " does not name its values one by one",
           "a list of " + std::to_string(count) + " texts", "write one for each value, or leave 'labels' out");
      return;
    }
    for (std::size_t i = 0; i < count; ++i) axis.data.label[i] = labels->value.items[i].text;
  }

  /// Values that are all numbers of one kind make the axis numeric.
  void read_numbers(const std::vector<Node>& values, Axis& axis) {
    std::vector<double> numbers;
    std::string unit;
    for (const Node& value : values) {
      const std::optional<Quantity> quantity = number_with_unit(value);
      if (!quantity) return;
      if (numbers.empty()) unit = quantity->unit;
      const std::optional<double> number = in_unit(*quantity, unit);
      if (!number) return;
      numbers.push_back(*number);
    }
    axis.data.number = std::move(numbers);
    axis.data.unit = std::move(unit);
  }

  static bool distinct(std::vector<std::string> labels) {
    std::sort(labels.begin(), labels.end());
    return std::adjacent_find(labels.begin(), labels.end()) == labels.end();
  }

  void check_distinct(const Node& values, const Axis& axis) {
    std::vector<double> numbers = axis.data.number;
    std::sort(numbers.begin(), numbers.end());
    const bool same_number = std::adjacent_find(numbers.begin(), numbers.end()) != numbers.end();
    if (distinct(axis.data.label) && !same_number) return;
    fail(values.position, owner() + " has a value twice", "values that differ", "leave one of them");
  }

  void read_alternatives(const Node& alternatives, Axis& axis) {
    if (!alternatives.is_table() || alternatives.entries.empty()) {
      fail(alternatives.position,
           "'alternatives' of " + owner() + " is " + (alternatives.is_table() ? "empty" : description(alternatives)),
           "a table of named overrides",
           "write alternatives = { soft = { \"energy.anchoring.stiffness\" = \"0.01 N/mm^2\" }, … }");
      return;
    }
    for (const Entry& alternative : alternatives.entries) {
      const std::string whose = "alternative '" + alternative.key + "' of " + owner();
      if (!check_is_table(alternative.value, whose, "write { \"path\" = value }; { } changes nothing", report_))
        continue;
      std::vector<Override> overrides;
      std::string base;
      for (const Entry& entry : alternative.value.entries) {
        if (entry.key == "base") {
          base = read_base(entry.value, whose);
          continue;
        }
        overrides.push_back(change(entry.key, toml_value(entry.value), entry.position));
        if (!contains_name(axis.data.paths, entry.key)) axis.data.paths.push_back(entry.key);
      }
      add(axis, alternative.key, std::move(overrides), std::move(base));
    }
  }

  std::string read_base(const Node& node, const std::string& whose) {
    if (node.is_text() && !node.text.empty()) {
      return (fs::path(study_file_).parent_path() / node.text).lexically_normal().string();
    }
    fail(node.position, "'base' of " + whose + " is " + description(node), "a composition file",
         "write base = \"scene.toml\"");
    return "";
  }

  void read_bases(const Node& bases, Axis& axis) {
    if (bases.is_table() && !bases.entries.empty()) {
      for (const Entry& entry : bases.entries) add(axis, entry.key, {}, read_base(entry.value, owner()));
    } else if (bases.is_list() && !bases.items.empty()) {
      for (const Node& item : bases.items) add(axis, fs::path(item.text).stem().string(), {}, read_base(item, owner()));
    } else {
      fail(bases.position, "'base' of " + owner() + " has no composition", "a list, or a table of names and files",
           "write base = [\"first.toml\", \"second.toml\"]");
    }
    check_distinct(bases, axis);
  }

  int read_count(const Node& table, const std::string& whose, long least, const Position& place) {
    const Entry* entry = table.find("count");
    if (entry == nullptr) {
      fail(place, whose + " has no 'count'", "how many values", "add count = " + std::to_string(std::max(least, 5L)));
      return 0;
    }
    const Node& count = entry->value;
    if (count.type == Node::Type::integer && count.integer >= least && count.integer <= most_alternatives) {
      return static_cast<int>(count.integer);
    }
    fail(count.position, "'count' of " + whose + " is " + description(count),
         "a whole number from " + std::to_string(least) + " to " + std::to_string(most_alternatives),
         "write count = " + std::to_string(std::max(least, 5L)));
    return 0;
  }

  std::optional<ValueRange> read_ends(const Entry& form, const std::string& whose) {
    const Node& ends = form.value;
    if (!ends.is_list() || ends.items.size() != 2) {
      fail(ends.position,
           "'" + form.key + "' of " + whose + " is " +
               (ends.is_list() ? "a list of " + std::to_string(ends.items.size()) : description(ends)),
           "a list of two values, the first and the last", "write " + form.key + " = [\"1 N\", \"20 N\"]");
      return std::nullopt;
    }
    const Entry from{form.key, form.position, ends.items[0]}, to{form.key, form.position, ends.items[1]};
    std::optional<ValueRange> range = read_value_range(from, to, form.key == "log", whose, report_);
    if (range && range->list) {
      fail(ends.position, "'" + form.key + "' of " + whose + " has lists", "two numbers or quantities",
           "give the lists under 'values'");
      return std::nullopt;
    }
    return range;
  }

  /// Whole steps stay whole: 8, not 8.000000000000002.
  static double at(const ValueRange& range, int i, int last) {
    const double from = range.from.front(), to = range.to.front();
    if (i == 0) return from;
    if (i == last) return to;
    const double value = range.logarithmic ? from * std::pow(to / from, static_cast<double>(i) / last)
                                           : (from * (last - i) + to * i) / last;
    return range.whole ? std::round(value) : value;
  }

  void read_range(const Entry& form, bool logarithmic, Axis& axis) {
    axis.data.paths = read_paths(table_, owner(), position_);
    const int count = read_count(table_, owner(), 2, position_);
    const std::optional<ValueRange> range = read_ends(form, owner());
    if (count == 0 || !range) return;
    axis.data.unit = range->unit;
    axis.data.spacing = logarithmic ? Spacing::logarithmic : Spacing::linear;
    for (int i = 0; i < count; ++i) add_number(axis, at(*range, i, count - 1), range->whole, form.value.position);
    if (!distinct(axis.data.label)) {  // six digits do not tell them apart
      for (std::size_t i = 0; i < axis.data.label.size(); ++i) {
        axis.data.label[i] = with_unit(decimal(axis.data.number[i]), axis.data.unit);
      }
    }
    check_distinct(form.value, axis);
  }

  void add_number(Axis& axis, double number, bool whole, const Position& position) const {
    std::vector<Override> overrides;
    const std::string value = quantity_value(number, axis.data.unit, whole);
    for (const std::string& path : axis.data.paths) overrides.push_back(change(path, value, position));
    axis.data.number.push_back(number);
    add(axis, quantity_label(number, axis.data.unit), std::move(overrides));
  }

  std::uint64_t read_seed() {
    const Entry* entry = table_.find("seed");
    if (entry == nullptr) return 1;
    if (entry->value.type == Node::Type::integer && entry->value.integer >= 0) {
      return static_cast<std::uint64_t>(entry->value.integer);
    }
    fail(entry->value.position, "'seed' of " + owner() + " is " + description(entry->value),
         "a whole number of at least 0", "write seed = 1");
    return 1;
  }

  int read_sample(const Entry& form, std::vector<Axis>& axes) {
    const int count = read_count(table_, owner(), 1, position_);
    const std::uint64_t seed = read_seed();
    if (!form.value.is_table() || form.value.entries.empty()) {
      fail(
          form.value.position, "'" + form.key + "' of " + owner() + " has no numbers",
          "a table of names, each with path and linear or log",
          "write " + form.key + " = { T = { path = \"energy.axial-tension.tension\", linear = [\"5 N\", \"15 N\"] } }");
      return 0;
    }
    std::vector<Axis> sampled;
    std::vector<ValueRange> ranges;
    for (const Entry& entry : form.value.entries) {
      if (!read_sampled(entry, sampled, ranges)) return 0;
    }
    if (count == 0) return 0;
    const int width = static_cast<int>(sampled.size());
    const std::vector<double> points =
        form.key == "sobol" ? sobol_points(count, width, seed) : latin_hypercube_points(count, width, seed);
    for (std::size_t k = 0; k < sampled.size(); ++k) {
      for (int i = 0; i < count; ++i) {
        const double share = points[static_cast<std::size_t>(i * width) + k];
        add_number(sampled[k], ranges[k].at(share).front(), ranges[k].whole, form.value.entries[k].value.position);
      }
      axes.push_back(std::move(sampled[k]));
    }
    return count;
  }

  bool read_sampled(const Entry& entry, std::vector<Axis>& sampled, std::vector<ValueRange>& ranges) {
    const std::string whose = "'" + entry.key + "' of " + owner();
    if (!check_is_table(entry.value, whose, "write { path = \"…\", linear = [from, to] }", report_)) return false;
    check_keys(entry.value, whose, {"path", "linear", "log"}, "remove it", report_);
    const Entry* linear = entry.value.find("linear");
    const Entry* log = entry.value.find("log");
    if ((linear == nullptr) == (log == nullptr)) {
      fail(entry.position, whose + (linear == nullptr ? " has no range" : " has two ranges"), "one of: linear, log",
           "write linear = [from, to]");
      return false;
    }
    Axis axis = started(entry.key);
    axis.data.spacing = Spacing::sampled;
    axis.data.paths = read_paths(entry.value, whose, entry.position);
    const std::optional<ValueRange> range = read_ends(linear != nullptr ? *linear : *log, whose);
    if (!range || axis.data.paths.empty()) return false;
    axis.data.unit = range->unit;
    ranges.push_back(*range);
    sampled.push_back(std::move(axis));
    return true;
  }

  static void finish(Axis& axis) {
    AxisData& data = axis.data;
    data.column = column_name(data.name) + (data.unit.empty() ? "" : "_" + unit_suffix(data.unit));
  }

  const std::string& name_;
  const Position& position_;
  const Node& table_;
  const std::string& study_file_;
  Report& report_;
};

}  // namespace

void read_axes(const Node& table, const std::string& study_file, std::vector<Axis>& axes,
               std::vector<AxisGroup>& groups, Report& report) {
  for (const Entry& entry : table.entries) AxisReader(entry, study_file, report).read(axes, groups);
}

int find_axis(const std::vector<Axis>& axes, const std::string& name, const Position& position,
              const std::string& whose, Report& report) {
  std::vector<std::string> known;
  for (const Axis& axis : axes) {
    if (axis.data.name == name) return static_cast<int>(&axis - axes.data());
    known.push_back(axis.data.name);
  }
  const std::vector<std::string> near = nearest_names(name, known);
  report.error(position, whose + " names the axis '" + name + "', which there is not",
               "one of: " + comma_separated(known), near.empty() ? "name an axis of this study" : did_you_mean(near));
  return -1;
}

int find_alternative(const Axis& axis, const Node& value) {
  const std::string label = label_of_value(value);
  for (std::size_t i = 0; i < axis.data.label.size(); ++i) {
    if (axis.data.label[i] == label) return static_cast<int>(i);
  }
  const std::optional<Quantity> quantity = number_with_unit(value);
  const std::optional<double> number = quantity ? in_unit(*quantity, axis.data.unit) : std::nullopt;
  for (std::size_t i = 0; number && i < axis.data.number.size(); ++i) {
    if (std::abs(axis.data.number[i] - *number) <= 1e-9 * std::abs(*number)) return static_cast<int>(i);
  }
  return -1;
}

std::string column_name(const std::string& name) {
  std::string out;
  for (const char letter : name) out += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  return out;
}

std::string unit_suffix(const std::string& unit) {
  if (unit == "s") return "seconds";  // what may differ between two solves of a run ends with it
  std::string out;
  bool per = false;
  for (const char letter : ascii_unit(unit)) {
    if (letter == '/') {
      out += per ? "_" : "_per_";
      per = true;
    } else if (letter == ' ' || letter == '*' || letter == '.') {
      out += '_';
    } else if (std::isalnum(static_cast<unsigned char>(letter)) != 0) {
      out += letter;
    }
  }
  return out.rfind("1_per_", 0) == 0 ? out.substr(2) : out;
}

}  // namespace bowstring::study
