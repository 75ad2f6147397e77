#include "study/plan/study_file.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/read_file.hpp"
#include "core/composition/report.hpp"
#include "core/composition/toml_text.hpp"
#include "core/composition/units.hpp"
#include "study/plan/axes.hpp"
#include "study/plan/quantities.hpp"
#include "study/plan/references.hpp"

namespace bowstring::study {
namespace {

namespace fs = std::filesystem;

constexpr long schema_version = 1;
constexpr long most_repeats = 1000;

const std::vector<std::string>& study_keys() {
  static const std::vector<std::string> names{
      "schema",    "title",      "base",  "set",          "axes",       "combine", "zipped",     "exclude", "repeats",
      "reference", "quantities", "along", "target-error", "warm-along", "reduced", "time-limit", "cases"};
  return names;
}

const std::vector<std::string>& reducible_keys() {
  static const std::vector<std::string> names{"set",    "axes",      "exclude",      "repeats",
                                              "zipped", "reference", "target-error", "time-limit"};
  return names;
}

/// What [reduced] says instead: axes and overrides one by one, everything else whole.
void reduce(Node& root, Report& report) {
  const Entry* entry = root.find("reduced");
  if (entry == nullptr) {
    report.error(root.position, "the study has no [reduced], which --reduced asks for", "a table [reduced]",
                 "add [reduced.axes] with the axes that are shorter, or leave --reduced out");
    return;
  }
  const Node table = entry->value;
  if (!check_is_table(table, "'reduced'", "write [reduced.axes] with the axes that are shorter", report)) return;
  check_keys(table, "[reduced]", reducible_keys(), "remove it", report);
  for (const Entry& instead : table.entries) {
    Entry* present = root.find(instead.key);
    const bool by_entry = instead.key == "axes" || instead.key == "set";
    if (by_entry && present != nullptr && present->value.is_table() && instead.value.is_table()) {
      for (const Entry& one : instead.value.entries) present->value.set(one);
    } else {
      root.set(instead);
    }
  }
}

class StudyReader {
 public:
  StudyReader(const std::string& file, const Node& root, Report& report) : root_(root), report_(report) {
    out_.file = file;
    out_.name = fs::path(file).stem().string();
  }

  StudyFile read() {
    check_keys(root_, "the study", study_keys(), "remove it", report_);
    check_schema();
    out_.title = text_at("title");
    read_set();
    read_all_axes();
    read_base();
    read_combination();
    read_exclusions();
    read_cases();
    out_.repeats = static_cast<int>(whole_at("repeats", 1, most_repeats, 1));
    out_.target_error = number_at("target-error", "", 0.01);
    out_.time_limit = number_at("time-limit", "s", 0.0);
    out_.warm_along = axis_at("warm-along");
    read_along();
    out_.quantities = read_quantities(root_.find("quantities"), report_);
    out_.reference = read_reference(root_.find("reference"), out_, report_);
    check_columns();
    return std::move(out_);
  }

 private:
  void fail(const Position& position, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(position, found, expected, mend);
  }

  void check_schema() {
    const Entry* schema = root_.find("schema");
    if (schema != nullptr && schema->value.type == Node::Type::integer && schema->value.integer == schema_version)
      return;
    fail(schema == nullptr ? root_.position : schema->value.position,
         schema == nullptr ? "the study has no 'schema'" : "'schema' is " + description(schema->value), "1",
         "write schema = 1 at the top");
  }

  std::string text_at(const std::string& key) {
    const Entry* entry = root_.find(key);
    if (entry == nullptr) return "";
    if (!entry->value.is_text()) {
      fail(entry->value.position, "'" + key + "' is " + description(entry->value), "text", "write it in quotes");
    }
    return entry->value.text;
  }

  long whole_at(const std::string& key, long least, long most, long otherwise) {
    const Entry* entry = root_.find(key);
    if (entry == nullptr) return otherwise;
    const Node& value = entry->value;
    if (value.type == Node::Type::integer && value.integer >= least && value.integer <= most) return value.integer;
    fail(value.position, "'" + key + "' is " + description(value),
         "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
         "write " + key + " = " + std::to_string(otherwise));
    return otherwise;
  }

  /// A number above 0, or a quantity in `unit`.
  double number_at(const std::string& key, const std::string& unit, double otherwise) {
    const Entry* entry = root_.find(key);
    if (entry == nullptr) return otherwise;
    const Node& value = entry->value;
    double number = -1.0;
    if (value.type == Node::Type::integer) number = static_cast<double>(value.integer);
    if (value.type == Node::Type::number) number = value.number;
    if (const std::optional<Quantity> quantity = value.is_text() ? split_quantity(value.text) : std::nullopt) {
      const UnitConversion conversion = convert_unit(quantity->unit, unit);
      if (conversion.outcome == UnitOutcome::converted) number = conversion(quantity->number);
    }
    if (number > 0.0) return number;
    fail(value.position, "'" + key + "' is " + description(value),
         unit.empty() ? "a number above 0" : "a number or quantity in " + unit + ", above 0",
         unit.empty() ? "write " + key + " = 0.01" : "write " + key + " = \"60 " + unit + "\"");
    return otherwise;
  }

  Override change(const Entry& entry) const {
    const Position& position = entry.value.position;
    return {entry.key, toml_value(entry.value), position.text(),
            position.source ? position.source->directory.string() : "", false};
  }

  void read_set() {
    const Entry* set = root_.find("set");
    if (set == nullptr) return;
    if (!check_is_table(set->value, "'set'", "write [set] with lines like \"solver.tolerance\" = 1e-9", report_))
      return;
    for (const Entry& entry : set->value.entries) {
      if (entry.value.is_table() && !entry.value.inline_table) {
        fail(entry.position, "'" + entry.key + "' in [set] opens a table",
             "a whole path in quotes, with a value or an inline table { … }",
             "write it as in \"solver.tolerance\" = 1e-9");
      } else {
        out_.set.push_back(change(entry));
      }
    }
  }

  void read_all_axes() {
    const Entry* axes = root_.find("axes");
    if (axes == nullptr || (axes->value.is_table() && axes->value.entries.empty())) {
      fail(axes == nullptr ? root_.position : axes->position, "the study has no axis",
           "a table [axes] with at least one",
           "add [axes] with T = { path = \"energy.axial-tension.tension\", values = [\"5 N\", \"10 N\"] }");
      return;
    }
    if (!check_is_table(axes->value, "'axes'", "write [axes]", report_)) return;
    read_axes(axes->value, out_.file, out_.axes, out_.groups, report_);
    for (const Entry& entry : axes->value.entries) axis_positions_.push_back({entry.key, entry.position});
    check_paths();
  }

  Position position_of(const Axis& axis) const {
    for (const auto& [name, position] : axis_positions_) {
      if (position.text() == axis.position) return position;
    }
    return root_.position;
  }

  /// A later axis that sets what holds an earlier one's path would undo it.
  void check_paths() {
    for (std::size_t a = 0; a < out_.axes.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        for (const std::string& later : out_.axes[a].data.paths) {
          for (const std::string& earlier : out_.axes[b].data.paths) {
            const bool around = earlier.rfind(later + ".", 0) == 0;
            if (later != earlier && !around) continue;
            fail(position_of(out_.axes[a]),
                 "axes '" + out_.axes[b].data.name + "' and '" + out_.axes[a].data.name + "' both set '" + later + "'" +
                     (around ? ", the second one undoing '" + earlier + "'" : ""),
                 "one axis for each path",
                 around ? "write '" + out_.axes[a].data.name + "' first"
                        : "leave one of them, or zip their values into one");
          }
        }
      }
    }
  }

  void read_base() {
    const Entry* base = root_.find("base");
    if (base != nullptr) {
      const std::string written = text_at("base");
      if (!written.empty()) out_.base = (fs::path(out_.file).parent_path() / written).lexically_normal().string();
      return;
    }
    const auto every = [](const Axis& axis) {
      return std::none_of(axis.base.begin(), axis.base.end(), [](const std::string& file) { return file.empty(); });
    };
    if (!out_.axes.empty() && std::none_of(out_.axes.begin(), out_.axes.end(), every) && report_.empty()) {
      fail(root_.position, "the study has no 'base'", "the composition that its axes change",
           "add base = \"scene.toml\"");
    }
  }

  int axis_called(const std::string& name, const Position& position, const std::string& whose) {
    const auto is_read = [&](const Axis& axis) { return axis.data.name == name; };
    const bool read = std::any_of(out_.axes.begin(), out_.axes.end(), is_read);
    for (const auto& [entry, place] : axis_positions_) {
      if (!read && entry == name && !report_.empty()) return -1;  // it is told already why it could not be read
    }
    return find_axis(out_.axes, name, position, whose, report_);
  }

  int axis_at(const std::string& key) {
    const Entry* entry = root_.find(key);
    if (entry == nullptr) return -1;
    const std::string name = text_at(key);
    return entry->value.is_text() ? axis_called(name, entry->value.position, "'" + key + "'") : -1;
  }

  std::size_t group_of(int axis) const {
    for (std::size_t g = 0; g < out_.groups.size(); ++g) {
      const std::vector<int>& axes = out_.groups[g].axes;
      if (std::find(axes.begin(), axes.end(), axis) != axes.end()) return g;
    }
    return out_.groups.size();
  }

  void read_combination() {
    const std::string how = text_at("combine");
    const Entry* entry = root_.find("combine");
    if (entry != nullptr && how != "crossed" && how != "zipped" && how != "one-at-a-time") {
      fail(entry->value.position, "'combine' is " + description(entry->value), "one of: crossed, zipped, one-at-a-time",
           "leave it out for all combinations");
    }
    if (how == "one-at-a-time") out_.combination = Combination::one_at_a_time;
    if (how == "zipped") {
      std::vector<int> all;
      for (std::size_t a = 0; a < out_.axes.size(); ++a) all.push_back(static_cast<int>(a));
      zip(all, entry->value.position);
    }
    const Entry* zipped = root_.find("zipped");
    if (zipped == nullptr) return;
    if (!zipped->value.is_list()) {
      fail(zipped->value.position, "'zipped' is " + description(zipped->value),
           "lists of axes that are walked together", "write zipped = [[\"N\", \"M\"]]");
      return;
    }
    for (const Node& names : zipped->value.items) {
      std::vector<int> axes;
      if (!names.is_list()) {
        fail(names.position, "'zipped' has " + description(names), "lists of axes", "write zipped = [[\"N\", \"M\"]]");
        continue;
      }
      for (const Node& name : names.items) {
        const int axis = axis_called(name.text, name.position, "'zipped'");
        if (axis >= 0) axes.push_back(axis);
      }
      if (axes.size() == names.items.size()) zip(axes, names.position);
    }
  }

  /// The groups of these axes become one, in the place of the first.
  void zip(const std::vector<int>& axes, const Position& position) {
    if (axes.empty()) return;
    AxisGroup joined;
    std::vector<std::size_t> groups;
    for (const int axis : axes) {
      const std::size_t g = group_of(axis);
      if (g < out_.groups.size() && std::find(groups.begin(), groups.end(), g) == groups.end()) groups.push_back(g);
    }
    std::sort(groups.begin(), groups.end());
    for (const std::size_t g : groups) {
      const AxisGroup& group = out_.groups[g];
      if (joined.axes.empty()) joined.count = group.count;
      joined.axes.insert(joined.axes.end(), group.axes.begin(), group.axes.end());
      if (group.count == joined.count) continue;
      const auto name = [&](int axis) { return "'" + out_.axes[static_cast<std::size_t>(axis)].data.name + "'"; };
      fail(position,
           "zipped axes of different lengths: " + name(joined.axes.front()) + " has " + std::to_string(joined.count) +
               " values, " + name(group.axes.front()) + " has " + std::to_string(group.count),
           "as many values in each", "make them equal, or cross the axes");
      return;
    }
    for (std::size_t i = groups.size(); i-- > 1;) {
      out_.groups.erase(out_.groups.begin() + static_cast<std::ptrdiff_t>(groups[i]));
    }
    out_.groups[groups.front()] = std::move(joined);
  }

  void read_exclusions() {
    const Entry* entry = root_.find("exclude");
    if (entry == nullptr) return;
    if (!entry->value.is_list()) {
      fail(entry->value.position, "'exclude' is " + description(entry->value), "a list of tables",
           "write exclude = [{ contact = \"segment-wise-contact\", centerline = \"polyline\" }]");
      return;
    }
    for (const Node& table : entry->value.items) {
      if (!check_is_table(table, "an entry of 'exclude'", "write { axis = value }", report_)) continue;
      Exclusion exclusion;
      for (const Entry& one : table.entries) read_excluded(one, exclusion);
      if (!exclusion.choices.empty()) out_.exclusions.push_back(std::move(exclusion));
    }
  }

  void read_excluded(const Entry& entry, Exclusion& exclusion) {
    const int a = axis_called(entry.key, entry.position, "'exclude'");
    if (a < 0) return;
    const Axis& axis = out_.axes[static_cast<std::size_t>(a)];
    std::vector<int> alternatives;
    const std::vector<Node> single{entry.value};
    for (const Node& value : entry.value.is_list() ? entry.value.items : single) {
      const int k = find_alternative(axis, value);
      if (k >= 0) {
        alternatives.push_back(k);
        continue;
      }
      fail(value.position, "'exclude' has " + description(value) + ", which is no value of axis '" + entry.key + "'",
           "one of: " + comma_separated(axis.data.label), "name a value of the axis");
    }
    exclusion.choices.emplace_back(a, std::move(alternatives));
  }

  /// Every alternative becomes a problem of its own.
  static void separate(AxisData& axis) {
    axis.problem.clear();
    for (std::size_t k = 0; k < axis.label.size(); ++k) axis.problem.push_back(static_cast<int>(k));
  }

  /// Alternatives with other compositions state other problems; so do those of the axes that the file names.
  void read_cases() {
    for (Axis& axis : out_.axes) {
      for (const std::string& base : axis.base) {
        axis.data.problem.push_back(
            static_cast<int>(std::find(axis.base.begin(), axis.base.end(), base) - axis.base.begin()));
      }
    }
    const Entry* entry = root_.find("cases");
    if (entry == nullptr) return;
    if (!entry->value.is_list()) {
      fail(entry->value.position, "'cases' is " + description(entry->value), "a list of axes",
           "write cases = [\"scene\"]");
    }
    for (const Node& name : entry->value.items) {
      const int axis = axis_called(name.text, name.position, "'cases'");
      if (axis >= 0) separate(out_.axes[static_cast<std::size_t>(axis)].data);
    }
  }

  /// Where the file does not say it: the axis of meshes is the one whose paths all end with `nodes`.
  void read_along() {
    out_.along = axis_at("along");
    if (root_.find("along") != nullptr) return;
    const auto is_mesh = [](const std::string& path) {
      return path.size() > 6 && path.substr(path.size() - 6) == ".nodes";
    };
    for (std::size_t a = 0; a < out_.axes.size(); ++a) {
      const AxisData& data = out_.axes[a].data;
      const bool meshes = data.numeric() && data.spacing != Spacing::sampled && !data.paths.empty() &&
                          std::all_of(data.paths.begin(), data.paths.end(), is_mesh);
      if (meshes && out_.along < 0) out_.along = static_cast<int>(a);
    }
  }

  void check_columns() {
    // A quantity may be one of the table's own figures, which then stands there once.
    static const std::vector<std::string> figures{
        "unknowns",    "iterations",         "factorizations",          "evaluations", "epochs", "stationarity_N",
        "min_stretch", "max_penetration_mm", "max_penetration_dense_mm"};
    static const std::vector<std::string> others{"run",           "status",        "second_order",
                                                 "reason",        "setup_seconds", "solve_seconds",
                                                 "total_seconds", "load_seconds",  "least_solve_seconds"};
    std::vector<std::string> columns = others;
    for (const QuantityOfInterest& quantity : out_.quantities) {
      const bool own = contains_name(figures, quantity.column) && quantity.column != default_column(quantity);
      if (own || contains_name(columns, quantity.column)) {
        fail(quantity.position, "a quantity has the column '" + quantity.column + "', which is taken",
             "a name of its own", "write quantities as a table: name = \"path\"");
      }
      columns.push_back(quantity.column);
    }
    columns.insert(columns.end(), figures.begin(), figures.end());
    for (const Axis& axis : out_.axes) {
      if (contains_name(columns, axis.data.column)) {
        fail(position_of(axis),
             "axis '" + axis.data.name + "' has the column '" + axis.data.column + "', which is taken",
             "a name of its own", "rename the axis");
      }
      columns.push_back(axis.data.column);
    }
  }

  const Node& root_;
  Report& report_;
  StudyFile out_;
  std::vector<std::pair<std::string, Position>> axis_positions_;
};

}  // namespace

std::vector<int> walked_with(const StudyFile& study, int axis) {
  for (const AxisGroup& group : study.groups) {
    if (std::find(group.axes.begin(), group.axes.end(), axis) != group.axes.end()) return group.axes;
  }
  return {};
}

std::vector<std::string> bases_of(const StudyFile& study) {
  std::vector<std::string> out;
  const auto add = [&out](const std::string& file) {
    if (!file.empty() && !contains_name(out, file)) out.push_back(file);
  };
  add(study.base);
  for (const Axis& axis : study.axes) std::for_each(axis.base.begin(), axis.base.end(), add);
  return out;
}

StudyFile read_study(const std::string& file, bool reduced, std::vector<InputError>& errors) {
  Report report;
  std::error_code ignored;
  const auto source =
      std::make_shared<Source>(Source{file, fs::absolute(file, ignored).parent_path().lexically_normal(), 0});
  std::string text;
  StudyFile study;
  if (const std::string why = read_file(file, text); !why.empty()) {
    report.error({source, 0, 0}, "cannot read the file (" + why + ")", "a study in TOML", "check the path");
  } else if (std::optional<Node> root = read_toml(text, source, report)) {
    if (root->find("axes") == nullptr && (root->find("vessel") != nullptr || root->find("wire") != nullptr)) {
      report.error(root->position, "this is a composition, not a study", "a file with base and [axes]",
                   "solve it with `bowstring solve`, or name it as the base of a study");
    } else {
      if (reduced) reduce(*root, report);
      study = StudyReader(file, *root, report).read();
      if (reduced) study.name += "-reduced";  // another study: one folder cannot hold the results of both
    }
  }
  errors = report.sorted();
  return study;
}

}  // namespace bowstring::study
