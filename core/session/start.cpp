#include "core/session/start.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double unit_length = 1e-6;      // by how much a stored quaternion's length may miss 1
constexpr double same_coordinate = 1e-9;  // mm or rad: held coordinates that differ by more are told

const NamedNumbers* find(const std::vector<NamedNumbers>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const NamedNumbers& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string field_name(const Curve& curve, const FieldDeclaration& field) { return curve.name + "." + field.name; }

std::string field_names(const Scene& scene) {
  std::string text;
  for (const auto& curve : scene.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      text += (text.empty() ? "" : ", ") + field_name(*curve, field);
    }
  }
  return text.empty() ? "none" : text;
}

/// Whether the numbers fit the field; appends them to q.
bool take_field(const FieldDeclaration& field, const NamedNumbers& numbers, const std::string& owner,
                std::vector<DocumentFlaw>& flaws, std::vector<double>& q) {
  const int each = coordinate_count(field.manifold, field.dimension);
  const std::string own = manifold_name(field.manifold);
  const auto flaw = [&](const std::string& found, const std::string& expected) {
    flaws.push_back({owner + found, expected, "the same kinematics and nodes are needed"});
    return false;
  };
  if (!numbers.manifold.empty() && numbers.manifold != own) {
    return flaw(" lies in " + numbers.manifold, "one in " + own + ", as in this scene");
  }
  if (numbers.values.size() != at(field.count * each)) {
    return flaw(" has " + std::to_string(numbers.values.size()) + " numbers",
                std::to_string(field.count * each) + ", as in this scene");
  }
  const auto not_finite =
      std::find_if(numbers.values.begin(), numbers.values.end(), [](double value) { return !std::isfinite(value); });
  if (not_finite != numbers.values.end()) {
    flaws.push_back(
        {owner + " has a number that is not finite, as number " + std::to_string(not_finite - numbers.values.begin()),
         "finite numbers", "start from a result whose state is known"});
    return false;
  }
  for (int i = 0; is_curved(field.manifold) && i < field.count; ++i) {
    double squared = 0.0;
    for (int k = 0; k < each; ++k) squared += numbers.values[at(i * each + k)] * numbers.values[at(i * each + k)];
    if (std::fabs(std::sqrt(squared) - 1.0) > unit_length) {
      return flaw(" has a quaternion of length " + number(std::sqrt(squared)) + " as entry " + std::to_string(i),
                  "unit quaternions");
    }
  }
  q.insert(q.end(), numbers.values.begin(), numbers.values.end());
  return true;
}

/// Puts what the field holds where the scene's own start has it; answers by how much anything had to move.
double hold(const FieldDeclaration& field, double* q) {
  if (field.fixed.empty()) return 0.0;
  const int each = coordinate_count(field.manifold, field.dimension);
  const int tangents = tangent_count(field.manifold, field.dimension);
  double moved = 0.0;
  for (int i = 0; i < field.count; ++i) {
    const char* fixed = field.fixed.data() + i * tangents;
    const double* own = field.start.data() + i * each;
    double* entry = q + i * each;
    if (is_curved(field.manifold)) {
      // A rotation that is held in part keeps what it is held to only as a whole.
      if (std::none_of(fixed, fixed + tangents, [](char held) { return held != 0; })) continue;
      const Vector3 turn = lie::log(lie::Rotation::load(own).inverse() * lie::Rotation::load(entry));
      double largest = 0.0;
      for (int k = 0; k < tangents; ++k) {
        const int axis = field.manifold == Manifold::direction ? k + 1 : k;
        if (fixed[k] != 0) largest = std::max(largest, std::fabs(turn[axis]));
      }
      const bool wholly = std::all_of(fixed, fixed + tangents, [](char held) { return held != 0; });
      if (wholly || largest > same_coordinate) std::copy_n(own, each, entry);
      moved = std::max(moved, largest);
      continue;
    }
    for (int k = 0; k < each; ++k) {
      if (fixed[k] == 0) continue;
      moved = std::max(moved, std::fabs(entry[k] - own[k]));
      entry[k] = own[k];
    }
  }
  return moved;
}

}  // namespace

const char* manifold_name(Manifold manifold) noexcept {
  switch (manifold) {
    case Manifold::real:
      return "R";
    case Manifold::vector:
      return "R^n";
    case Manifold::circle:
      return "S1";
    case Manifold::direction:
      return "S2";
    case Manifold::rotation:
      break;
  }
  return "SO3";
}

std::vector<double> recorded_coordinates(const Scene& scene, const RecordedState& state, const std::string& name,
                                         std::vector<DocumentFlaw>& flaws, std::vector<std::string>& warnings) {
  const std::size_t flaws_before = flaws.size();
  std::vector<double> q;
  std::vector<std::string> known, moved;
  for (const auto& curve : scene.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      const std::string label = field_name(*curve, field);
      known.push_back(label);
      const NamedNumbers* numbers = find(state.fields, label);
      if (numbers == nullptr) {
        flaws.push_back({name + " has no field '" + label + "'", "the fields of this scene: " + field_names(scene),
                         "start from a result of the same curves and kinematics"});
        continue;
      }
      const std::size_t first = q.size();
      if (!take_field(field, *numbers, "field '" + label + "' of " + name, flaws, q)) continue;
      const double by = hold(field, q.data() + first);
      if (by > same_coordinate) moved.push_back("'" + label + "' by up to " + number(by));
    }
  }
  for (const NamedNumbers& numbers : state.fields) {
    if (std::find(known.begin(), known.end(), numbers.name) != known.end()) continue;
    flaws.push_back({name + " has a field '" + numbers.name + "', which this scene does not have",
                     "the fields of this scene: " + field_names(scene),
                     "start from a result of the same curves and kinematics"});
  }
  if (flaws.size() > flaws_before) return {};
  if (!moved.empty()) {
    std::string text = name + " differs in what ends hold, which stays as this composition has it: ";
    for (std::size_t i = 0; i < moved.size(); ++i) text += (i > 0 ? ", " : "") + moved[i];
    warnings.push_back(text);
  }
  return q;
}

void hold_ends(const Scene& scene, std::vector<double>& q) {
  std::size_t first = 0;
  for (const auto& curve : scene.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      hold(field, q.data() + first);
      first += at(field.count * coordinate_count(field.manifold, field.dimension));
    }
  }
}

std::vector<double> recorded_multipliers(const std::vector<RowOrigin>& rows, const RecordedState& state,
                                         const std::string& name, std::vector<std::string>& warnings) {
  std::vector<double> out;
  for (const RowOrigin& group : rows) {
    const NamedNumbers* numbers = find(state.multipliers, group.name);
    if (numbers != nullptr && numbers->values.size() == at(group.count)) {
      out.insert(out.end(), numbers->values.begin(), numbers->values.end());
      continue;
    }
    warnings.push_back(
        name + " has " +
        (numbers == nullptr ? "no multipliers" : std::to_string(numbers->values.size()) + " multipliers") + " of '" +
        group.name + "', which has " + std::to_string(group.count) +
        " rows here: its state is taken, and these multipliers start at 0");
    out.resize(out.size() + at(group.count), 0.0);
  }
  for (const NamedNumbers& numbers : state.multipliers) {
    const bool known =
        std::any_of(rows.begin(), rows.end(), [&](const RowOrigin& g) { return g.name == numbers.name; });
    if (!known) warnings.push_back(name + " has multipliers of '" + numbers.name + "', which has no rows here");
  }
  return out;
}

RecordedState record_state(const Scene& scene, const std::vector<RowOrigin>& rows, const std::vector<double>& q,
                           const std::vector<double>& multipliers) {
  RecordedState out;
  auto from = q.begin();
  for (const auto& curve : scene.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      const auto end = from + field.count * coordinate_count(field.manifold, field.dimension);
      out.fields.push_back({field_name(*curve, field), manifold_name(field.manifold), {from, end}});
      from = end;
    }
  }
  for (const RowOrigin& group : rows) {
    const auto first = multipliers.begin() + group.first;
    out.multipliers.push_back({group.name, "", {first, first + group.count}});
  }
  return out;
}

}  // namespace bowstring
