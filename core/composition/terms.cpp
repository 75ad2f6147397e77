#include "core/composition/terms.hpp"

#include <algorithm>
#include <string>

#include "core/composition/keys.hpp"
#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

ComponentUse use_of(Kind kind, const std::string& owner) {
  ComponentUse use;
  use.kind = kind;
  use.owner = owner;
  use.structural = {"type", "name", "on"};
  use.owner_names_type = true;
  return use;
}

/// "a profile measured from the tip" makes sense where there is a tip.
void check_origins(const Node& table, const ComponentChoice& component, const std::string& owner, Report& report) {
  for (const ParameterValue& value : component.parameters.values) {
    if (value.type != ParameterType::profile || value.profile.measured_from == Profile::Origin::first_end) continue;
    const Entry* entry = table.find(value.key);
    if (entry == nullptr) continue;
    report.error(entry->value.find("measured-from")->value.position,
                 "'measured-from' in '" + value.key + "' of " + owner + ", which acts on a vessel", "it on a wire only",
                 "remove it: a vessel's arc length counts from its first end");
  }
}

/// Both curves at once: `on = [wire, vessel]`.
/// One curve or more; a wire before the vessel that it lies in.
void check_curves(const Node& on, const std::string& owner, const CurveNames& names, Report& report) {
  const std::string subject = "'on' of " + owner;
  if (!on.is_list() || on.items.empty()) {
    report.error(on.position, subject + " " + (on.is_list() ? "is empty" : "is " + description(on)),
                 "a list of curves, for contact [wire, vessel]", "write on = [\"<wire>\", \"<vessel>\"]");
    return;
  }
  if (on.items.size() == 2 && contains_name(names.vessels, on.items[0].text) &&
      contains_name(names.wires, on.items[1].text)) {
    report.error(on.position, subject + " has the vessel first", "[wire, vessel]",
                 "write on = [\"" + on.items[1].text + "\", \"" + on.items[0].text + "\"]");
    return;
  }
  for (const Node& curve : on.items) check_reference(curve, subject, "curve", names.all(), names, report);
}

void report_missing_on(const Node& table, const std::string& owner, const std::string& expected,
                       const std::string& mend, Report& report) {
  report.error(table.position, owner + " has no 'on'", expected, mend);
}

}  // namespace

EnergyTable read_energy(const Node& table, const CurveNames& names, Reading& reading) {
  EnergyTable energy;
  energy.label = label_of(table, "energy");
  energy.on = table.text_at("on");
  const std::string owner = "energy '" + energy.label + "'";
  if (!check_is_table(table, owner, "write it under [[energy]]", reading.report)) return energy;
  check_name(table, owner, reading.report);
  if (energy.label == "total") {
    reading.report.error(table.find("name")->value.position, "'name' of " + owner + " is 'total'",
                         "a name that results do not use for the sum of all energies", "choose another name");
  }
  if (const Entry* on = table.find("on")) {
    check_reference(on->value, "'on' of " + owner, "curve", names.all(), names, reading.report);
  } else {
    report_missing_on(table, owner, "the curve that it acts on", "add on = \"<curve>\"", reading.report);
  }
  energy.component = read_component(table, use_of(Kind::energy, owner), reading);
  if (contains_name(names.vessels, energy.on)) check_origins(table, energy.component, owner, reading.report);
  return energy;
}

ConstraintTable read_constraint(const Node& table, const CurveNames& names, Reading& reading) {
  ConstraintTable constraint;
  constraint.label = label_of(table, "constraint");
  const std::string owner = "constraint '" + constraint.label + "'";
  if (!check_is_table(table, owner, "write it under [[constraint]]", reading.report)) return constraint;
  check_name(table, owner, reading.report);
  if (const Entry* on = table.find("on")) {
    for (const Node& curve : on->value.items) constraint.on.push_back(curve.text);
    check_curves(on->value, owner, names, reading.report);
  } else {
    report_missing_on(table, owner, "a list of curves, for contact [wire, vessel]",
                      "add on = [\"<wire>\", \"<vessel>\"]", reading.report);
  }
  constraint.component = read_component(table, use_of(Kind::constraint, owner), reading);
  return constraint;
}

}  // namespace bowstring
