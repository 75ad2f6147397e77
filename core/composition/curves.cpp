#include "core/composition/curves.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/composition/ends.hpp"
#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/numbers.hpp"
#include "core/composition/parameters.hpp"
#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

constexpr const char* default_kinematics = "edge-frames";

ParameterDeclaration radius_declaration(const char* default_text, const char* description) {
  ParameterDeclaration radius{"radius", ParameterType::profile, "mm", default_text, description};
  radius.lower = 0.0;
  radius.lower_exclusive = true;
  radius.differentiable = true;
  return radius;
}

Span<const ParameterDeclaration> vessel_schema() {
  static const ParameterDeclaration schema[] = {
      radius_declaration("", "lumen radius, unless the geometry brings it"),
      {"rigid", ParameterType::flag, "", "false", "the vessel has no unknowns"},
  };
  return {schema, std::size(schema)};
}

ParameterDeclaration length_declaration() {
  ParameterDeclaration length{"length", ParameterType::choice, "", "",
                              "whether the wire's length in the body is an unknown or that of State 1"};
  length.choices = "sliding|fixed";
  return length;
}

Span<const ParameterDeclaration> wire_schema() {
  static const ParameterDeclaration schema[] = {
      {"nodes", ParameterType::integer, "", "", "nodes of the wire's own mesh, otherwise as many as its vessel has", 3,
       1e6},
      radius_declaration(nullptr, "outer radius"),
      length_declaration(),
  };
  return {schema, std::size(schema)};
}

SchemaOwner owner_of(const std::string& name) {
  SchemaOwner owner;
  owner.name = name;
  owner.help = "remove it";
  return owner;
}

ComponentChoice read_geometry(const Node& table, const std::string& owner, Reading& reading) {
  ComponentUse use;
  use.kind = Kind::geometry;
  use.owner = owner;
  use.structural = {"type"};
  const Entry* entry = table.find("geometry");
  if (entry == nullptr) {
    reading.report.error(table.position, owner + " has no 'geometry'", "a table with the 'type' of a geometry",
                         "add geometry = { type = \"<geometry>\", … }");
    return {};
  }
  if (!check_is_table(entry->value, "'geometry' of " + owner, "write geometry = { type = \"<geometry>\", … }",
                      reading.report)) {
    return {};
  }
  return read_component(entry->value, use, reading);
}

std::optional<ParameterValue> optional_value(const ParameterSet& set, const std::string& key) {
  const ParameterValue* value = set.find(key);
  return value != nullptr ? std::optional<ParameterValue>(*value) : std::nullopt;
}

/// The numbers of a list; empty where something has been reported.
std::vector<double> read_list(const Node& list, const std::string& subject, const NumberRules& rules,
                              const std::string& expected, const std::string& mend, Report& report) {
  if (!list.is_list() || list.items.empty()) {
    report.error(list.position, subject + " " + (list.is_list() ? "is empty" : "is " + description(list)), expected,
                 mend);
    return {};
  }
  std::vector<double> out;
  for (const Node& item : list.items) {
    const std::optional<Number> number = read_number(item, "an entry of " + subject, rules, report);
    if (!number) return {};
    out.push_back(number->value);
  }
  return out;
}

void read_span(const Node& table, const std::string& owner, WireTable& wire, Reading& reading) {
  const Entry* entry = table.find("span");
  if (entry == nullptr) return;
  const std::string subject = "'span' of " + owner, expected = "two arc lengths along the vessel, first and last",
                    mend = "write span = [\"0 mm\", \"320 mm\"]";
  NumberRules millimetres;
  millimetres.units = {"mm"};
  millimetres.lower = 0.0;
  wire.span = read_list(entry->value, subject, millimetres, expected, mend, reading.report);
  wire.span_position = entry->value.position.text();
  if (wire.span.empty()) return;
  if (wire.span.size() != 2) {
    reading.report.error(entry->value.position, subject + " has " + std::to_string(wire.span.size()) + " entries",
                         expected, mend);
  } else if (!(wire.span[0] < wire.span[1])) {
    reading.report.error(entry->value.position,
                         subject + " goes from " + decimal(wire.span[0]) + " mm to " + decimal(wire.span[1]) + " mm",
                         "an end beyond its beginning", "swap the two, or move them apart");
  } else if (wire.geometry || wire.vessel.empty()) {
    reading.report.error(
        entry->value.position, subject + (wire.geometry ? " beside a geometry of its own" : ", which has no vessel"),
        "it on a wire that starts along a vessel", "remove it, or let the wire start along its vessel");
  } else {
    return;
  }
  wire.span.clear();
}

void read_spacing(const Node& table, const std::string& owner, WireTable& wire, Reading& reading) {
  const Entry* entry = table.find("spacing");
  if (entry == nullptr) return;
  const std::string subject = "'spacing' of " + owner;
  NumberRules positive;
  positive.lower = 0.0;
  positive.lower_exclusive = true;
  wire.spacing = read_list(entry->value, subject, positive, "a list of each edge's share of the length",
                           "write one number per edge, summing to 1", reading.report);
  wire.spacing_position = entry->value.position.text();
  double sum = 0.0;
  for (const double fraction : wire.spacing) sum += fraction;
  if (wire.spacing.empty() || std::fabs(sum - 1.0) <= 1e-9) return;
  reading.report.error(entry->value.position, subject + " sums to " + decimal(sum), "shares that sum to 1",
                       "divide each by " + decimal(sum));
}

void check_radius_origin(const std::optional<ParameterValue>& radius, const Node& table, const std::string& owner,
                         Report& report) {
  if (!radius || radius->profile.measured_from == Profile::Origin::first_end) return;
  report.error(table.find("radius")->value.find("measured-from")->value.position,
               "'measured-from' in 'radius' of " + owner, "it on a wire only",
               "remove it: a vessel's arc length counts from its first end");
}

}  // namespace

std::vector<std::string> CurveNames::all() const {
  std::vector<std::string> names = vessels;
  names.insert(names.end(), wires.begin(), wires.end());
  return names;
}

CurveNames curve_names(const Node& root) {
  CurveNames names;
  for (const std::string kind : {"vessel", "wire"}) {
    const Entry* list = root.find(kind);
    if (list == nullptr) continue;
    if (!list->value.is_list()) names.complete = false;
    for (const Node& table : list->value.items) {
      const bool named = !table.text_at("name").empty();
      if (!named && (kind == "vessel" || table.find("name") != nullptr)) names.complete = false;
      const std::string name = named ? table.text_at("name") : kind;
      std::vector<std::string>& of_kind = kind == "vessel" ? names.vessels : names.wires;
      if (!contains_name(of_kind, name)) of_kind.push_back(name);
    }
  }
  return names;
}

void check_name(const Node& table, const std::string& owner, Report& report) {
  const Entry* name = table.find("name");
  if (name == nullptr) return;
  bool good = name->value.is_text() && !name->value.text.empty();
  for (const char letter : name->value.text) {
    good = good && letter != '.' && letter != '=' && static_cast<unsigned char>(letter) >= 0x20;
  }
  if (good) return;
  report.error(name->value.position, "'name' of " + owner + " is " + description(name->value),
               "text without '.' and '=', which paths are split at", "choose another name");
}

void check_reference(const Node& reference, const std::string& subject, const std::string& kind,
                     const std::vector<std::string>& candidates, const CurveNames& names, Report& report) {
  if (!reference.is_text()) {
    report.error(reference.position, subject + " is " + description(reference), "the name of a " + kind,
                 "write it in quotes");
    return;
  }
  if (contains_name(candidates, reference.text) || !names.complete) return;
  const std::vector<std::string> near = nearest_names(reference.text, candidates);
  std::string mend = near.empty() ? "name one that the file has" : did_you_mean(near);
  if (contains_name(names.all(), reference.text)) {
    const std::string other = kind == "vessel" ? "wire" : "vessel";
    mend = "'" + reference.text + "' is a " + other;
  }
  report.error(reference.position, "unknown " + kind + " '" + reference.text + "' in " + subject,
               candidates.empty() ? "a " + kind + ", but the file has none" : "one of: " + comma_separated(candidates),
               mend);
}

VesselTable read_vessel(const Node& table, Reading& reading) {
  VesselTable vessel;
  vessel.name = table.text_at("name");
  vessel.position = table.position.text();
  const std::string name = vessel.name.empty() ? "a vessel without a name" : "vessel '" + vessel.name + "'";
  if (!check_is_table(table, name, "write it under [[vessel]]", reading.report)) return vessel;
  if (table.find("name") == nullptr) {
    reading.report.error(table.position, name, "every vessel to have one", "add name = \"<name>\"");
  }
  check_name(table, name, reading.report);

  SchemaOwner owner = owner_of(name);
  owner.structural = {"name", "geometry", "ends", "kinematics"};
  Status no_fault;
  const ParameterSet values = read_parameters(table, owner, vessel_schema(), no_fault, reading.report);
  vessel.radius = optional_value(values, "radius");
  vessel.rigid = values.has("rigid") && values.flag("rigid");
  check_radius_origin(vessel.radius, table, name, reading.report);

  vessel.geometry = read_geometry(table, name, reading);
  vessel.kinematics = read_component_of(table, "kinematics", Kind::kinematics, default_kinematics, name, reading);
  read_ends(table, name, vessel.end, reading);
  return vessel;
}

WireTable read_wire(const Node& table, const CurveNames& names, Reading& reading) {
  WireTable wire;
  wire.name = label_of(table, "wire");
  wire.vessel = table.text_at("vessel");
  wire.position = table.position.text();
  const std::string name = "wire '" + wire.name + "'";
  if (!check_is_table(table, name, "write it under [[wire]]", reading.report)) return wire;
  check_name(table, name, reading.report);

  SchemaOwner owner = owner_of(name);
  owner.structural = {"name", "vessel", "geometry", "ends", "kinematics", "span", "spacing"};
  Status no_fault;
  const ParameterSet values = read_parameters(table, owner, wire_schema(), no_fault, reading.report);
  wire.nodes = values.has("nodes") ? static_cast<int>(values.integer("nodes")) : 0;
  if (values.has("radius")) wire.radius = values.at("radius");
  if (values.has("length")) {
    wire.length = values.text("length") == "sliding" ? LengthRule::sliding : LengthRule::fixed;
    wire.length_position = values.at("length").position;
  }
  const bool own_geometry = table.find("geometry") != nullptr;
  if (own_geometry) wire.geometry = read_geometry(table, name, reading);
  if (own_geometry && wire.nodes > 0) {
    reading.report.error(table.find("nodes")->value.position, "'nodes' of " + name + " beside a geometry of its own",
                         "the nodes of that geometry", "write them as 'nodes' of the geometry");
  }

  if (const Entry* vessel = table.find("vessel")) {
    check_reference(vessel->value, "'vessel' of " + name, "vessel", names.vessels, names, reading.report);
  } else if (!own_geometry) {
    reading.report.error(table.position, name + " has no 'vessel' and no 'geometry'",
                         "the vessel that the wire starts along, or a geometry of its own",
                         "add vessel = \"<name>\", or geometry = { type = \"<geometry>\", … }");
  }
  read_span(table, name, wire, reading);
  read_spacing(table, name, wire, reading);
  wire.kinematics = read_component_of(table, "kinematics", Kind::kinematics, default_kinematics, name, reading);
  read_ends(table, name, wire.end, reading);
  return wire;
}

}  // namespace bowstring
