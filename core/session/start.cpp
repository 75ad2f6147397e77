#include "core/session/start.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/composition/nearest.hpp"
#include "core/curve/arc_length.hpp"
#include "core/model/carried_curve.hpp"
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

/// Whether the numbers are of such a field.
bool fits(const FieldDeclaration& field, const NamedNumbers* numbers) {
  return numbers != nullptr && (numbers->manifold.empty() || numbers->manifold == manifold_name(field.manifold)) &&
         numbers->values.size() == at(field.count * coordinate_count(field.manifold, field.dimension));
}

/// Copies numbers that fit the field; tells what is wrong with them all the same.
void take_field(const FieldDeclaration& field, const NamedNumbers& numbers, const std::string& owner,
                std::vector<DocumentFlaw>& flaws, double* q) {
  const int each = coordinate_count(field.manifold, field.dimension);
  const auto not_finite =
      std::find_if(numbers.values.begin(), numbers.values.end(), [](double value) { return !std::isfinite(value); });
  if (not_finite != numbers.values.end()) {
    flaws.push_back(
        {owner + " has a number that is not finite, as number " + std::to_string(not_finite - numbers.values.begin()),
         "finite numbers", "start from a result whose state is known"});
    return;
  }
  for (int i = 0; is_curved(field.manifold) && i < field.count; ++i) {
    double squared = 0.0;
    for (int k = 0; k < each; ++k) squared += numbers.values[at(i * each + k)] * numbers.values[at(i * each + k)];
    if (std::fabs(std::sqrt(squared) - 1.0) > unit_length) {
      flaws.push_back(
          {owner + " has a quaternion of length " + number(std::sqrt(squared)) + " as entry " + std::to_string(i),
           "unit quaternions", "start from a result whose state is known"});
      return;
    }
  }
  std::copy(numbers.values.begin(), numbers.values.end(), q);
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

namespace {

/// Takes one curve of a carried state.
class CurveTaking {
 public:
  CurveTaking(const Curve& curve, const CarriedCurve& shape, const CarriedState& carried)
      : curve_(curve), shape_(shape), carried_(carried) {}

  std::vector<DocumentFlaw> flaws;
  std::string interpolated;        ///< what is told of it; "": nothing was
  std::vector<std::string> moved;  ///< fields that ends hold elsewhere, with by how much

  void run(double* q) {
    if (!curve_.state1.empty()) {  // the vessel is at its rest state
      if (!shape_.told.empty()) interpolated = "'" + curve_.name + "' " + shape_.told + ", as its rest state";
      return;
    }
    const bool whole = shape_.recorded && shape_.same_mesh && all_fields_fit();
    if (!whole && !adopt(q)) return;
    for (const FieldDeclaration& field : curve_.declaration.fields) {
      const NamedNumbers* numbers = recorded(field);
      const bool as_it_stands = whole || (shape_.same_mesh && fits(field, numbers));
      if (as_it_stands) {
        take_field(field, *numbers, "field '" + numbers->name + "' of " + carried_.name, flaws, q);
        if (!flaws.empty()) return;
      }
      // What is interpolated only comes near to what is held, but for the end nodes.
      const double ends = ends_moved(field, q), all = hold(field, q);
      const double by = as_it_stands ? all : ends;
      if (by > same_coordinate && shape_.recorded) {
        moved.push_back("'" + field_name(curve_, field) + "' by up to " + number(by));
      }
      q += field.count * coordinate_count(field.manifold, field.dimension);
    }
  }

 private:
  const NamedNumbers* recorded(const FieldDeclaration& field) const {
    return find(carried_.state->fields, field_name(curve_, field));
  }

  /// By how much the held coordinates of the end nodes differ from where the scene's own start has them.
  static double ends_moved(const FieldDeclaration& field, const double* q) {
    if (field.manifold != Manifold::vector || field.fixed.empty()) return 0.0;
    double moved = 0.0;
    for (const int node : {0, field.count - 1}) {
      for (int k = node * field.dimension; k < (node + 1) * field.dimension; ++k) {
        if (field.fixed[at(k)] != 0) moved = std::max(moved, std::fabs(q[k] - field.start[at(k)]));
      }
    }
    return moved;
  }

  bool all_fields_fit() const {
    const auto& fields = curve_.declaration.fields;
    if (!std::all_of(fields.begin(), fields.end(), [&](const auto& field) { return fits(field, recorded(field)); })) {
      return false;
    }
    const std::string prefix = curve_.name + ".";
    const auto own =
        std::count_if(carried_.state->fields.begin(), carried_.state->fields.end(),
                      [&](const NamedNumbers& numbers) { return numbers.name.compare(0, prefix.size(), prefix) == 0; });
    return own == static_cast<std::ptrdiff_t>(fields.size());
  }

  /// Writes the coordinates of the curve's shape; false where there are none, or where the scene's own start stays.
  bool adopt(double* q) {
    if (!shape_.recorded && shape_.orientation.empty()) return false;  // a wire that starts where it would without
    if (shape_.orientation.empty()) {
      flaws.push_back({"the numbers of '" + curve_.name + "' in " + carried_.name +
                           " do not fit, and it has the curve with " + shape_.flaw +
                           ", so that nothing can be "
                           "interpolated",
                       "a shape, or the fields " + field_names(), "start from a result that this version wrote"});
      return false;
    }
    std::vector<double> own(at(curve_.coordinates));
    const Status status = curve_.kinematics->adopt({shape_.points, shape_.orientation}, own);
    const bool finite = std::all_of(own.begin(), own.end(), [](double x) { return std::isfinite(x); });
    if (!status.ok() || !finite) {
      flaws.push_back({"kinematics '" + curve_.kinematics_name + "' of '" + curve_.name +
                           "' cannot take its shape in " + carried_.name + ": " +
                           (status.ok() ? "it gives numbers that are not finite" : status.text),
                       "a state that it can begin at", "start from a result of the same kinematics and nodes"});
      return false;
    }
    std::copy(own.begin(), own.end(), q);
    if (shape_.recorded) tell();
    return true;
  }

  void tell() {
    const RecordedCurve* before = carried_.state->find(curve_.name);
    interpolated = "'" + curve_.name + "'";
    std::string how = shape_.told;
    const auto add = [&](const std::string& text) { how += (how.empty() ? "" : ", ") + text; };
    if (before != nullptr && !before->kinematics.empty() && before->kinematics != curve_.kinematics_name) {
      add("from kinematics '" + before->kinematics + "' to '" + curve_.kinematics_name + "'");
    }
    if (how.empty()) add("to the fields " + field_names());
    interpolated += " " + how;
  }

  std::string field_names() const {
    std::string text;
    for (const FieldDeclaration& field : curve_.declaration.fields) {
      text += (text.empty() ? "" : ", ") + field.name + " in " + manifold_name(field.manifold);
    }
    return text.empty() ? "(none)" : text;
  }

  const Curve& curve_;
  const CarriedCurve& shape_;
  const CarriedState& carried_;
};

}  // namespace

std::vector<double> carried_coordinates(const Scene& scene, const CarriedState& carried, const CarriedCurves& shapes,
                                        std::vector<DocumentFlaw>& flaws, std::vector<std::string>& warnings) {
  const std::size_t flaws_before = flaws.size();
  std::vector<double> q = scene.start_coordinates();
  std::vector<std::string> interpolated, moved;
  for (const auto& curve : scene.curves) {
    CurveTaking taking(*curve, shapes.curves[at(curve->view.index)], carried);
    taking.run(q.data() + curve->coordinate_begin);
    flaws.insert(flaws.end(), taking.flaws.begin(), taking.flaws.end());
    if (!taking.interpolated.empty()) interpolated.push_back(taking.interpolated);
    moved.insert(moved.end(), taking.moved.begin(), taking.moved.end());
  }
  if (flaws.size() > flaws_before) return {};
  warnings.insert(warnings.end(), shapes.warnings.begin(), shapes.warnings.end());
  if (!interpolated.empty()) warnings.push_back(carried.name + " is interpolated: " + joined(interpolated, "; "));
  if (!moved.empty()) {
    warnings.push_back(carried.name +
                       " differs in what ends hold, which stays as this composition has it: " + comma_separated(moved));
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

namespace {

/// A group of rows along a curve, as far as it can be told where its rows stand: place after place from the curve's
/// first end to its last one, with as many rows each.
struct RowsAlong {
  int curve = -1;
  int each = 1;          ///< rows of one place
  bool on_edges = true;  ///< closure rows; else between the ends, on nodes or more densely
};

RowsAlong rows_along(const Scene& scene, const RowOrigin& group) {
  RowsAlong out;
  out.curve = group.curve;
  if (group.constraint < 0) {
    const SiteDeclaration* site = scene.curves[at(group.curve)]->site(Site::closure);
    if (site != nullptr) out.each = site->values;
    return out;
  }
  const ConstraintUse& use = scene.constraints[at(group.constraint)];
  out.on_edges = false;
  if (use.scene.on.empty()) return out;
  out.curve = use.scene.on.front().index;
  const auto first_place = [&](int row) { return use.rows.places[at(use.rows.place_begin[at(row)])]; };
  const auto same = [](const Place& a, const Place& b) {
    return a.curve == b.curve && a.site == b.site && a.index == b.index;
  };
  for (int row = 0; row < use.rows.rows; ++row) {
    if (use.rows.place_begin[at(row)] == use.rows.place_begin[at(row + 1)]) return out;
  }
  while (out.each < use.rows.rows && same(first_place(out.each), first_place(0))) ++out.each;
  return out;
}

/// The shares of material at which `places` places stand on a curve whose nodes lie at `node_share`.
std::vector<double> place_shares(int places, bool on_edges, const std::vector<double>& node_share) {
  std::vector<double> index(node_share.size()), out;
  for (std::size_t i = 0; i < index.size(); ++i) index[i] = static_cast<double>(i);
  for (int i = 0; i < places; ++i) {
    const double part = on_edges ? (i + 0.5) / places : (i + 1.0) / (places + 1.0);
    out.push_back(interpolate_linearly(index, node_share, part * index.back()));
  }
  return out;
}

/// How much of the material each of these places stands for.
std::vector<double> place_weights(const std::vector<double>& share, const std::vector<double>& node_share) {
  std::vector<double> out;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double before = i > 0 ? share[i - 1] : node_share.front();
    const double after = i + 1 < share.size() ? share[i + 1] : node_share.back();
    out.push_back(0.5 * (after - before));
  }
  return out;
}

/// Multipliers of rows on another mesh: of closure rows, which are forces within the curve, linear in the material; of
/// others, which are forces on what their place stands for, as a density. 0 outside of what was recorded.
std::vector<double> interpolated_multipliers(const std::vector<double>& recorded, const std::vector<double>& before,
                                             const std::vector<double>& now, int count, const RowsAlong& rows) {
  const int places_before = static_cast<int>(recorded.size()) / rows.each, places = count / rows.each;
  const std::vector<double> from = place_shares(places_before, rows.on_edges, before);
  const std::vector<double> to = place_shares(places, rows.on_edges, now);
  const std::vector<double> weight_from = place_weights(from, before), weight_to = place_weights(to, now);
  std::vector<double> out(at(count), 0.0), density(from.size());
  for (int k = 0; k < rows.each; ++k) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      density[i] = recorded[i * at(rows.each) + at(k)] / (rows.on_edges ? 1.0 : weight_from[i]);
    }
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (to[i] < 0.0 || to[i] > 1.0) continue;
      out[i * at(rows.each) + at(k)] =
          interpolate_linearly(from, density, to[i]) * (rows.on_edges ? 1.0 : weight_to[i]);
    }
  }
  return out;
}

}  // namespace

std::vector<double> carried_multipliers(const Scene& scene, const std::vector<RowOrigin>& rows,
                                        const CarriedState& carried, const CarriedCurves& shapes,
                                        std::vector<std::string>& warnings) {
  const std::string& name = carried.name;
  const RecordedState& state = *carried.state;
  std::vector<double> out;
  std::vector<std::string> without;
  for (const RowOrigin& group : rows) {
    const NamedNumbers* numbers = find(state.multipliers, group.name);
    const RowsAlong along = rows_along(scene, group);
    const bool other_mesh = along.curve >= 0 && !shapes.curves[at(along.curve)].same_mesh;
    if (!other_mesh && numbers != nullptr && numbers->values.size() == at(group.count)) {
      out.insert(out.end(), numbers->values.begin(), numbers->values.end());
      continue;
    }
    if (!other_mesh) {
      out.resize(out.size() + at(group.count), 0.0);
      warnings.push_back(
          name + " has " +
          (numbers == nullptr ? "no multipliers" : std::to_string(numbers->values.size()) + " multipliers") + " of '" +
          group.name + "', which has " + std::to_string(group.count) +
          " rows here: its state is taken, and these multipliers start at 0");
      continue;
    }
    const Curve& curve = *scene.curves[at(along.curve)];
    const CarriedCurve& shape = shapes.curves[at(along.curve)];
    const RecordedCurve* recorded = state.find(curve.name);
    const bool same_rows = numbers != nullptr && recorded != nullptr && !shape.share.empty() &&
                           !numbers->values.empty() && numbers->values.size() % at(along.each) == 0 &&
                           (!along.on_edges || recorded->kinematics == curve.kinematics_name);
    if (same_rows) {
      const std::vector<double> made =
          interpolated_multipliers(numbers->values, recorded->share, shape.share, group.count, along);
      out.insert(out.end(), made.begin(), made.end());
    } else {
      out.resize(out.size() + at(group.count), 0.0);
      without.push_back("'" + group.name + "'");
    }
  }
  if (!without.empty()) {
    warnings.push_back("multipliers of rows that " + name +
                       " does not have, or on another mesh, start at 0: " + comma_separated(without));
  }
  for (const NamedNumbers& numbers : state.multipliers) {
    const bool known =
        std::any_of(rows.begin(), rows.end(), [&](const RowOrigin& g) { return g.name == numbers.name; });
    if (!known) warnings.push_back(name + " has multipliers of '" + numbers.name + "', which has no rows here");
  }
  return out;
}

Start start_from(const Scene& scene, const std::vector<RowOrigin>& rows, const CarriedState& carried,
                 std::vector<DocumentFlaw>& flaws) {
  Start start;
  std::vector<NamedKind> curves;
  for (const auto& curve : scene.curves) curves.emplace_back(curve->name, curve->view.kind);
  compare_scenes(scene.dimension, curves, carried, flaws);
  if (!flaws.empty()) return start;
  const CarriedCurves shapes = carried_curves(scene, carried, flaws);
  if (!flaws.empty()) return start;
  start.q = carried_coordinates(scene, carried, shapes, flaws, start.warnings);
  if (!flaws.empty()) return start;
  start.multipliers = carried_multipliers(scene, rows, carried, shapes, start.warnings);
  start.origin = {carried.file, carried.state->sha256};
  for (const CarriedCurve& curve : shapes.curves) {
    start.previous.push_back(curve.recorded ? curve.points : std::vector<double>{});
  }
  return start;
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
