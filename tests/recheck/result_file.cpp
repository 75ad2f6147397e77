#include "tests/recheck/result_file.hpp"

#include <fstream>
#include <limits>
#include <stdexcept>

namespace recheck {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

[[noreturn]] void fail(const std::string& text) { throw std::runtime_error(text); }

/// A number; null, which the document has for what is not finite, is not a number.
double finite_or_nan(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> numbers(const Json& list) {
  std::vector<double> out;
  out.reserve(list.size());
  for (const Json& value : list) out.push_back(finite_or_nan(value));
  return out;
}

Point point(const std::vector<double>& list, std::size_t begin, int dimension) {
  if (list.size() < begin + at(dimension)) fail("a point has fewer numbers than the scene has dimensions");
  return {list[begin], list[begin + 1], dimension == 3 ? list[begin + 2] : 0.0};
}

std::vector<Point> points_of_rows(const Json& rows, int dimension) {
  std::vector<Point> out;
  for (const Json& row : rows) out.push_back(point(numbers(row), 0, dimension));
  return out;
}

/// Columns of the rotation matrix of a unit quaternion (w, x, y, z).
Frame<double> frame_of_quaternion(const std::vector<double>& list, std::size_t begin) {
  if (list.size() < begin + 4) fail("an orientation in space has fewer than four numbers");
  const double w = list[begin], x = list[begin + 1], y = list[begin + 2], z = list[begin + 3];
  return {{w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)},
          {2.0 * (x * y - w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z + w * x)},
          {2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z}};
}

std::vector<Frame<double>> frames(const std::vector<double>& list) {
  std::vector<Frame<double>> out;
  for (std::size_t i = 0; i < list.size(); i += 4) out.push_back(frame_of_quaternion(list, i));
  return out;
}

/// The axes of an end: its tangent, then across it: to the left in the plane, in space by the least turn of the global
/// ones.
Frame<double> end_axes(const Point& tangent, int dimension) {
  if (dimension == 2) return {tangent, {-tangent.y, tangent.x, 0.0}, {0.0, 0.0, 1.0}};
  const Point e1{1.0, 0.0, 0.0}, e2{0.0, 1.0, 0.0}, e3{0.0, 0.0, 1.0};
  if (tangent.x == -1.0) return {tangent, {0.0, -1.0, 0.0}, e3};
  return {tangent, least_turn(e1, tangent, e2), least_turn(e1, tangent, e3)};
}

Point from_axes(const Frame<double>& axes, const std::vector<double>& v) {
  const Point c{v.empty() ? 0.0 : v[0], v.size() > 1 ? v[1] : 0.0, v.size() > 2 ? v[2] : 0.0};
  return c.x * axes.x + c.y * axes.y + c.z * axes.z;
}

std::vector<bool> held_axes(const Json& value, int dimension) {
  std::vector<bool> out;
  for (int k = 0; k < dimension; ++k) {
    const Json& one = value.is_array() ? value.at(at(k)) : value;
    out.push_back(one.get<std::string>() == "held");
  }
  return out;
}

/// position, rotation and edge of a named type of end.
void hold_by_type(const std::string& type, End& end) {
  if (type != "free" && type != "pinned" && type != "clamped" && type != "held-edge")
    fail("unknown end '" + type + "'");
  for (bool& held : end.position_held) held = type != "free";
  end.rotation_held = type == "clamped";
  end.edge_held = type == "held-edge";
}

void hold_by_axes(const Json& table, const Frame<double>& axes, bool own_axes, int dimension, End& end) {
  if (table.contains("rotation")) {
    const std::vector<bool> held = held_axes(table["rotation"], table["rotation"].is_array() ? dimension : 1);
    for (const bool one : held) end.rotation_held = end.rotation_held || one;
  }
  if (!table.contains("position")) return;
  const std::vector<bool> held = held_axes(table["position"], dimension);
  bool all = true;
  for (const bool one : held) all = all && one;
  const Point column[3] = {axes.x, axes.y, axes.z};
  for (int k = 0; k < dimension; ++k) {
    if (!held[at(k)]) continue;
    if (own_axes && !all) {
      end.row_axes.push_back(column[k]);
    } else {
      end.position_held[k] = true;
    }
  }
}

End read_end(const Json& json, const Point& reference_tangent, int dimension) {
  End end;
  end.tangent = reference_tangent;
  if (json.is_string()) {
    hold_by_type(json.get<std::string>(), end);
    return end;
  }
  if (json.contains("tangent")) end.tangent = unit(point(numbers(json["tangent"]), 0, dimension));
  const bool own_axes = json.value("axes", "global") == "end";
  const Frame<double> global{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const Frame<double> axes = own_axes ? end_axes(end.tangent, dimension) : global;
  if (json.contains("type")) hold_by_type(json["type"].get<std::string>(), end);
  hold_by_axes(json, axes, own_axes, dimension, end);
  if (json.contains("move")) end.move = from_axes(axes, numbers(json["move"]));
  if (!json.contains("turn")) return end;
  const std::vector<double> turn =
      json["turn"].is_array() ? numbers(json["turn"]) : std::vector{number_of(json["turn"])};
  if (turn.size() == 3) end.turn = from_axes(axes, turn);
  if (turn.size() == 1) (dimension == 2 ? end.turn.z : end.twist) = turn[0];
  return end;
}

/// Equal shares of the edges that are not held, or those of `spacing`.
std::vector<double> shares(const Curve& curve) {
  std::vector<double> out;
  if (curve.description.contains("spacing")) out = numbers(curve.description["spacing"]);
  out.resize(at(curve.edges()), 1.0);
  double sum = 0.0;
  for (int i = 0; i < curve.edges(); ++i) {
    if (curve.edge_held(i)) out[at(i)] = 0.0;
    sum += out[at(i)];
  }
  for (double& share : out) share /= sum;
  return out;
}

void read_ends(const Json& entry, Curve& curve) {
  if (!entry.contains("reference_tangents")) {
    fail("curve '" + curve.name + "' has no 'reference_tangents': written by an older version; solve it again");
  }
  const char* of_state1 = curve.later_rest ? "state_1_tangents" : "reference_tangents";
  const std::vector<Point> tangents = points_of_rows(entry.at(of_state1), curve.dimension);
  const std::vector<Point> of_rest = points_of_rows(entry["reference_tangents"], curve.dimension);
  for (int e = 0; e < 2; ++e) {
    curve.rest_tangent[e] = of_rest.at(at(e));
    curve.end[e] = read_end(curve.description.at("ends").at(at(e)), tangents.at(at(e)), curve.dimension);
  }
}

const Json& table_of(const Json& composition, const std::string& list, const std::string& name) {
  if (composition.contains(list)) {
    for (const Json& table : composition[list]) {
      if (table.value("name", "") == name) return table;
    }
  }
  fail("the composition has no " + list + " '" + name + "'");
}

Curve read_curve(const Json& composition, const Json& entry, int dimension) {
  Curve curve;
  curve.name = entry.at("name").get<std::string>();
  curve.wire = entry.at("kind") == "wire";
  curve.dimension = dimension;
  curve.description = table_of(composition, curve.wire ? "wire" : "vessel", curve.name);
  const std::string kinematics = curve.description.at("kinematics").at("type").get<std::string>();
  if (kinematics != "edge-frames" && kinematics != "nodes") fail("not rechecked: kinematics '" + kinematics + "'");
  curve.edge_frames = kinematics == "edge-frames";
  curve.rigid = curve.description.value("rigid", false);
  curve.reference = points_of_rows(entry.at("reference_points"), dimension);
  curve.later_rest = entry.contains("state_1_points") && !entry["state_1_points"].is_null();
  curve.state1 = curve.later_rest ? points_of_rows(entry["state_1_points"], dimension) : curve.reference;
  if (curve.state1.size() != curve.reference.size()) fail("'" + curve.name + "' has another mesh in State 1");
  curve.points = points_of_rows(entry.at("points"), dimension);
  curve.nodes = static_cast<int>(curve.reference.size());
  if (curve.nodes < 3) fail("curve '" + curve.name + "' has fewer than three nodes");
  if (!entry.at("radius_mm").is_null()) curve.radius = numbers(entry["radius_mm"]);
  read_ends(entry, curve);
  curve.share = shares(curve);
  return curve;
}

void expect_count(const std::string& name, std::size_t found, int expected) {
  if (found == at(expected)) return;
  fail("field '" + name + "' has " + std::to_string(found) + " entries; expected " + std::to_string(expected));
}

/// The state of one curve; what a field is called says which unknowns the curve has.
void read_state(const Json& fields, Curve& curve) {
  const auto field = [&](const char* name) {
    const std::string key = curve.name + "." + name;
    return fields.contains(key) ? numbers(fields[key]) : std::vector<double>{};
  };
  const std::vector<double> position = field("position");
  expect_count(curve.name + ".position", position.size(), curve.nodes * curve.dimension);
  for (std::size_t i = 0; i < position.size(); i += at(curve.dimension)) {
    curve.position.push_back(point(position, i, curve.dimension));
  }
  const std::vector<double> orientation = field("orientation"), held = field("held-tangent"), length = field("length");
  curve.angle = field("angle");
  if (curve.dimension == 2) {
    curve.angle = orientation;
    curve.held_angle = held;
  } else {
    curve.frame = frames(orientation);
    curve.held_frame = frames(held);
  }
  if (curve.edge_frames) {
    expect_count(curve.name + ".orientation", curve.dimension == 2 ? curve.angle.size() : curve.frame.size(),
                 curve.edges());
  }
  curve.edge_length = field("edge-length");
  if (!length.empty()) curve.length = length.front();
  if (curve.wire) curve.extension = curve.length ? Extension::sliding : Extension::fixed;
  if (!curve.wire && curve.edge_frames)
    expect_count(curve.name + ".edge-length", curve.edge_length.size(), curve.edges());
}

bool any_positive(const Json& value) {
  if (value.is_number() || value.is_string()) return number_of(value) > 0.0;
  if (value.is_array()) {
    for (const Json& row : value) {
      if (any_positive(row.is_array() ? row.back() : row)) return true;
    }
    return false;
  }
  return value.contains("table") ? any_positive(value["table"]) : true;
}

/// A curve in space has frames where an energy that twists it is on it.
void choose_orientation(const Json& energies, Curve& curve) {
  if (curve.dimension == 2) return;
  curve.orientation = Orientation::direction;
  for (const Json& energy : energies) {
    if (energy.value("on", "") != curve.name || !energy.contains("torsional-stiffness")) continue;
    if (any_positive(energy["torsional-stiffness"])) curve.orientation = Orientation::frame;
  }
}

void read_thresholds(const Json& composition, Thresholds& out) {
  if (!composition.contains("certificate")) return;
  const Json& table = composition["certificate"];
  out.stationarity = table.value("stationarity", out.stationarity);
  out.penetration = table.value("penetration", out.penetration);
  out.complementarity = table.value("complementarity", out.complementarity);
  out.multiplier = table.value("multiplier", out.multiplier);
  out.stretch = table.value("minimum-stretch", out.stretch);
}

void read_contacts(const Json& list, std::vector<ContactEntry>& out) {
  for (const Json& entry : list) {
    ContactEntry contact;
    contact.wire = entry.at("wire").get<std::string>();
    if (entry.at("vessel").is_string()) contact.vessel = entry["vessel"].get<std::string>();
    contact.coordinate = entry.at("wire_edge").get<double>() + finite_or_nan(entry.at("t"));
    contact.vessel_arc = finite_or_nan(entry.at("vessel_s_mm"));
    contact.gap = finite_or_nan(entry.at("gap_mm"));
    contact.force = finite_or_nan(entry.at("force_N"));
    out.push_back(contact);
  }
}

}  // namespace

bool Curve::edge_held(int edge) const {
  return rigid || (edge == 0 && end[0].edge_held) || (edge == edges() - 1 && end[1].edge_held);
}

bool Curve::position_held(int node, int axis) const {
  const int last = nodes - 1;
  return rigid || (node == 0 && end[0].position_held[axis]) || (node == last && end[1].position_held[axis]) ||
         (node <= 1 && end[0].edge_held) || (node >= last - 1 && end[1].edge_held);
}

bool Curve::wholly_held(int node) const {
  for (int axis = 0; axis < dimension; ++axis) {
    if (!position_held(node, axis)) return false;
  }
  return true;
}

int Curve::held_tangent(int e) const {
  const auto holds = [this](int one) { return !rigid && end[one].rotation_held && !end[one].edge_held; };
  if (!holds(e)) return -1;
  return e == 1 && holds(0) ? 1 : 0;
}

int Result::index(const std::string& name) const {
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].name == name) return static_cast<int>(c);
  }
  fail("there is no curve '" + name + "'");
}

const Curve& Result::curve(const std::string& name) const { return curves[at(index(name))]; }

double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return std::stod(value.get<std::string>());
  fail("a quantity of the composition is no number: " + value.dump());
}

namespace {

Result read_state_of(const Json& document) {
  const Json& composition = document.at("composition");
  Result out;
  out.status = document.at("status").get<std::string>();
  out.dimension = composition.at("scene").at("dimension").get<int>();
  if (composition.contains("energy")) out.energies = composition["energy"];
  if (composition.contains("constraint")) out.constraints = composition["constraint"];
  if (composition.at("enforcement").at("type") != "kkt") out.unknown.push_back("enforcement");
  read_thresholds(composition, out.thresholds);
  for (const Json& entry : document.at("curves")) {
    out.curves.push_back(read_curve(composition, entry, out.dimension));
    read_state(document.at("state").at("fields"), out.curves.back());
    choose_orientation(out.energies, out.curves.back());
  }
  for (const auto& [name, values] : document.at("state").at("multipliers").items())
    out.multipliers[name] = numbers(values);
  for (const auto& [name, value] : document.at("energy").items()) out.energy[name] = finite_or_nan(value);
  out.stationarity = finite_or_nan(document.at("certificate").at("stationarity"));
  read_contacts(document.at("contacts"), out.contacts);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, Result>> read_results(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) fail("cannot be read");
  const Json document = Json::parse(stream);
  if (document.value("format", "") != "bowstring.result/1") fail("is no bowstring.result/1 document");
  std::vector<std::pair<std::string, Result>> out;
  out.emplace_back("", read_state_of(document));
  const Json& states = document.at("states");
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {  // the last one is the document's own
    out.emplace_back("state '" + states[k].at("name").get<std::string>() + "'", read_state_of(states[k]));
  }
  for (std::size_t k = 0; k < document.at("equilibria").size(); ++k) {
    Json one = document;
    one.update(document.at("equilibria")[k]);
    out.emplace_back("equilibrium " + std::to_string(k + 1), read_state_of(one));
  }
  return out;
}

}  // namespace recheck
