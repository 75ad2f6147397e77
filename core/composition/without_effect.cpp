#include "core/composition/without_effect.hpp"

#include <algorithm>
#include <cstddef>

#include "core/composition/keys.hpp"

namespace bowstring {
namespace {

/// Goes through a composition and the tree that it was read from, entry by entry.
class Idle {
 public:
  Idle(const Node& root, const Composition& composition) : root_(root), composition_(composition) {}

  std::vector<std::string> notes() {
    for (std::size_t i = 0; i < composition_.vessels.size(); ++i)
      note_vessel(item("vessel", i), composition_.vessels[i]);
    for (std::size_t i = 0; i < composition_.wires.size(); ++i) note_wire(item("wire", i), composition_.wires[i]);
    for (const EnergyTable& energy : composition_.energies) note_energy(energy);
    if (composition_.constraints.empty()) note_without_rows();
    return notes_;
  }

 private:
  const Node& item(const char* table, std::size_t i) const { return root_.find(table)->value.items[i]; }

  void note(const std::string& position, const std::string& what, const std::string& why) {
    notes_.push_back(position + ": " + what + " has no effect: " + why);
  }

  void note_key(const Node& table, const char* key, const std::string& owner, const std::string& why) {
    if (const Entry* entry = table.find(key)) {
      note(entry->position.text(), "'" + std::string(key) + "' of " + owner, why);
    }
  }

  bool is_constrained(const std::string& curve) const {
    return std::any_of(composition_.constraints.begin(), composition_.constraints.end(),
                       [&](const ConstraintTable& constraint) { return contains_name(constraint.on, curve); });
  }

  void note_vessel(const Node& table, const VesselTable& vessel) {
    const std::string owner = "vessel '" + vessel.name + "'";
    if (!is_constrained(vessel.name)) note_key(table, "radius", owner, "no constraint acts on it");
    if (vessel.rigid) {
      note_key(table, "ends", owner, "a rigid vessel has no unknowns");
      note_key(table, "kinematics", owner, "a rigid vessel has no unknowns");
    } else {
      note_tangents(vessel.end, owner);
    }
  }

  void note_wire(const Node& table, const WireTable& wire) {
    const std::string owner = "wire '" + wire.name + "'";
    if (!is_constrained(wire.name)) note_key(table, "radius", owner, "no constraint acts on it");
    note_tangents(wire.end, owner);
  }

  void note_tangents(const EndTable (&ends)[2], const std::string& owner) {
    for (int i = 0; i < 2; ++i) {
      if (ends[i].tangent.empty() || ends[i].rotation_held || ends[i].in_end_axes) continue;
      note(ends[i].position, std::string("'tangent' of the ") + (i == 0 ? "first" : "last") + " end of " + owner,
           "an end that is " + ends[i].text(composition_.dimension) + " holds no tangent");
    }
  }

  void note_energy(const EnergyTable& energy) {
    for (const VesselTable& vessel : composition_.vessels) {
      if (vessel.rigid && vessel.name == energy.on) {
        note(energy.component.position, "energy '" + energy.label + "'",
             "vessel '" + vessel.name + "' is rigid and has no unknowns");
      }
    }
  }

  void note_without_rows() {
    const std::string why = "the scene has no constraint";
    if (const Entry* enforcement = root_.find("enforcement")) {
      note(enforcement->value.position.text(), "[enforcement]", why);
    }
    if (const Entry* certificate = root_.find("certificate")) {
      note_key(certificate->value, "complementarity", "[certificate]", why);
      note_key(certificate->value, "multiplier", "[certificate]", why);
    }
  }

  const Node& root_;
  const Composition& composition_;
  std::vector<std::string> notes_;
};

}  // namespace

std::vector<std::string> without_effect(const Node& root, const Composition& composition) {
  return Idle(root, composition).notes();
}

}  // namespace bowstring
