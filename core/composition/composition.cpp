#include "core/composition/composition.hpp"

#include <optional>
#include <utility>

#include "core/composition/components.hpp"
#include "core/composition/curves.hpp"
#include "core/composition/duplicates.hpp"
#include "core/composition/keys.hpp"
#include "core/composition/losses.hpp"
#include "core/composition/report.hpp"
#include "core/composition/resolved.hpp"
#include "core/composition/sequences.hpp"
#include "core/composition/settings.hpp"
#include "core/composition/sources.hpp"
#include "core/composition/start.hpp"
#include "core/composition/terms.hpp"
#include "core/composition/vocabulary.hpp"
#include "core/composition/without_effect.hpp"
#include "core/measure/given_measure.hpp"

namespace bowstring {
namespace {

/// The entries of a list of tables; none where the file has something else, which is reported.
const std::vector<Node>& tables_of(const Node& root, const std::string& name, Report& report) {
  static const std::vector<Node> none;
  const Entry* list = root.find(name);
  if (list == nullptr) return none;
  if (list->value.is_list()) return list->value.items;
  report.error(list->value.position, "'" + name + "' is " + description(list->value), "a list of tables",
               "write [[" + name + "]]");
  return none;
}

Composition read_composition(const Node& root, bool from_memory, Reading& reading) {
  Report& report = reading.report;
  Composition composition;
  check_keys(root, "the composition", top_level_names(), later_table_names(), "remove it", report);
  composition.title = read_title(root, report);
  composition.dimension = reading.dimension = read_dimension(root, report);

  const CurveNames names = curve_names(root);
  for (const Node& table : tables_of(root, "vessel", report)) {
    composition.vessels.push_back(read_vessel(table, reading));
  }
  for (const Node& table : tables_of(root, "wire", report)) {
    composition.wires.push_back(read_wire(table, names, reading));
  }
  if (root.find("vessel") == nullptr && root.find("wire") == nullptr) {
    report.error(root.position, "the scene has no curve", "a [[vessel]]", "add [[vessel]] with name and geometry");
  }
  for (const Node& table : tables_of(root, "energy", report)) {
    composition.energies.push_back(read_energy(table, names, reading));
  }
  for (const Node& table : tables_of(root, "constraint", report)) {
    composition.constraints.push_back(read_constraint(table, names, reading));
  }
  for (const Node& table : tables_of(root, "loss", report)) {
    composition.losses.push_back(read_loss(table, names, reading));
  }
  composition.enforcement = read_enforcement(root, reading);
  composition.solver = read_solver(root, reading);
  composition.certificate = read_certificate(root, report);
  composition.start = read_start(root, from_memory, report);
  composition.continuation = read_continuation(root, report);
  composition.multistart = read_multistart(root, report);
  check_duplicates(root, report);
  return composition;
}

/// Files that parameters name.
void add_paths(const ParameterSet& parameters, std::vector<std::string>& out) {
  for (const ParameterValue& value : parameters.values) {
    if (value.type == ParameterType::path && !value.text.empty()) out.push_back(value.text);
    for (const ParameterSet& item : value.items) add_paths(item, out);
  }
}

/// Fills in what each step changes. What is wrong with a later step is told by whoever reads it for that step.
void resolve_steps(const CompositionRequest& request, Registry& registry, Composition& composition) {
  std::string before = composition.resolved_json;
  for (std::size_t k = 1; k < composition.steps.size(); ++k) {
    CompositionRequest later = request;
    later.step = static_cast<int>(k);
    later.from_memory = true;
    CompositionOutcome outcome = load_composition(later, registry);
    if (!outcome.composition) return;
    composition.steps[k].tables = differing_tables(outcome.composition->resolved_json, before);
    before = std::move(outcome.composition->resolved_json);
  }
}

}  // namespace

std::vector<const ComponentChoice*> components_of(const Composition& composition) {
  std::vector<const ComponentChoice*> out;
  for (const VesselTable& vessel : composition.vessels) {
    out.push_back(&vessel.geometry);
    out.push_back(&vessel.kinematics);
  }
  for (const WireTable& wire : composition.wires) {
    if (wire.geometry) out.push_back(&*wire.geometry);
    out.push_back(&wire.kinematics);
  }
  for (const EnergyTable& energy : composition.energies) out.push_back(&energy.component);
  for (const ConstraintTable& constraint : composition.constraints) out.push_back(&constraint.component);
  for (const LossTable& loss : composition.losses) {
    out.push_back(&loss.transport);
    out.push_back(&loss.ground_cost);
  }
  out.push_back(&composition.enforcement);
  out.push_back(&composition.solver);
  return out;
}

std::vector<std::string> data_files_of(const Composition& composition) {
  std::vector<std::string> out;
  for (const ComponentChoice* choice : components_of(composition)) add_paths(choice->parameters, out);
  for (const LossTable& loss : composition.losses) {
    if (loss.observed != nullptr) out.push_back(loss.observed->name.file);
  }
  if (!composition.start.from.empty()) out.push_back(composition.start.from);
  return out;
}

CompositionOutcome load_composition(const CompositionRequest& request, Registry& registry) {
  CompositionOutcome outcome;
  Report report;
  const std::optional<SourceTree> sources = read_sources(request, report);
  if (sources) {
    Reading reading{registry, report, outcome.plugin_failure};
    Composition composition = read_composition(sources->root, request.from_memory, reading);
    composition.file = request.file;
    composition.input_files = sources->files;
    composition.steps = sources->steps;
    composition.step = request.step;
    for (std::string& file : data_files_of(composition)) composition.input_files.push_back(std::move(file));
    composition.plugin_path = sources->plugin_path;
    if (report.empty() && outcome.plugin_failure.ok()) {
      composition.resolved_json = resolved_json(composition);
      if (composition.step == 0 && composition.steps.size() > 1) {
        resolve_steps(request, registry, composition);
        composition.resolved_json = resolved_json(composition);
      }
      composition.without_effect = without_effect(sources->root, composition);
      outcome.composition = std::move(composition);
    }
  }
  outcome.errors = report.sorted();
  return outcome;
}

std::vector<std::string> composition_plugin_path(const CompositionRequest& request) {
  Report ignored;
  const std::optional<SourceTree> sources = read_sources(request, ignored);
  return sources ? sources->plugin_path : std::vector<std::string>{};
}

}  // namespace bowstring
