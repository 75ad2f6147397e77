#include "writers/vtp/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/sdk/guard.hpp"
#include "writers/vtp/sweep.hpp"

namespace bowstring {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int vessel_sides = 32;
constexpr int wire_sides = 12;

std::string entry(const std::string& list, std::size_t i) { return list + "[" + std::to_string(i) + "]"; }

[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& expected) {
  throw StatusError(Code::invalid_input, where + ": found " + found + ", expected " + expected +
                                             "; look at the document's status and reason");
}

bool finite(const Vector3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

void expect_points(const std::vector<Vector3>& points, const std::string& where) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!finite(points[i])) refuse(entry(where, i), "null", "finite coordinates");
  }
}

/// Divided by its norm, so that the axes in the file are orthonormal to rounding.
lie::Rotation unit_frame(const lie::Rotation& q, const std::string& where) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!std::isfinite(length)) refuse(where, "none", "a unit quaternion at every node");
  if (std::abs(length - 1.0) > 1e-6) {
    refuse(where, "a quaternion of length " + std::to_string(length), "a unit quaternion");
  }
  return q.normalized();
}

std::vector<ModelPoint> centerline(const ResultCurve& curve, const std::string& where) {
  expect_points(curve.points, where + ".points");
  expect_points(curve.reference, where + ".reference_points");
  std::vector<ModelPoint> out;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    ModelPoint point;
    point.position = curve.points[i];
    point.displacement = curve.points[i] - curve.reference[i];
    point.moment = curve.moment[i];
    point.frame = unit_frame(curve.frames[i], entry(where + ".frames", i));
    point.normal = point.frame * Vector3::unit(1);
    point.arc = curve.arc[i];
    point.radius = curve.radius[i];
    point.curvature = curve.curvature[i];
    point.twist = curve.twist[i];
    point.gap = not_a_number;
    out.push_back(point);
  }
  return out;
}

/// Whether the curve has a radius: at every node or at none.
bool has_radius(const ResultCurve& curve, const std::string& where) {
  const auto known = [](double radius) { return std::isfinite(radius); };
  if (std::none_of(curve.radius.begin(), curve.radius.end(), known)) return false;
  for (std::size_t i = 0; i < curve.radius.size(); ++i) {
    if (!known(curve.radius[i])) refuse(entry(where, i), "null", "a radius at every node, or at none");
    if (curve.radius[i] <= 0.0) refuse(entry(where, i), std::to_string(curve.radius[i]), "a radius above 0");
  }
  return true;
}

/// The wire at a fraction `t` of the edge from a to b.
ModelPoint between(const ModelPoint& a, const ModelPoint& b, double t) {
  const auto blend = [t](const auto& x, const auto& y) { return (1.0 - t) * x + t * y; };
  ModelPoint out;
  out.position = blend(a.position, b.position);
  out.displacement = blend(a.displacement, b.displacement);
  out.moment = blend(a.moment, b.moment);
  out.frame = (a.frame * lie::exp(t * lie::log(a.frame.inverse() * b.frame))).normalized();
  out.arc = blend(a.arc, b.arc);
  out.radius = blend(a.radius, b.radius);
  out.curvature = blend(a.curvature, b.curvature);
  out.twist = blend(a.twist, b.twist);
  return out;
}

ModelPoint contact_point(const std::vector<ModelPoint>& wire, const ResultContact& contact, const std::string& where) {
  const double last = static_cast<double>(wire.size() - 1), place = contact.edge + contact.part;
  if (!std::isfinite(place)) refuse(where, "no wire_edge or no t", "the contact's place on its wire");
  if (place < 0.0 || place > last) {
    refuse(where, "wire_edge + t = " + std::to_string(place),
           "a place on its wire, from 0 to " + std::to_string(wire.size() - 1));
  }
  const auto edge = static_cast<std::size_t>(place);
  const double t = place - std::floor(place);
  ModelPoint point = t == 0.0 ? wire[edge] : between(wire[edge], wire[edge + 1], t);
  point.normal = contact.direction;
  point.force = contact.force * contact.direction;
  point.gap = contact.gap;
  return point;
}

void add_centerline(const ResultCurve& curve, const std::vector<ModelPoint>& points, Model& model) {
  const auto part = static_cast<std::int32_t>(model.parts.size());
  model.parts.push_back(
      {curve.name + ": centerline", curve.wire ? PartKind::wire_centerline : PartKind::vessel_centerline});
  std::vector<std::int64_t> line;
  for (const ModelPoint& point : points) {
    line.push_back(static_cast<std::int64_t>(model.points.size()));
    model.points.push_back(point);
  }
  model.lines.add(line, part);
}

void add_contacts(const Result& result, int wire, const std::vector<ModelPoint>& points, Model& model) {
  const auto part = static_cast<std::int32_t>(model.parts.size());
  int rows = 0, left_out = 0;
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    const ResultContact& contact = result.contacts[i];
    if (contact.wire != wire) continue;
    ++rows;
    const ModelPoint point = contact_point(points, contact, entry("contacts", i));
    if (!finite(point.force)) {
      ++left_out;
      continue;
    }
    model.vertices.add({static_cast<std::int64_t>(model.points.size())}, part);
    model.points.push_back(point);
  }
  if (rows == 0) return;
  std::string name = result.curves[static_cast<std::size_t>(wire)].name + ": contact forces on it";
  if (left_out > 0) name += ", without " + std::to_string(left_out) + " rows whose force is unknown";
  model.parts.push_back({name, PartKind::contact_forces});
}

}  // namespace

void ModelCells::add(const std::vector<std::int64_t>& points, std::int32_t of_part) {
  connectivity.insert(connectivity.end(), points.begin(), points.end());
  offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  part.push_back(of_part);
}

Model build_model(const Result& result) {
  Model model;
  std::vector<std::vector<ModelPoint>> centerlines;
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    centerlines.push_back(centerline(result.curves[i], entry("curves", i)));
    add_centerline(result.curves[i], centerlines[i], model);
  }
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    const ResultCurve& curve = result.curves[i];
    if (!has_radius(curve, entry("curves", i) + ".radius_mm")) continue;
    const ModelPart part{curve.name + (curve.wire ? ": wire surface" : ": lumen surface"),
                         curve.wire ? PartKind::wire_surface : PartKind::lumen};
    add_tube(centerlines[i], curve.wire ? wire_sides : vessel_sides, part, model);
  }
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    add_contacts(result, static_cast<int>(i), centerlines[i], model);
  }
  return model;
}

}  // namespace bowstring
