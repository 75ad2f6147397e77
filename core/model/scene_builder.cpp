#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/contact/centerline.hpp"
#include "core/curve/arc_length.hpp"
#include "core/lie/s2.hpp"
#include "core/model/carried_curve.hpp"
#include "core/model/declarations.hpp"
#include "core/model/manifold.hpp"
#include "core/model/scene.hpp"
#include "core/model/start_shape.hpp"
#include "core/model/unheld_load.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double largest_tube_curvature = 0.8;  // R κ from which a tube counts as folded into itself

std::string number(double value, int digits = 4) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string point_text(const double* p, int dimension) {
  std::string text = "(";
  for (int k = 0; k < dimension; ++k) text += (k > 0 ? ", " : "") + number(p[k], 5);
  return text + ") mm";
}

class Builder {
 public:
  Builder(const Composition& composition, const SolverTraits& traits, const CarriedState* carried)
      : composition_(composition), traits_(traits), carried_(carried), scene_(std::make_unique<Scene>()) {
    scene_->dimension = composition.dimension;
    new_rest_ = carried != nullptr && carried->becomes_rest.value_or(composition.start.rest_is_previous);
  }

  SceneOutcome build() {
    if (carried_ != nullptr) compare_with_carried();
    if (going()) {
      for (const VesselTable& table : composition_.vessels) add_vessel(table);
    }
    if (going()) {
      for (const WireTable& table : composition_.wires) add_wire(table);
    }
    if (going() && carried_ != nullptr) carry();
    if (going()) declare_energies();
    if (going()) declare_kinematics();
    if (going()) sample_laws();
    if (going()) declare_constraints();
    if (going()) check_loads();
    if (!going()) scene_.reset();
    return {std::move(scene_), std::move(carried_curves_), std::move(errors_), std::move(plugin_failure_)};
  }

 private:
  bool going() const { return errors_.empty() && plugin_failure_.ok(); }

  void error(const std::string& position, std::string found, std::string expected, std::string mend) {
    errors_.push_back({position, std::move(found), std::move(expected), std::move(mend)});
  }

  /// Sorts a component's refusal into the user's errors or the plugin's failures.
  bool passed(const Status& status, const ComponentChoice& choice) {
    if (status.ok()) return true;
    if (status.code == Code::invalid_input || status.code == Code::unsupported) {
      error(choice.position, status.text, "", "");
    } else if (plugin_failure_.ok()) {
      plugin_failure_ = status;
    }
    return false;
  }

  /// Keeps what is wrong with a declaration as the plugin's failure.
  bool sound(const std::string& flaw, const ComponentChoice& choice, const std::string& owner) {
    if (flaw.empty()) return true;
    if (plugin_failure_.ok()) {
      plugin_failure_ = Status::failure(
          Code::failed, std::string(kind_name(choice.kind)) + " '" + choice.name + "' of " + owner + " " + flaw);
    }
    return false;
  }

  void refuse_carried(std::vector<DocumentFlaw>& flaws);
  void compare_with_carried();
  void carry();
  void set_rest(Curve& curve);
  void set_rest_rotation(Curve& curve, const RecordedCurve& recorded, int end);
  void move_from_start(const Curve& curve);
  void set_held_places(Curve& curve, const double (&moves)[2][3]) const;
  void set_geometry(Curve& curve, CurveGeometry&& geometry);
  bool check_points(const Curve& curve, const std::string& position);
  void set_ends(Curve& curve, const EndTable* ends);
  std::vector<double> end_tangent(const Curve& curve, const EndTable& table, int end,
                                  const std::vector<double>& from_geometry) const;
  void set_prescribed(Curve& curve, const EndTable& table, int end);
  bool held_along(const Curve& curve, int end) const;
  void hold_axes(const Curve& curve);
  void spread_moves(Curve& curve) const;
  void spread_turns(Curve& curve) const;
  void finish_view(Curve& curve, const WireTable* wire = nullptr);
  bool read_geometry(Curve& curve, const ComponentChoice& choice, const EndTable* ends);
  void add_vessel(const VesselTable& table);
  void check_tube(const Curve& curve, const std::string& position);
  void add_wire(const WireTable& table);
  bool start_wire(Curve& wire, const Curve& vessel, const WireTable& table);
  bool grade(Curve& wire, const WireTable& table);
  void regrade(Curve& curve, const std::vector<double>& share) const;
  Extension wire_extension(const Curve& wire, const WireTable& table);
  void declare_energies();
  void note_without_effect(const std::string& owner, const ParameterSet& parameters,
                           const std::vector<IdleParameter>& without_effect);
  void declare_kinematics();
  void sample_laws();
  bool sample_law(EnergyUse& use, LawUse& law, const ComponentChoice& choice);
  void declare_constraints();
  void check_loads();
  Curve* find(const std::string& name) const {
    for (const auto& curve : scene_->curves) {
      if (curve->name == name) return curve.get();
    }
    return nullptr;
  }
  const ComponentChoice& kinematics_choice(std::size_t curve) const {
    return curve < composition_.vessels.size() ? composition_.vessels[curve].kinematics
                                               : composition_.wires[curve - composition_.vessels.size()].kinematics;
  }

  /// Whether some constraint names all of these curves: only then do their radii matter.
  bool is_constrained(const std::vector<std::string>& names) const {
    return std::any_of(composition_.constraints.begin(), composition_.constraints.end(), [&](const ConstraintTable& c) {
      return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        return std::find(c.on.begin(), c.on.end(), name) != c.on.end();
      });
    });
  }

  const Composition& composition_;
  SolverTraits traits_;
  const CarriedState* carried_;
  bool new_rest_ = false;  // the carried state becomes the rest state
  CarriedCurves carried_curves_;
  std::unique_ptr<Scene> scene_;
  std::vector<InputError> errors_;
  Status plugin_failure_;
  std::vector<double> tangents_[2];  // of the geometry that is being read
  // Of the ends that are being read, in global axes, and of all curves.
  double moves_[2][3] = {};
  Turn turns_[2];
  std::vector<double> free_axes_[2];  // unit vectors, three numbers each
  std::vector<HeldAxis> oblique_[2];
};

void Builder::refuse_carried(std::vector<DocumentFlaw>& flaws) {
  for (DocumentFlaw& flaw : flaws) {
    error(carried_->position, std::move(flaw.found), std::move(flaw.expected), std::move(flaw.mend));
  }
}

void Builder::compare_with_carried() {
  std::vector<NamedKind> curves;
  for (const VesselTable& table : composition_.vessels) curves.emplace_back(table.name, CurveKind::vessel);
  for (const WireTable& table : composition_.wires) curves.emplace_back(table.name, CurveKind::wire);
  std::vector<DocumentFlaw> flaws;
  compare_scenes(composition_.dimension, curves, *carried_, flaws);
  for (const VesselTable& table : composition_.vessels) {
    if (!new_rest_ || !flaws.empty()) break;
    const RecordedCurve* recorded = carried_->state->find(table.name);
    if (recorded != nullptr && recorded->flaw.empty()) continue;
    flaws.push_back({carried_->name + " has '" + table.name + "' with " +
                         (recorded != nullptr ? recorded->flaw : "no entry in 'curves'"),
                     "its shape, which becomes the rest state", "start from a result that this version wrote"});
  }
  refuse_carried(flaws);
}

void Builder::carry() {
  std::vector<DocumentFlaw> flaws;
  carried_curves_ = carried_curves(*scene_, *carried_, flaws);
  refuse_carried(flaws);
  if (!going()) return;
  for (const auto& curve : scene_->curves) {
    const CarriedCurve& carried = carried_curves_.curves[at(curve->view.index)];
    if (carried.recorded) curve->previous = carried.points;
    curve->view.previous = curve->previous.empty() ? nullptr : curve->previous.data();
  }
}

/// The carried shape becomes the vessel's reference; its ends stay where State 1 has them moved and turned to.
void Builder::set_rest(Curve& curve) {
  const RecordedCurve& recorded = *carried_->state->find(curve.name);
  curve.arc = polyline_arc(curve.reference, composition_.dimension);
  std::vector<double> points = interpolated_points(recorded, material_shares(curve));
  curve.state1 = std::move(curve.reference);
  curve.reference = curve.start = std::move(points);
  for (int e = 0; e < 2; ++e) {
    if (!curve.held_frame[e].empty()) set_rest_rotation(curve, recorded, e);
  }
}

/// What a clamp holds in the rest state, and how far it is turned from there.
void Builder::set_rest_rotation(Curve& curve, const RecordedCurve& recorded, int e) {
  EndCondition& end = curve.view.end[e];
  const lie::Rotation now = lie::Rotation::load(curve.held_frame[e].data());
  Vector3 tangent, turn;
  if (!recorded.held_frame[e].empty()) {
    const lie::Rotation then = lie::Rotation::load(recorded.held_frame[e].data());
    tangent = then.first_axis();
    if (recorded.held_frame[e] != curve.held_frame[e]) turn = lie::log(now * then.inverse());
  } else {
    tangent = Vector3::load(end_tangent(curve, {}, e, {}).data());
    const lie::Rotation free = lie::frame_from_tangent(tangent);
    turn = lie::log(lie::transport(free, now.first_axis()) * free.inverse());
  }
  tangent.store(end.tangent);
  turn.store(end.turn);
  end.twist = 0.0;
  turns_[e] = {turn, 0.0};
}

/// What the ends hold is given from State 1: from here on `moves_` leads there from the ends of the start.
void Builder::move_from_start(const Curve& curve) {
  const int d = composition_.dimension;
  for (int e = 0; e < 2; ++e) {
    const std::size_t first = at((e == 0 ? 0 : curve.view.nodes - 1) * d);
    const double* from = curve.start.data() + first;
    double way[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < d; ++k) {
      if (curve.view.end[e].position_held[k]) way[k] = curve.state1_points()[first + at(k)] + moves_[e][k] - from[k];
    }
    for (const HeldAxis& held : oblique_[e]) {
      double miss = held.value;
      for (int k = 0; k < d; ++k) miss -= held.axis[k] * from[k];
      for (int k = 0; k < d; ++k) way[k] += held.axis[k] * miss;
    }
    if (curve.view.rigid) std::fill_n(way, 3, 0.0);
    std::copy_n(way, 3, moves_[e]);
  }
}

void Builder::set_held_places(Curve& curve, const double (&moves)[2][3]) const {
  const int d = composition_.dimension, last = curve.view.nodes - 1;
  for (const int node : {0, 1, last - 1, last}) {
    for (int k = 0; k < d; ++k) {
      if (curve.view.rigid || !position_held(curve.view, node, k)) continue;
      curve.start[at(node * d + k)] = curve.state1_points()[at(node * d + k)] + moves[node <= 1 ? 0 : 1][k];
    }
  }
}

void Builder::set_geometry(Curve& curve, CurveGeometry&& geometry) {
  curve.view.dimension = composition_.dimension;
  curve.view.nodes = static_cast<int>(geometry.points.size()) / composition_.dimension;
  curve.reference = std::move(geometry.points);
  curve.start = curve.reference;
  curve.data = std::move(geometry.data);
  curve.label = std::move(geometry.label);
  tangents_[0] = std::move(geometry.first_tangent);
  tangents_[1] = std::move(geometry.last_tangent);
}

bool Builder::check_points(const Curve& curve, const std::string& position) {
  const int d = composition_.dimension;
  if (curve.view.nodes < 3) {
    error(position, "a geometry of " + std::to_string(curve.view.nodes) + " nodes for '" + curve.name + "'",
          "at least 3", "");
    return false;
  }
  for (int i = 0; i < curve.view.nodes; ++i) {
    const double* p = curve.reference.data() + at(i * d);
    for (int k = 0; k < d; ++k) {
      if (std::isfinite(p[k])) continue;
      error(position,
            "a coordinate that is not a finite number at node " + std::to_string(i) + " of '" + curve.name + "'",
            "finite coordinates", "");
      return false;
    }
    if (i == 0) continue;
    double squared = 0.0;
    for (int k = 0; k < d; ++k) squared += (p[k] - p[k - d]) * (p[k] - p[k - d]);
    if (squared > 0.0) continue;
    error(position,
          "nodes " + std::to_string(i - 1) + " and " + std::to_string(i) + " of '" + curve.name + "' coincide at " +
              point_text(p, d),
          "nodes apart from each other", "drop one of them or give 'nodes' so that the curve is sampled anew");
    return false;
  }
  return true;
}

std::vector<double> Builder::end_tangent(const Curve& curve, const EndTable& table, int end,
                                         const std::vector<double>& from_geometry) const {
  const int d = composition_.dimension;
  std::vector<double> tangent(3, 0.0);
  if (!table.tangent.empty()) {
    std::copy(table.tangent.begin(), table.tangent.end(), tangent.begin());
  } else if (!from_geometry.empty()) {
    std::copy(from_geometry.begin(), from_geometry.end(), tangent.begin());
  } else {
    // Derivative at the end of the parabola through the three end nodes, parametrised by chord length.
    const int n = curve.view.nodes;
    const int i0 = end == 0 ? 0 : n - 1;
    const int step = end == 0 ? 1 : -1;
    const double* p0 = curve.start.data() + at(i0 * d);
    const double* p1 = curve.start.data() + at((i0 + step) * d);
    const double* p2 = curve.start.data() + at((i0 + 2 * step) * d);
    double a = 0.0, b = 0.0;
    for (int k = 0; k < d; ++k) a += (p1[k] - p0[k]) * (p1[k] - p0[k]), b += (p2[k] - p1[k]) * (p2[k] - p1[k]);
    a = std::sqrt(a), b = std::sqrt(b);
    for (int k = 0; k < d; ++k) {
      const double first = (p1[k] - p0[k]) / a;
      const double second = (p2[k] - p1[k]) / b;
      tangent[at(k)] = (first + (first - second) * a / (a + b)) * step;
    }
  }
  double squared = 0.0;
  for (const double t : tangent) squared += t * t;
  if (squared > 0.0) {
    for (double& t : tangent) t /= std::sqrt(squared);
  }
  return tangent;
}

void Builder::set_ends(Curve& curve, const EndTable* ends) {
  const int d = composition_.dimension;
  for (int e = 0; e < 2; ++e) {
    EndCondition& end = curve.view.end[e];
    const EndTable& table = ends[e];
    curve.end_text[e] = table.text(d);
    curve.end_position[e] = table.position;
    end.rotation_held = table.rotation_held;
    end.edge_held = table.edge_held;
    curve.state1_tangent[e] = end_tangent(curve, {}, e, tangents_[e]);
    const std::vector<double> tangent = end_tangent(curve, table, e, tangents_[e]);
    double squared = 0.0;
    for (const double t : tangent) squared += t * t;
    if (squared == 0.0) {
      error(table.position,
            "a tangent without a direction at the " + std::string(e == 0 ? "first" : "last") + " end of '" +
                curve.name + "'",
            "a vector that is not zero", "");
    }
    std::copy(tangent.begin(), tangent.end(), end.tangent);
    set_prescribed(curve, table, e);
  }
}

/// What an end holds, and where it is moved and turned to, in global axes.
void Builder::set_prescribed(Curve& curve, const EndTable& table, int e) {
  const int d = composition_.dimension;
  EndCondition& end = curve.view.end[e];
  const Matrix3 axes = table.in_end_axes ? end_axes(end.tangent, d) : Matrix3::identity();
  Vector3 move, turn;
  for (std::size_t k = 0; k < table.move.size(); ++k) move[static_cast<int>(k)] = table.move[k];
  move = axes * move;
  move.store(moves_[e]);
  turns_[e] = {};
  if (table.turn.size() == 1) (d == 2 ? turn[2] : turns_[e].twist) = table.turn.front();
  if (table.turn.size() == 3) turn = axes * Vector3::load(table.turn.data());
  turns_[e].rotation = turn;
  turn.store(end.turn);
  end.twist = turns_[e].twist;
  if (end.rotation_held && !end.edge_held) {
    curve.held_frame[e].resize(4);
    (lie::exp(turn) * lie::frame_from_tangent(Vector3::load(end.tangent)) * lie::about_first_axis(end.twist))
        .store(curve.held_frame[e].data());
  }

  free_axes_[e].clear();
  oblique_[e].clear();
  const bool whole = std::equal(table.position_held + 1, table.position_held + d, table.position_held);
  const double* p = curve.reference.data() + at((e == 0 ? 0 : curve.view.nodes - 1) * d);
  for (int k = 0; k < d; ++k) {
    const Vector3 axis = axes.column(k);
    if (!table.position_held[k]) {
      for (int a = 0; a < 3; ++a) free_axes_[e].push_back(axis[a]);
    } else if (whole || !table.in_end_axes) {
      end.position_held[k] = true;
    } else {
      HeldAxis held;
      held.node = e == 0 ? 0 : curve.view.nodes - 1;
      held.end = e;
      axis.store(held.axis);
      for (int a = 0; a < d; ++a) held.value += axis[a] * (p[a] + move[a]);
      oblique_[e].push_back(held);
    }
  }
}

/// Whether the curve cannot run through this end: no axis is free that its tangent has a share of.
bool Builder::held_along(const Curve& curve, int e) const {
  constexpr double across = 1e-3;
  const double* t = curve.view.end[e].tangent;
  for (std::size_t k = 0; k < free_axes_[e].size(); k += 3) {
    const double* axis = free_axes_[e].data() + k;
    if (std::fabs(axis[0] * t[0] + axis[1] * t[1] + axis[2] * t[2]) > across) return false;
  }
  return true;
}

/// Rows for what no single coordinate holds.
void Builder::hold_axes(const Curve& curve) {
  std::vector<HeldAxis> axes = oblique_[0];
  axes.insert(axes.end(), oblique_[1].begin(), oblique_[1].end());
  if (axes.empty()) return;
  for (HeldAxis& held : axes) held.curve = curve.view.index;
  ConstraintUse use;
  use.label = "ends of '" + curve.name + "'";
  use.held_axes = axes;
  use.constraint = Owned<Constraint>(new HeldAxes(axes, composition_.dimension),
                                     [](void* made) { delete static_cast<Constraint*>(made); });
  use.constraint->declare({}, use.rows);
  scene_->constraints.push_back(std::move(use));
}

/// The start takes the ends where they are moved to, and what lies between in proportion to its arc length.
void Builder::spread_moves(Curve& curve) const {
  const int d = composition_.dimension;
  const Ramp ramp(curve.view, curve.arc);
  for (int i = 0; i < curve.view.nodes; ++i) {
    const double share = ramp.at(curve.arc[at(i)]);
    for (int k = 0; k < d; ++k) {
      curve.start[at(i * d + k)] += (1.0 - share) * moves_[0][k] + share * moves_[1][k];
    }
  }
}

void Builder::spread_turns(Curve& curve) const {
  const std::vector<double> arc =
      curve.state1.empty() ? curve.arc : polyline_arc(curve.reference, curve.view.dimension);
  curve.start_turn.assign(at(curve.view.nodes - 1), 0.0);
  const auto turns = [](const Turn& turn) { return turn.twist != 0.0 || norm_squared(turn.rotation) > 0.0; };
  if (!turns(turns_[0]) && !turns(turns_[1])) return;
  bowstring::spread_turns(turns_, curve.view, arc, curve.start, curve.start_turn);
}

void Builder::finish_view(Curve& curve, const WireTable* wire) {
  const int d = composition_.dimension;
  const int edges = curve.view.nodes - 1;
  const std::vector<double>& state1 = curve.state1_points();
  curve.arc = polyline_arc(state1, d);
  const std::vector<double> rest_arc = curve.state1.empty() ? curve.arc : polyline_arc(curve.reference, d);
  double moves[2][3];
  for (int e = 0; e < 2; ++e) std::copy_n(moves_[e], 3, moves[e]);
  if (new_rest_) move_from_start(curve);
  spread_moves(curve);
  spread_turns(curve);
  if (new_rest_) set_held_places(curve, moves);
  curve.edge_length.clear();
  for (int i = 0; i < edges; ++i) curve.edge_length.push_back(rest_arc[at(i + 1)] - rest_arc[at(i)]);

  curve.fraction.assign(at(edges), 1.0);
  if (wire != nullptr && !wire->spacing.empty()) curve.fraction = wire->spacing;
  for (int e = 0; e < 2; ++e) {
    if (!curve.view.end[e].edge_held) continue;
    const int edge = e == 0 ? 0 : edges - 1;
    curve.fraction[at(edge)] = 0.0;
    curve.view.held_length += curve.edge_length[at(edge)];
  }
  double sum = 0.0;
  for (const double f : curve.fraction) sum += f;
  for (double& f : curve.fraction) f /= sum > 0.0 ? sum : 1.0;
  curve.view.start_length = curve.arc.back() - curve.view.held_length;

  double squared = 0.0;
  for (int k = 0; k < d; ++k) {  // of State 1: the start may have turned an end that is free there
    const double first = state1[at(k)] + moves[0][k];
    const double last = state1[at(edges * d + k)] + moves[1][k];
    squared += (last - first) * (last - first);
  }
  curve.view.end_distance = std::sqrt(squared);
  curve.view.index = static_cast<int>(scene_->curves.size());
  curve.view.name = curve.name.c_str();
  curve.view.reference = curve.reference.data();
  curve.view.start = curve.start.data();
  curve.view.start_turn = curve.start_turn.data();
  curve.view.edge_length = curve.edge_length.data();
  curve.view.fraction = curve.fraction.data();
  curve.view.arc = curve.arc.data();
  if (!curve.view.rigid) hold_axes(curve);
}

void Builder::check_tube(const Curve& curve, const std::string& position) {
  contact::Centerline tube;
  tube.dimension = composition_.dimension;
  tube.nodes = curve.view.nodes;
  tube.points = curve.state1_points().data();
  tube.radius = curve.radius.data();
  const contact::NodeMaximum fold = contact::tube_folds(tube);
  if (fold.value < largest_tube_curvature) return;
  error(position,
        "the tube of vessel '" + curve.name + "' folds into itself at s = " + number(curve.arc[at(fold.node)]) +
            " mm, " + point_text(tube.points + at(fold.node * composition_.dimension), composition_.dimension) +
            ": radius times curvature is " + number(fold.value, 3) + " (radius " +
            number(curve.radius[at(fold.node)], 3) + " mm, bend radius " +
            number(curve.radius[at(fold.node)] / fold.value, 3) + " mm)",
        "less than " + number(largest_tube_curvature) + " everywhere",
        "smooth the centerline (geometry key 'smoothing') or sample it with fewer 'nodes'");
}

bool Builder::read_geometry(Curve& curve, const ComponentChoice& choice, const EndTable* ends) {
  Status status;
  const auto geometry = create<Geometry>(choice, status);
  if (!passed(status, choice)) return false;
  CurveGraph graph;
  status = geometry->build(composition_.dimension, graph);
  if (!passed(status, choice)) return false;
  if (graph.curves.size() != 1) {
    error(choice.position, "a geometry of " + std::to_string(graph.curves.size()) + " curves for '" + curve.name + "'",
          "one curve", "");
    return false;
  }
  if (!sound(flaw_of(graph.curves.front(), composition_.dimension), choice, "'" + curve.name + "'")) return false;
  scene_->warnings.insert(scene_->warnings.end(), graph.warnings.begin(), graph.warnings.end());
  set_geometry(curve, std::move(graph.curves.front()));
  if (!check_points(curve, choice.position)) return false;
  set_ends(curve, ends);
  return true;
}

void Builder::add_vessel(const VesselTable& table) {
  auto curve = std::make_unique<Curve>();
  curve->name = table.name;
  curve->kinematics_name = table.kinematics.name;
  curve->view.kind = CurveKind::vessel;
  curve->view.extension = Extension::stretching;
  curve->view.rigid = table.rigid;

  const EndTable ignored[2];
  if (!read_geometry(*curve, table.geometry, table.rigid ? ignored : table.end)) return;
  if (new_rest_) set_rest(*curve);
  finish_view(*curve);

  Profile radius;
  bool known = table.radius.has_value();
  if (known) {
    radius = table.radius->profile;
  } else if (std::any_of(curve->data.begin(), curve->data.end(),
                         [](const PointData& d) { return d.name == "radius_mm"; })) {
    radius.form = Profile::Form::column;
    radius.column = "radius_mm";
    known = true;
  }
  if (known) {
    std::vector<double> sampled;
    const Status status = sample_profile(radius, *curve, curve->arc, sampled);
    const std::string& position = table.radius ? table.radius->position : table.geometry.position;
    if (!status.ok()) {
      error(position, status.text, "", "");
    } else {
      curve->radius = std::move(sampled);
      const auto smallest = std::min_element(curve->radius.begin(), curve->radius.end());
      if (!(*smallest > 0.0)) {
        error(position,
              "a lumen radius of " + number(*smallest) +
                  " mm at s = " + number(curve->arc[static_cast<std::size_t>(smallest - curve->radius.begin())]) +
                  " mm of '" + curve->name + "'",
              "a positive one everywhere", "");
      } else if (is_constrained({table.name})) {
        check_tube(*curve, position);
      }
    }
  }
  scene_->curves.push_back(std::move(curve));
}

/// The wire's State 1: the part of its vessel's State 1 centerline that it spans, on a mesh of its own. It starts along
/// the same part of the vessel's rest state.
bool Builder::start_wire(Curve& wire, const Curve& vessel, const WireTable& table) {
  const int d = composition_.dimension;
  const double length = vessel.arc.back();
  wire.along = vessel.view.index;
  wire.along_end = length;
  if (!table.span.empty()) {
    if (table.span[1] > length * (1.0 + 1e-9)) {
      error(table.span_position, "'span' of wire '" + table.name + "' ends at " + number(table.span[1], 6) + " mm",
            "at most the length of vessel '" + vessel.name + "', " + number(length, 6) + " mm",
            "shorten the span, or leave it out for all of the vessel");
      return false;
    }
    wire.along_begin = table.span[0];
    wire.along_end = std::min(table.span[1], length);
  }
  wire.view.dimension = d;
  wire.view.nodes = table.nodes > 0 ? table.nodes : vessel.view.nodes;
  for (int e = 0; e < 2; ++e) tangents_[e] = vessel.state1_tangent[e];
  const std::vector<double>& state1 = vessel.state1_points();
  if (table.span.empty() && table.spacing.empty() && wire.view.nodes == vessel.view.nodes) {
    wire.reference = state1;
    wire.start = vessel.reference;
  } else {
    if (!grade(wire, table)) return false;
    std::vector<double> share = cumulative_shares(table.spacing, wire.view.nodes - 1);
    for (double& s : share) s = (wire.along_begin + s * (wire.along_end - wire.along_begin)) / length;
    const Resampled part = resample(state1, d, share);
    wire.reference = part.points;
    wire.start = vessel.state1.empty() ? part.points : resample(vessel.reference, d, share).points;
    if (wire.along_begin > 0.0) tangents_[0] = part.first_tangent;
    if (wire.along_end < length) tangents_[1] = part.last_tangent;
  }
  return true;
}

/// Checks that `spacing` has a share for every edge.
bool Builder::grade(Curve& wire, const WireTable& table) {
  const int edges = wire.view.nodes - 1;
  if (table.spacing.empty() || static_cast<int>(table.spacing.size()) == edges) return true;
  error(table.spacing_position,
        "'spacing' of wire '" + table.name + "' has " + std::to_string(table.spacing.size()) + " entries",
        "one for each of its " + std::to_string(edges) + " edges",
        "write " + std::to_string(edges) + " numbers, or change its nodes");
  return false;
}

/// The nodes of a geometry moved along it, with its data and labels.
void Builder::regrade(Curve& curve, const std::vector<double>& share) const {
  const std::vector<double> before = polyline_arc(curve.reference, composition_.dimension);
  curve.reference = resample(curve.reference, composition_.dimension, share).points;
  curve.start = curve.reference;
  for (PointData& data : curve.data) {
    const std::vector<double> given = data.value;
    for (std::size_t i = 0; i < share.size(); ++i) {
      data.value[i] = interpolate_linearly(before, given, share[i] * before.back());
    }
  }
  const std::vector<std::string> label = curve.label;
  for (std::size_t i = 0; i < label.size(); ++i) {
    curve.label[i] = label[nearest_index(before, share[i] * before.back())];
  }
}

Extension Builder::wire_extension(const Curve& wire, const WireTable& table) {
  const bool held = held_along(wire, 0) && held_along(wire, 1);
  if (table.length == LengthRule::by_ends) {
    return held && !table.geometry ? Extension::sliding : Extension::fixed;
  }
  if (table.length == LengthRule::fixed) return Extension::fixed;
  if (!held || table.vessel.empty()) {
    error(table.length_position,
          "wire '" + table.name + "' slides, but " + (held ? "lies in no vessel" : "has an end that is free along it"),
          "both ends held, and a vessel: otherwise the wire withdraws and no minimum exists",
          "write length = \"fixed\", or hold its ends");
  }
  return Extension::sliding;
}

void Builder::add_wire(const WireTable& table) {
  auto curve = std::make_unique<Curve>();
  curve->name = table.name;
  curve->kinematics_name = table.kinematics.name;
  curve->view.kind = CurveKind::wire;
  const Curve* vessel = find(table.vessel);
  if (table.geometry) {
    if (!read_geometry(*curve, *table.geometry, table.end)) return;
    if (!table.spacing.empty()) {
      if (!grade(*curve, table)) return;
      regrade(*curve, cumulative_shares(table.spacing, curve->view.nodes - 1));
    }
  } else if (vessel != nullptr) {
    if (!start_wire(*curve, *vessel, table)) return;
    set_ends(*curve, table.end);
  } else {
    return;  // the composition has refused it
  }
  curve->view.extension = wire_extension(*curve, table);
  finish_view(*curve, &table);

  std::vector<double> radius;
  const Status status = sample_profile(table.radius.profile, *curve, curve->arc, radius);
  if (!status.ok()) {
    error(table.radius.position, status.text, "", "");
  } else if (curve->view.extension == Extension::sliding && table.radius.profile.form != Profile::Form::constant) {
    error(table.radius.position, "'radius' varies along '" + table.name + "', whose length slides",
          "one value along a sliding wire", "give a value, or let the wire end inside the vessel");
  } else {
    curve->radius = std::move(radius);
  }
  scene_->curves.push_back(std::move(curve));
}

void Builder::declare_energies() {
  for (const EnergyTable& table : composition_.energies) {
    EnergyUse use;
    use.label = table.label;
    use.plugin = table.component.name;
    use.parameters = table.component.parameters;
    Curve* curve = find(table.on);
    use.curve = curve->view.index;
    Status status;
    use.energy = create<Energy>(table.component, status);
    if (!passed(status, table.component)) continue;
    status = use.energy->declare(curve->view, use.declaration);
    if (!status.ok()) status.text = "energy '" + table.label + "' on '" + table.on + "': " + status.text;
    if (!passed(status, table.component)) continue;
    if (!sound(flaw_of(use.declaration, use.parameters), table.component, "'" + table.on + "'")) continue;
    const Needs& needs = use.declaration.needs;
    curve->needs.stretch = curve->needs.stretch || needs.stretch;
    if (needs.material_frames) {
      curve->needs.material_frames = true;
      curve->needs.reason += (curve->needs.reason.empty() ? "" : "; ") + needs.reason;
    }
    for (const std::string& warning : use.declaration.warnings) scene_->warnings.push_back(warning);
    note_without_effect("energy '" + use.label + "'", use.parameters, use.declaration.without_effect);
    for (std::size_t k = 0; k < use.declaration.laws.size(); ++k) {
      use.laws.push_back({use.declaration.laws[k], use.declaration.descriptions[k], {}});
    }
    scene_->energies.push_back(std::move(use));
  }
}

void Builder::note_without_effect(const std::string& owner, const ParameterSet& parameters,
                                  const std::vector<IdleParameter>& without_effect) {
  for (const IdleParameter& idle : without_effect) {
    const ParameterValue* value = parameters.find(idle.key.c_str());
    if (value == nullptr || value->position.empty()) continue;  // nobody has given it
    scene_->without_effect.push_back(value->position + ": '" + idle.key + "' of " + owner +
                                     " has no effect: " + idle.reason);
  }
}

void Builder::declare_kinematics() {
  for (std::size_t c = 0; c < scene_->curves.size(); ++c) {
    Curve& curve = *scene_->curves[c];
    const ComponentChoice& choice = kinematics_choice(c);
    Status status;
    curve.kinematics = create<Kinematics>(choice, status);
    if (!passed(status, choice)) continue;
    status = curve.kinematics->declare(curve.view, curve.needs, curve.declaration);
    if (!status.ok()) status.text = "kinematics '" + choice.name + "' of '" + curve.name + "': " + status.text;
    if (!passed(status, choice)) continue;
    for (const FieldDeclaration& field : curve.declaration.fields) {
      curve.coordinates += field.count * coordinate_count(field.manifold, field.dimension);
      curve.unknowns += field.count * tangent_count(field.manifold, field.dimension);
    }
    if (!sound(flaw_of(curve.declaration, curve.unknowns), choice, "'" + curve.name + "'")) return;
    curve.coordinate_begin = scene_->coordinates;
    curve.unknown_begin = scene_->unknowns;
    scene_->coordinates += curve.coordinates;
    scene_->unknowns += curve.unknowns;
  }
}

bool Builder::sample_law(EnergyUse& use, LawUse& law, const ComponentChoice& choice) {
  const Curve& curve = *scene_->curves[at(use.curve)];
  const SiteDeclaration* site = curve.site(law.description.site);
  std::vector<double> arc;
  if (site != nullptr && law.description.places.empty()) arc = site->arc;
  for (const int place : law.description.places) arc.push_back(site != nullptr ? site->arc.at(at(place)) : 0.0);
  for (const std::string& key : law.description.parameters) {
    const ParameterValue& value = use.parameters.at(key);
    std::vector<double> sampled;
    if (value.type == ParameterType::profile) {
      if (curve.view.extension == Extension::sliding && value.profile.form != Profile::Form::constant) {
        error(value.position.empty() ? choice.position : value.position,
              "'" + key + "' of energy '" + use.label + "' varies along '" + curve.name + "', whose length slides",
              "one value along a sliding wire", "give a value, or let the wire end inside the vessel");
        return false;
      }
      const Status status = sample_profile(value.profile, curve, arc, sampled);
      if (!status.ok()) {
        error(value.position.empty() ? choice.position : value.position, "'" + key + "': " + status.text, "", "");
        return false;
      }
    } else {
      sampled.assign(arc.size(), value.number);
    }
    law.parameters.push_back(std::move(sampled));
  }
  return true;
}

void Builder::sample_laws() {
  for (std::size_t e = 0; e < scene_->energies.size(); ++e) {
    EnergyUse& use = scene_->energies[e];
    const ComponentChoice& choice = composition_.energies[e].component;
    for (LawUse& law : use.laws) {
      if (!sample_law(use, law, choice)) continue;
      const Curve& curve = *scene_->curves[at(use.curve)];
      if (law.description.site != Site::length && curve.site(law.description.site) == nullptr) {
        error(choice.position,
              "energy '" + use.label + "' reads " + site_name(law.description.site) + "s, which kinematics '" +
                  curve.kinematics_name + "' of '" + curve.name + "' does not have",
              "a kinematics that has them", "use kinematics = \"edge-frames\", or leave this energy out");
        continue;
      }
      const SiteDeclaration* station = curve.site(Site::station);
      if (law.description.site == Site::station && !law.description.isotropic && composition_.dimension == 3 &&
          station != nullptr && station->values - (station->lengths_vary ? 2 : 0) < 3) {
        error(choice.position,
              "energy '" + use.label + "' reads a strain vector that kinematics '" + curve.kinematics_name + "' of '" +
                  curve.name + "' does not have",
              "a kinematics with material frames", "use kinematics = \"edge-frames\"");
      }
    }
  }
}

void Builder::declare_constraints() {
  for (const ConstraintTable& table : composition_.constraints) {
    ConstraintUse use;
    use.label = table.label;
    use.plugin = table.component.name;
    Status status;
    use.constraint = create<Constraint>(table.component, status);
    if (!passed(status, table.component)) continue;
    use.scene.dimension = composition_.dimension;
    for (const std::string& name : table.on) {
      const Curve& curve = *find(name);
      use.scene.on.push_back(curve.view);
      use.scene.radius.push_back(curve.radius.empty() ? nullptr : curve.radius.data());
    }
    if (table.on.size() == 2 && find(table.on[0])->along == find(table.on[1])->view.index) {
      const Curve& wire = *find(table.on[0]);
      use.scene.starts_along = true;
      use.scene.start_arc = wire.along_begin;
      use.scene.end_arc = wire.along_end;
    }
    use.scene.window_segments = traits_.window_segments;
    use.scene.window_length = traits_.window_length;
    status = use.constraint->declare(use.scene, use.rows);
    if (!status.ok()) status.text = "constraint '" + table.label + "': " + status.text;
    if (!passed(status, table.component)) continue;
    if (!sound(flaw_of(use.rows), table.component, "'" + table.label + "'")) continue;
    for (const std::string& warning : use.rows.warnings) scene_->warnings.push_back(warning);
    note_without_effect("constraint '" + table.label + "'", table.component.parameters, use.rows.without_effect);
    scene_->constraints.push_back(std::move(use));
  }
}

void Builder::check_loads() {
  for (const auto& curve : scene_->curves) {
    const std::optional<UnheldLoad> load = unheld_load(*scene_, *curve);
    if (!load) continue;
    const ComponentChoice& choice = composition_.energies[at(load->energy)].component;
    std::string force = number(load->force[0]);
    for (int k = 1; k < composition_.dimension; ++k) force += ", " + number(load->force[k]);
    error(choice.position,
          "nothing holds '" + curve->name + "' against a dead force of (" + force +
              ") N: it would move away without end, and no minimum exists",
          "an end that is held, a constraint, or an energy of its position", "hold an end, or add an anchoring");
  }
}

}  // namespace

SceneOutcome build_scene(const Composition& composition, const SolverTraits& traits, const CarriedState* carried) {
  return Builder(composition, traits, carried).build();
}

}  // namespace bowstring
