#include "core/session/revalue.hpp"

#include <algorithm>
#include <cmath>

#include "core/composition/parameters.hpp"
#include "core/composition/resolved.hpp"
#include "core/composition/toml_text.hpp"
#include "core/model/declarations.hpp"
#include "core/model/unheld_load.hpp"

namespace bowstring {

namespace {

/// "energy.anchoring.stiffness" in its three steps; empty where the path is of another kind.
std::vector<std::string> steps_of(const std::string& path) {
  std::vector<std::string> steps(1);
  for (const char letter : path) {
    if (letter == '"' || letter == '\'') return {};
    if (letter == '.') {
      steps.emplace_back();
    } else {
      steps.back().push_back(letter);
    }
  }
  return steps.size() == 3 ? steps : std::vector<std::string>{};
}

/// The number of the entry that a path means, by its label or else by its type, as overrides find it; −1: none or
/// several.
template <class Table>
int find_entry(const std::vector<Table>& tables, const std::string& name) {
  int found = -1, fits = 0;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i].label == name) return static_cast<int>(i);
    if (tables[i].component.name != name) continue;
    found = static_cast<int>(i);
    ++fits;
  }
  return fits == 1 ? found : -1;
}

bool is_number(const ParameterValue& value) {
  return value.text.empty() && (value.type == ParameterType::scalar || (value.type == ParameterType::profile &&
                                                                        value.profile.form == Profile::Form::constant));
}

double number_of(const ParameterValue& value) {
  return value.type == ParameterType::profile ? value.profile.constant : value.number;
}

/// The component with its new number; empty where that is none, or another kind of quantity than before.
std::optional<ComponentChoice> with_number(const ComponentChoice& choice, const std::string& key,
                                           const Override& change) {
  const ParameterDeclaration* end = choice.descriptor->parameters + choice.descriptor->parameter_count;
  const ParameterDeclaration* declaration =
      std::find_if(choice.descriptor->parameters, end, [&](const ParameterDeclaration& one) { return key == one.key; });
  ComponentChoice out = choice;
  const auto old = std::find_if(out.parameters.values.begin(), out.parameters.values.end(),
                                [&](const ParameterValue& value) { return value.key == key; });
  if (declaration == end || old == out.parameters.values.end() || !is_number(*old)) return std::nullopt;

  const auto source = std::make_shared<Source>();
  source->name = "--set " + change.path + "=" + change.value;
  const Position position{source, 0, 0};
  Report report;
  Status fault;
  std::optional<ParameterValue> value =
      read_parameter(read_value_or_text(change.value, position), *declaration, {}, fault, report);
  if (!value || !report.empty() || !fault.ok() || !is_number(*value) ||
      value->unit_alternative != old->unit_alternative) {
    return std::nullopt;
  }
  *old = std::move(*value);
  return out;
}

bool same(const LawDescription& a, const LawDescription& b) {
  return a.site == b.site && a.weighing == b.weighing && a.parameters == b.parameters && a.places == b.places &&
         a.weight == b.weight && a.linear == b.linear && a.isotropic == b.isotropic && a.objective == b.objective;
}

bool same(const std::vector<IdleParameter>& a, const std::vector<IdleParameter>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const IdleParameter& one, const IdleParameter& other) {
    return one.key == other.key && one.reason == other.reason;
  });
}

bool same(const EnergyDeclaration& a, const EnergyDeclaration& b) {
  return a.needs.material_frames == b.needs.material_frames && a.needs.stretch == b.needs.stretch &&
         a.needs.reason == b.needs.reason && a.warnings == b.warnings && same(a.without_effect, b.without_effect) &&
         std::equal(a.descriptions.begin(), a.descriptions.end(), b.descriptions.begin(), b.descriptions.end(),
                    [](const LawDescription& one, const LawDescription& other) { return same(one, other); });
}

bool any_unheld_load(const Scene& scene) {
  return std::any_of(scene.curves.begin(), scene.curves.end(),
                     [&](const auto& curve) { return unheld_load(scene, *curve).has_value(); });
}

/// The energy anew, with the parameters of its laws as they were; false where it declares something else than before.
bool remake(const Scene& scene, const EnergyUse& use, const ComponentChoice& choice, EnergyUse& made) {
  made.label = use.label;
  made.plugin = use.plugin;
  made.curve = use.curve;
  made.parameters = choice.parameters;
  Status status;
  made.energy = create<Energy>(choice, status);
  if (!status.ok()) return false;
  const CurveView& curve = scene.curves[static_cast<std::size_t>(use.curve)]->view;
  if (!made.energy->declare(curve, made.declaration).ok() || !flaw_of(made.declaration, made.parameters).empty() ||
      !same(made.declaration, use.declaration)) {
    return false;
  }
  for (std::size_t k = 0; k < use.laws.size(); ++k) {
    made.laws.push_back({made.declaration.laws[k], made.declaration.descriptions[k], use.laws[k].parameters});
  }
  return true;
}

bool revalue_energy(Session& session, std::size_t index, const std::string& key, const Override& change) {
  Scene& scene = *session.scene;
  EnergyTable& table = session.composition.energies[index];
  EnergyUse& use = scene.energies[index];
  std::optional<ComponentChoice> choice = with_number(table.component, key, change);
  if (!choice) return false;

  EnergyUse made;
  if (!remake(scene, use, *choice, made)) return false;
  const double number = number_of(made.parameters.at(key));
  for (LawUse& law : made.laws) {
    for (std::size_t p = 0; p < law.parameters.size(); ++p) {
      if (law.description.parameters[p] == key) std::fill(law.parameters[p].begin(), law.parameters[p].end(), number);
    }
  }
  std::swap(use, made);
  if (any_unheld_load(scene)) {
    std::swap(use, made);
    return false;
  }
  table.component = std::move(*choice);
  return true;
}

/// Rows are declared anew by every solve: only what they say of themselves is looked at here.
bool revalue_constraint(Session& session, std::size_t index, const std::string& key, const Override& change) {
  ConstraintTable& table = session.composition.constraints[index];
  const auto use =
      std::find_if(session.scene->constraints.begin(), session.scene->constraints.end(),
                   [&](const ConstraintUse& one) { return !one.plugin.empty() && one.label == table.label; });
  std::optional<ComponentChoice> choice = with_number(table.component, key, change);
  if (!choice || use == session.scene->constraints.end()) return false;
  Status status;
  const Owned<Constraint> made = create<Constraint>(*choice, status);
  RowDeclaration rows;
  if (!status.ok() || !made->declare(use->scene, rows).ok() || rows.rows != use->rows.rows ||
      rows.warnings != use->rows.warnings || !same(rows.without_effect, use->rows.without_effect)) {
    return false;
  }
  table.component = std::move(*choice);
  return true;
}

}  // namespace

bool show_previous(Session& session, const std::vector<std::vector<double>>& previous) {
  Scene& scene = *session.scene;
  const auto same_as = [](const std::unique_ptr<Curve>& curve, const std::vector<double>& points) {
    return curve->previous == points;
  };
  if (previous.empty() ||
      std::equal(scene.curves.begin(), scene.curves.end(), previous.begin(), previous.end(), same_as))
    return true;
  for (std::size_t c = 0; c < scene.curves.size(); ++c) {
    Curve& curve = *scene.curves[c];
    curve.previous = previous[c];
    curve.view.previous = curve.previous.empty() ? nullptr : curve.previous.data();
  }
  for (ConstraintUse& use : scene.constraints) {
    for (CurveView& view : use.scene.on) {
      view.previous = scene.curves[static_cast<std::size_t>(view.index)]->view.previous;
    }
  }
  session.bound = false;
  std::vector<EnergyUse> made(scene.energies.size());
  for (std::size_t e = 0; e < made.size(); ++e) {
    if (!remake(scene, scene.energies[e], session.composition.energies[e].component, made[e])) return false;
  }
  // The assembly still reads the old ones' laws; it is made anew before it is asked again.
  scene.energies.swap(made);
  return true;
}

bool revalue(Session& session, const Override& change) {
  const std::vector<std::string> steps = steps_of(change.path);
  if (steps.empty()) return false;
  bool done = false;
  if (steps[0] == "energy") {
    const int index = find_entry(session.composition.energies, steps[1]);
    done = index >= 0 && revalue_energy(session, static_cast<std::size_t>(index), steps[2], change);
  } else if (steps[0] == "constraint") {
    const int index = find_entry(session.composition.constraints, steps[1]);
    done = index >= 0 && revalue_constraint(session, static_cast<std::size_t>(index), steps[2], change);
  }
  if (!done) return false;
  session.composition.resolved_json = resolved_json(session.composition);
  session.bound = false;  // what the rows and laws were bound with is no more
  return true;
}

}  // namespace bowstring
