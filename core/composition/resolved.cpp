#include "core/composition/resolved.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "core/composition/keys.hpp"
#include "core/composition/numbers.hpp"
#include "core/composition/profiles.hpp"
#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// Writes numbers of one value in the unit alternative that it is in.
class NumberWriter {
 public:
  NumberWriter(const ParameterDeclaration& declaration, int alternative) {
    const NumberRules rules(declaration);
    if (rules.units.size() > 1) unit_ = rules.units[static_cast<std::size_t>(alternative)];
  }

  Json operator()(double number) const {
    if (unit_.empty()) return number;
    return Json(number).dump() + " " + unit_;
  }
  /// "" where a number's unit goes without saying.
  const std::string& unit() const { return unit_; }

 private:
  std::string unit_;
};

Json profile_json(const Profile& profile, const NumberWriter& number) {
  Json result;
  switch (profile.form) {
    case Profile::Form::constant:
      return number(profile.constant);
    case Profile::Form::table:
      result["table"] = Json::array();
      for (std::size_t i = 0; i < profile.arc.size(); ++i) {
        result["table"].push_back(Json::array({Json(profile.arc[i]), number(profile.value[i])}));
      }
      if (profile.measured_from != Profile::Origin::first_end) {
        result["measured-from"] = origin_name(profile.measured_from);
      }
      return result;
    case Profile::Form::segments:
      for (std::size_t i = 0; i < profile.segment.size(); ++i) {
        result["segments"][profile.segment[i]] = number(profile.value[i]);
      }
      return result;
    case Profile::Form::column:
      result["column"] = profile.column;
      if (!number.unit().empty()) result["unit"] = number.unit();
      return result;
  }
  return result;
}

void add_parameters(Json& table, const ParameterSet& set, Span<const ParameterDeclaration> schema);

Json value_json(const ParameterValue& value, const ParameterDeclaration& declaration) {
  const NumberWriter number(declaration, value.unit_alternative);
  switch (value.type) {
    case ParameterType::scalar:
      return value.text.empty() ? Json(number(value.number)) : Json(value.text);
    case ParameterType::profile:
      return profile_json(value.profile, number);
    case ParameterType::integer:
      return value.integer;
    case ParameterType::flag:
      return value.flag;
    case ParameterType::path:
    case ParameterType::choice:
    case ParameterType::text:
      return value.text;
    case ParameterType::names:
      return value.names;
    case ParameterType::vector: {
      Json list = Json::array();
      for (const double entry : value.vector) list.push_back(number(entry));
      return list;
    }
    case ParameterType::list: {
      Json list = Json::array();
      for (const ParameterSet& item : value.items) {
        Json entry = Json::object();
        add_parameters(entry, item, {declaration.items, static_cast<std::size_t>(declaration.item_count)});
        list.push_back(entry);
      }
      return list;
    }
  }
  return nullptr;
}

void add_parameters(Json& table, const ParameterSet& set, Span<const ParameterDeclaration> schema) {
  for (const ParameterDeclaration& declaration : schema) {
    if (const ParameterValue* value = set.find(declaration.key))
      table[declaration.key] = value_json(*value, declaration);
  }
}

void add_component(Json& table, const ComponentChoice& choice) {
  table["type"] = choice.name;
  const auto count = static_cast<std::size_t>(choice.descriptor->parameter_count);
  add_parameters(table, choice.parameters, {choice.descriptor->parameters, count});
}

Json component_table(const ComponentChoice& choice) {
  Json table;
  add_component(table, choice);
  return table;
}

Json end_json(const EndTable& end, int dimension) {
  if (!end.type.empty() && end.tangent.empty() && end.move.empty() && end.turn.empty()) return end.type;
  Json table;
  if (!end.type.empty()) {
    table["type"] = end.type;
  } else {
    const auto word = [](bool held) { return held ? "held" : "free"; };
    table["position"] = Json::array();
    for (int k = 0; k < dimension; ++k) table["position"].push_back(word(end.position_held[k]));
    table["rotation"] = word(end.rotation_held);
  }
  if (end.in_end_axes) table["axes"] = "end";
  if (!end.tangent.empty()) table["tangent"] = end.tangent;
  if (!end.move.empty()) table["move"] = end.move;
  if (end.turn.size() == 1) table["turn"] = end.turn.front();
  if (end.turn.size() > 1) table["turn"] = end.turn;
  return table;
}

/// Structural profiles are in mm and have no alternatives.
Json radius_json(const ParameterValue& radius) {
  const ParameterDeclaration declaration{"radius", ParameterType::profile, "mm", nullptr, ""};
  return value_json(radius, declaration);
}

Json vessel_json(const VesselTable& vessel, int dimension) {
  Json table;
  table["name"] = vessel.name;
  table["geometry"] = component_table(vessel.geometry);
  if (vessel.radius) table["radius"] = radius_json(*vessel.radius);
  table["kinematics"] = component_table(vessel.kinematics);
  table["ends"] = Json::array({end_json(vessel.end[0], dimension), end_json(vessel.end[1], dimension)});
  table["rigid"] = vessel.rigid;
  return table;
}

Json wire_json(const WireTable& wire, int dimension) {
  Json table;
  table["name"] = wire.name;
  if (!wire.vessel.empty()) table["vessel"] = wire.vessel;
  if (wire.geometry) table["geometry"] = component_table(*wire.geometry);
  if (wire.nodes > 0) table["nodes"] = wire.nodes;
  if (!wire.span.empty()) table["span"] = wire.span;
  if (!wire.spacing.empty()) table["spacing"] = wire.spacing;
  if (wire.length != LengthRule::by_ends) table["length"] = wire.length == LengthRule::sliding ? "sliding" : "fixed";
  table["radius"] = radius_json(wire.radius);
  table["kinematics"] = component_table(wire.kinematics);
  table["ends"] = Json::array({end_json(wire.end[0], dimension), end_json(wire.end[1], dimension)});
  return table;
}

template <class Term>
Json term_json(const Term& term) {
  Json table;
  table["name"] = term.label;
  table["on"] = term.on;
  add_component(table, term.component);
  return table;
}

Json loss_json(const LossTable& loss) {
  Json table = {{"name", loss.label}, {"on", loss.on}, {"against", loss.against}};
  if (loss.sampling.points > 0) table["points"] = loss.sampling.points;
  table["weights"] = curve_weights_name(loss.sampling.weights);
  for (const MeasureStation& station : loss.sampling.stations) {
    table["stations"].push_back({{"at", station.at}, {"spread", station.spread}, {"weight", station.weight}});
  }
  table["transport"] = component_table(loss.transport);
  table["ground-cost"] = component_table(loss.ground_cost);
  return table;
}

Json certificate_json(const CertificateTable& certificate) {
  return {{"stationarity", certificate.stationarity},       {"penetration", certificate.penetration},
          {"complementarity", certificate.complementarity}, {"multiplier", certificate.multiplier},
          {"minimum-stretch", certificate.minimum_stretch}, {"require", certificate.require}};
}

Json range_end(const ValueRange& range, double t) {
  Json list = Json::array();
  for (const double value : range.at(t)) {
    const Json number = range.whole ? Json(static_cast<long>(value)) : Json(value);
    list.push_back(range.unit.empty() ? number : Json(number.dump() + " " + range.unit));
  }
  return range.list ? list : list.front();
}

Json continuation_json(const ContinuationTable& walk) {
  return {{"path", walk.path},
          {"from", range_end(walk.range, 0.0)},
          {"to", range_end(walk.range, 1.0)},
          {"when", walk.fallback ? "fallback" : "always"},
          {"scale", walk.range.logarithmic ? "log" : "linear"},
          {"arclength", walk.arclength ? "auto" : "never"},
          {"first-step", walk.first_step},
          {"smallest-step", walk.smallest_step},
          {"largest-step", walk.largest_step},
          {"tolerance", walk.tolerance},
          {"max-points", walk.most_points}};
}

Json multistart_json(const MultistartTable& table) {
  Json out = {{"starts", table.starts}, {"seed", table.seed}};
  if (table.perturbation) out["perturbation"] = *table.perturbation;
  out["mirrored"] = table.mirrored;
  out["distance"] = table.distance;
  out["saddles"] = table.saddles;
  return out;
}

Json steps_json(const std::vector<StepTable>& steps) {
  Json out = Json::array();
  for (const StepTable& step : steps) {
    Json table = {{"name", step.name}};
    if (step.rest_is_previous && !out.empty()) table["rest"] = "previous";
    if (!step.tables.empty()) table.update(Json::parse(step.tables));
    out.push_back(std::move(table));
  }
  return out;
}

std::string written(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string differing_tables(const std::string& resolved, const std::string& before) {
  const Json now = Json::parse(resolved), then = Json::parse(before);
  Json out = Json::object();
  for (const auto& [key, value] : now.items()) {
    const auto same = then.find(key);
    const bool differs = same == then.end() || *same != value;
    if (differs && key != "start" && contains_name(overridable_names(), key)) out[key] = value;
  }
  return out.empty() ? "" : written(out);
}

std::string component_json(const ComponentChoice& choice) { return written(component_table(choice)); }

std::string resolved_json(const Composition& composition) {
  Json root;
  root["schema"] = composition.schema;
  root["title"] = composition.title;
  if (!composition.plugin_path.empty()) root["plugin-path"] = composition.plugin_path;
  root["scene"]["dimension"] = composition.dimension;
  for (const VesselTable& vessel : composition.vessels)
    root["vessel"].push_back(vessel_json(vessel, composition.dimension));
  for (const WireTable& wire : composition.wires) root["wire"].push_back(wire_json(wire, composition.dimension));
  for (const EnergyTable& energy : composition.energies) root["energy"].push_back(term_json(energy));
  for (const ConstraintTable& constraint : composition.constraints) {
    root["constraint"].push_back(term_json(constraint));
  }
  for (const LossTable& loss : composition.losses) root["loss"].push_back(loss_json(loss));
  root["enforcement"] = component_table(composition.enforcement);
  root["solver"] = component_table(composition.solver);
  root["certificate"] = certificate_json(composition.certificate);
  const StartTable& start = composition.start;
  if (!start.from.empty()) root["start"]["from"] = start.from;
  if (!start.from.empty() || start.rest_is_previous) {
    root["start"]["rest"] = start.rest_is_previous ? "previous" : "state-1";
  }
  if (composition.continuation.given) root["continuation"] = continuation_json(composition.continuation);
  if (composition.multistart.given) root["multistart"] = multistart_json(composition.multistart);
  if (composition.step == 0 && !composition.steps.empty()) root["step"] = steps_json(composition.steps);
  return written(root);
}

}  // namespace bowstring
