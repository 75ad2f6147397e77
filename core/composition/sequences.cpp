#include "core/composition/sequences.hpp"

#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/override.hpp"
#include "core/composition/parameters.hpp"
#include "core/composition/read_value_range.hpp"

namespace bowstring {
namespace {

constexpr double unbounded = 1e308;

ParameterDeclaration declare(const char* key, ParameterType type, const char* unit, const char* default_text,
                             const char* description, double lower = -unbounded, double upper = unbounded,
                             bool lower_exclusive = false, const char* choices = "") {
  return {key, type, unit, default_text, description, lower, upper, lower_exclusive, false, choices};
}

Span<const ParameterDeclaration> continuation_schema() {
  using Type = ParameterType;
  static const ParameterDeclaration schema[] = {
      declare("path", Type::text, "", nullptr, "the value that is walked: \"energy.axial-tension.tension\""),
      declare("when", Type::choice, "", "\"always\"", "or only where the solve from the start does not converge",
              -unbounded, unbounded, false, "always|fallback"),
      declare("scale", Type::choice, "", "\"linear\"", "what equal steps are: differences or ratios", -unbounded,
              unbounded, false, "linear|log"),
      declare("arclength", Type::choice, "", "\"auto\"",
              "steps along the path of equilibria, which pass folds, or along the value alone; auto: where the mesh "
              "stays and rows are exact",
              -unbounded, unbounded, false, "auto|never"),
      declare("first-step", Type::scalar, "", "0.1", "share of the way", 0.0, 1.0, true),
      declare("smallest-step", Type::scalar, "", "1e-4", "share of the way, at which a walk is given up", 0.0, 1.0,
              true),
      declare("largest-step", Type::scalar, "", "0.25", "share of the way", 0.0, 1.0, true),
      declare("tolerance", Type::scalar, "", "1e-6", "share of the way to which folds and bifurcations are located",
              0.0, 1.0, true),
      declare("max-points", Type::integer, "", "500", "points of a path, after which a walk is given up", 2.0),
  };
  return {schema, std::size(schema)};
}

const Node* table_of(const Node& root, const char* name, const std::string& mend, Report& report) {
  const Entry* entry = root.find(name);
  if (entry == nullptr) return nullptr;
  const std::string subject = std::string("'") + name + "'";
  return check_is_table(entry->value, subject, mend, report) ? &entry->value : nullptr;
}

bool is_step_key(const std::string& key) { return key == "name" || key == "rest"; }

void lay_step(Node& root, const Node& step, Report& report) {
  for (const Entry& entry : step.entries) {
    if (is_step_key(entry.key)) continue;
    if (entry.value.is_table() && !entry.value.inline_table) {
      report.error(entry.position, "'" + entry.key + "' in [[step]] opens a table",
                   "a whole path in quotes, with a value or an inline table { … }",
                   "write it as in \"energy.axial-tension.tension\" = \"12 N\"");
    } else {
      apply_override(root, entry.key, entry.position, entry.value, report);
    }
  }
}

}  // namespace

Span<const ParameterDeclaration> multistart_schema() {
  using Type = ParameterType;
  static const ParameterDeclaration schema[] = {
      declare("starts", Type::integer, "", "8", "how many starts, the first one unperturbed", 1.0, 1e6),
      declare("seed", Type::integer, "", "1", "of the perturbations", 0.0),
      declare("perturbation", Type::scalar, "mm", "",
              "root-mean-square displacement of a start's nodes; default a tenth of the smallest clearance, without "
              "contact a hundredth of a curve's length",
              0.0, unbounded, true),
      declare("mirrored", Type::flag, "", "true", "every second start is the mirror image of the one before it"),
      declare("distance", Type::scalar, "mm", "1e-3",
              "equilibria are one where no node of theirs is farther apart than this", 0.0, unbounded, true),
      declare("saddles", Type::flag, "", "true", "look for the saddle between each two neighbouring minima"),
  };
  return {schema, std::size(schema)};
}

ContinuationTable read_continuation(const Node& root, Report& report) {
  ContinuationTable out;
  const Node* table = table_of(root, "continuation", "write [continuation] with path, from and to", report);
  if (table == nullptr) return out;
  SchemaOwner owner;
  owner.name = "[continuation]";
  owner.help = "remove it";
  owner.structural = {"path", "from", "to"};
  Status no_fault;
  const ParameterSet values = read_parameters(*table, owner, continuation_schema(), no_fault, report);
  out.given = true;
  out.position = table->position.text();
  out.fallback = values.has("when") && values.text("when") == "fallback";
  out.arclength = !values.has("arclength") || values.text("arclength") != "never";
  if (values.has("first-step")) out.first_step = values.scalar("first-step");
  if (values.has("smallest-step")) out.smallest_step = values.scalar("smallest-step");
  if (values.has("largest-step")) out.largest_step = values.scalar("largest-step");
  if (values.has("tolerance")) out.tolerance = values.scalar("tolerance");
  if (values.has("max-points")) out.most_points = values.integer("max-points");

  const Entry* path = table->find("path");
  const Entry *from = table->find("from"), *to = table->find("to");
  for (const auto& [entry, key] : {std::pair{path, "path"}, std::pair{from, "from"}, std::pair{to, "to"}}) {
    if (entry != nullptr) continue;
    report.error(table->position, std::string("[continuation] has no '") + key + "'",
                 key == std::string("path") ? "the path of a value" : "a value of the path",
                 std::string("add ") + key +
                     (key == std::string("path") ? " = \"energy.axial-tension.tension\"" : " = \"<number> <unit>\""));
  }
  if (path != nullptr && (!path->value.is_text() || path->value.text.empty())) {
    report.error(path->value.position, "'path' of [continuation] is " + description(path->value),
                 "text, the path of a value", "write path = \"energy.axial-tension.tension\"");
    return out;
  }
  if (path == nullptr || from == nullptr || to == nullptr) return out;
  out.path = path->value.text;
  out.path_position = path->value.position.text();
  out.from_position = from->value.position.text();
  out.to_position = to->value.position.text();
  const bool logarithmic = values.has("scale") && values.text("scale") == "log";
  if (std::optional<ValueRange> range = read_value_range(*from, *to, logarithmic, "[continuation]", report)) {
    out.range = std::move(*range);
  }
  return out;
}

MultistartTable read_multistart(const Node& root, Report& report) {
  MultistartTable out;
  const Node* table = table_of(root, "multistart", "write [multistart] with starts", report);
  if (table == nullptr) return out;
  SchemaOwner owner;
  owner.name = "[multistart]";
  owner.help = "remove it";
  Status no_fault;
  const ParameterSet values = read_parameters(*table, owner, multistart_schema(), no_fault, report);
  out.given = true;
  out.position = table->position.text();
  if (values.has("starts")) out.starts = values.integer("starts");
  if (values.has("seed")) out.seed = values.integer("seed");
  out.seed_given = table->find("seed") != nullptr;
  if (values.has("perturbation")) out.perturbation = values.scalar("perturbation");
  if (values.has("mirrored")) out.mirrored = values.flag("mirrored");
  if (values.has("distance")) out.distance = values.scalar("distance");
  if (values.has("saddles")) out.saddles = values.flag("saddles");
  return out;
}

std::vector<StepTable> read_steps(const Node& root, Report& report) {
  std::vector<StepTable> out;
  const Entry* list = root.find("step");
  if (list == nullptr) return out;
  if (!list->value.is_list()) {
    report.error(list->value.position, "'step' is " + description(list->value), "a list of tables", "write [[step]]");
    return out;
  }
  for (const Node& table : list->value.items) {
    StepTable step;
    const std::string number = std::to_string(out.size() + 1);
    const std::string owner = "step " + number;
    step.name = number;
    step.position = table.position.text();
    if (!check_is_table(table, owner, "write [[step]]", report)) continue;
    if (const Entry* name = table.find("name")) {
      if (name->value.is_text() && !name->value.text.empty()) {
        step.name = name->value.text;
      } else {
        report.error(name->value.position, "'name' of " + owner + " is " + description(name->value), "text",
                     "write it in quotes");
      }
    }
    if (const Entry* rest = table.find("rest")) {
      if (!rest->value.is_text() || (rest->value.text != "state-1" && rest->value.text != "previous")) {
        report.error(rest->value.position, "'rest' of " + owner + " is " + description(rest->value),
                     "'state-1' or 'previous'", "write one of them in quotes");
      } else if (rest->value.text == "previous" && out.empty() && root.find("start") == nullptr) {
        report.error(rest->value.position, "'rest' of " + owner + " is 'previous', but no state comes before it",
                     "'state-1'", "remove it, or begin at a result with [start]");
      } else {
        step.rest_is_previous = rest->value.text == "previous";
      }
    }
    for (const StepTable& other : out) {
      if (other.name != step.name) continue;
      report.error(table.position, "duplicate name: step '" + step.name + "', after the one at " + other.position,
                   "a name for each", "rename one of the two");
    }
    out.push_back(std::move(step));
  }
  return out;
}

void apply_steps(Node& root, int last, Report& report) {
  const Entry* list = root.find("step");
  if (list == nullptr) return;
  const std::vector<Node> steps = list->value.is_list() ? list->value.items : std::vector<Node>{};
  root.erase("step");
  for (int k = 0; k <= last && k < static_cast<int>(steps.size()); ++k) {
    lay_step(root, steps[static_cast<std::size_t>(k)], report);
  }
  // What is wrong with the paths of later steps is told with the rest.
  Node later = root;
  for (std::size_t k = static_cast<std::size_t>(last) + 1; k < steps.size(); ++k) lay_step(later, steps[k], report);
  if (last < 0 || last >= static_cast<int>(steps.size())) return;
  const Entry* rest = steps[static_cast<std::size_t>(last)].find("rest");
  if (last == 0) {
    Entry* start = root.find("start");
    if (rest != nullptr && start != nullptr && start->value.is_table()) start->value.set(*rest);
    return;
  }
  root.erase("start");  // a step begins where the one before it ended
  if (rest != nullptr) {
    Node start;
    start.position = rest->position;
    start.set(*rest);
    root.set({"start", rest->position, std::move(start)});
  }
}

}  // namespace bowstring
