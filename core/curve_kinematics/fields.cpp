#include "core/curve_kinematics/fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/lie/s2.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// An orientation with the given first axis, as near to `near` as it can be.
void orient(Manifold manifold, const double* tangent, const double* near, double* out) {
  if (manifold == Manifold::circle) {
    // The turn from `near`, not the angle itself, so that angles add up without jumps.
    const double c = std::cos(near[0]), s = std::sin(near[0]);
    out[0] = near[0] + std::atan2(c * tangent[1] - s * tangent[0], c * tangent[0] + s * tangent[1]);
    return;
  }
  lie::transport(lie::Rotation::load(near), Vector3::load(tangent)).store(out);
}

/// The prescribed rotation of a held orientation.
void turn_held(Manifold manifold, const EndCondition& end, double* held) {
  if (manifold == Manifold::circle) {
    held[0] += end.turn[2];
    return;
  }
  const lie::Rotation turned = lie::exp(Vector3::load(end.turn)) * lie::Rotation::load(held);
  (turned * lie::about_first_axis(end.twist)).store(held);
}

}  // namespace

FieldSlot add_field(FieldDeclaration field, KinematicsDeclaration& out) {
  FieldSlot slot{0, 0, coordinate_count(field.manifold, field.dimension),
                 tangent_count(field.manifold, field.dimension)};
  for (const FieldDeclaration& earlier : out.fields) {
    slot.coordinate += earlier.count * coordinate_count(earlier.manifold, earlier.dimension);
    slot.unknown += earlier.count * tangent_count(earlier.manifold, earlier.dimension);
  }
  out.fields.push_back(std::move(field));
  return slot;
}

FieldDeclaration position_field(const CurveMesh& mesh) {
  const int d = mesh.dimension();
  FieldDeclaration field;
  field.name = "position";
  field.reason = "every kinematics has node positions";
  field.manifold = Manifold::vector;
  field.dimension = d;
  field.count = mesh.nodes();
  field.reference.assign(mesh.curve.reference, mesh.curve.reference + mesh.nodes() * d);
  field.start.assign(mesh.curve.start, mesh.curve.start + mesh.nodes() * d);
  for (int i = 0; i < mesh.nodes(); ++i) {
    field.station.push_back(mesh.node_arc[at(i)].at(mesh.start_length()));
    for (int k = 0; k < d; ++k) field.fixed.push_back(position_held(mesh.curve, i, k) ? 1 : 0);
  }
  return field;
}

FieldDeclaration length_field(const CurveMesh& mesh) {
  const CurveView& curve = mesh.curve;
  FieldDeclaration field;
  field.name = "length";
  field.reason = "the wire slides through its sheath";
  field.manifold = Manifold::real;
  field.count = 1;
  field.reference = field.start = {curve.start_length};
  // A length below half of the ends' distance belongs to no curve between them; the second bound keeps it positive.
  field.lower = {std::max(0.5 * curve.end_distance - curve.held_length, 0.05 * curve.start_length)};
  field.upper = {std::numeric_limits<double>::infinity()};
  field.fixed = {static_cast<char>(curve.rigid ? 1 : 0)};
  field.station = {mesh.node_arc.back().at(mesh.start_length())};
  return field;
}

FieldDeclaration held_tangent_field(const CurveMesh& mesh, Manifold manifold, const std::vector<double>& orientation) {
  const int each = coordinate_count(manifold, 1);
  FieldDeclaration field;
  field.name = "held-tangent";
  field.reason = "a clamped end holds the tangent at its node";
  field.manifold = manifold;
  field.count = mesh.held_tangents;
  for (int e = 0; e < 2; ++e) {
    if (mesh.held_tangent[e] < 0) continue;
    const int node = e == 0 ? 0 : mesh.nodes() - 1;
    const int edge = e == 0 ? 0 : mesh.edges() - 1;
    double held[4];
    orient(manifold, mesh.curve.end[e].tangent, orientation.data() + edge * each, held);
    field.reference.insert(field.reference.end(), held, held + each);
    field.station.push_back(mesh.node_arc[at(node)].at(mesh.start_length()));
  }
  field.start = field.reference;
  for (int e = 0; e < 2; ++e) {
    if (mesh.held_tangent[e] >= 0)
      turn_held(manifold, mesh.curve.end[e], field.start.data() + mesh.held_tangent[e] * each);
  }
  field.fixed.assign(at(field.count * tangent_count(manifold, 1)), 1);
  return field;
}

std::vector<double> start_orientations(const CurveMesh& mesh, Manifold manifold, const std::vector<double>& reference) {
  const std::vector<double> tangents = edge_tangents(mesh, mesh.curve.start);
  const double* turn = mesh.curve.start_turn;
  if (manifold != Manifold::circle) {
    std::vector<double> out = transported_orientations(manifold, tangents, reference.data());
    for (int i = 0; turn != nullptr && i < mesh.edges(); ++i) {
      (lie::Rotation::load(out.data() + 4 * i) * lie::about_first_axis(turn[i])).store(out.data() + 4 * i);
    }
    return out;
  }
  std::vector<double> out(at(mesh.edges()));
  double offset = 0.0;  // of the edge before against State 1
  for (int i = 0; i < mesh.edges(); ++i) {
    const double turned = turn == nullptr ? 0.0 : turn[i] - (i > 0 ? turn[i - 1] : 0.0);
    const double near = reference[at(i)] + offset + turned;
    orient(manifold, tangents.data() + 2 * i, &near, &out[at(i)]);
    offset = out[at(i)] - reference[at(i)];
  }
  return out;
}

std::vector<double> edge_tangents(const CurveMesh& mesh, const double* points) {
  const int d = mesh.dimension();
  std::vector<double> out(at(mesh.edges() * d));
  for (int i = 0; i < mesh.edges(); ++i) {
    double edge[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < d; ++k) edge[k] = points[(i + 1) * d + k] - points[i * d + k];
    const double length = std::hypot(edge[0], edge[1], edge[2]);
    for (int k = 0; k < d; ++k) out[at(i * d + k)] = edge[k] / length;
  }
  return out;
}

std::vector<double> transported_orientations(Manifold manifold, const std::vector<double>& tangents,
                                             const double* first) {
  const int d = manifold == Manifold::circle ? 2 : 3;
  const int each = coordinate_count(manifold, 1);
  const int count = static_cast<int>(tangents.size()) / d;
  constexpr double any[4] = {0.0, 0.0, 0.0, 0.0};
  std::vector<double> out(at(count * each));
  if (first == nullptr && manifold != Manifold::circle) {
    lie::frame_from_tangent(Vector3::load(tangents.data())).store(out.data());
  } else {
    orient(manifold, tangents.data(), first != nullptr ? first : any, out.data());
  }
  for (int i = 1; i < count; ++i) {
    orient(manifold, tangents.data() + i * d, out.data() + (i - 1) * each, out.data() + i * each);
  }
  return out;
}

Status check_curve(const CurveMesh& mesh, const Needs& needs) {
  const int d = mesh.dimension();
  for (const bool reference : {true, false}) {
    const double* points = reference ? mesh.curve.reference : mesh.curve.start;
    for (int i = 0; i < mesh.edges(); ++i) {
      const double* p = points + i * d;
      if (!std::equal(p, p + d, p + d)) continue;
      return Status::failure(Code::invalid_input, "edge " + std::to_string(i) + " of '" + mesh.curve.name +
                                                      "' has length zero " +
                                                      (reference ? "in State 1" : "at the start") + ": nodes " +
                                                      std::to_string(i) + " and " + std::to_string(i + 1) +
                                                      " coincide; drop one of them or sample the curve anew");
    }
  }
  if (needs.stretch && !mesh.stretching()) {
    return Status::failure(Code::unsupported,
                           std::string("an energy needs the length of every edge of '") + mesh.curve.name +
                               "', but they are fixed shares of one length: only a vessel stretches");
  }
  return {};
}

}  // namespace bowstring
