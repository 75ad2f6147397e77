#include "core/check/motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/check/differences.hpp"
#include "core/check/unknowns.hpp"
#include "core/lie/so3.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

constexpr double agreement = 1e-9;  // of positions relative to the curve's size, of tangents in rad

Vector3 load_point(const double* p, int dimension) noexcept {
  Vector3 out;
  for (int k = 0; k < dimension; ++k) out[k] = p[k];
  return out;
}

Vector3 moved_point(const RigidMotion& motion, const Vector3& p) noexcept {
  return lie::exp(motion.turn) * (p - motion.centre) + motion.centre + motion.shift;
}

/// A body that turns only in the plane where the scene has two dimensions.
RigidMotion within(const RigidMotion& motion, int dimension) noexcept {
  RigidMotion out = motion;
  if (dimension == 2) out.turn[0] = out.turn[1] = out.shift[2] = out.centre[2] = 0.0;
  return out;
}

Status unsupported(const Curve& curve) {
  return Status::failure(Code::unsupported,
                         "kinematics '" + curve.kinematics_name + "' of '" + curve.name +
                             "' has unknowns of which it is not known how a rigid motion moves them");
}

}  // namespace

Mover::Mover(const Assembly& assembly) : assembly_(assembly) {
  std::size_t entry = 0;
  for (const auto& curve : assembly.scene().curves) {
    first_entry_.push_back(entry);
    for (const FieldDeclaration& field : curve->declaration.fields) entry += at(field.count);
  }
  first_entry_.push_back(entry);
}

const double* Mover::positions(const std::vector<double>& q, int curve) const noexcept {
  // Every kinematics has node positions as unknowns; `sample` verifies where they stand.
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    if (entry.manifold == Manifold::vector) return q.data() + entry.coordinate;
  }
  return nullptr;
}

bool Mover::has_edge_angles(int curve) const noexcept {
  const Scene& scene = assembly_.scene();
  if (scene.dimension == 2) return false;
  for (const FieldDeclaration& field : scene.curves[at(curve)]->declaration.fields) {
    if (field.manifold == Manifold::circle && field.count == scene.curves[at(curve)]->view.nodes - 1) return true;
  }
  return false;
}

bool Mover::spins(int curve) const noexcept {
  if (assembly_.scene().dimension == 2) return false;
  const auto& fields = assembly_.scene().curves[at(curve)]->declaration.fields;
  return has_edge_angles(curve) || std::any_of(fields.begin(), fields.end(), [](const FieldDeclaration& field) {
           return field.manifold == Manifold::rotation;
         });
}

void Mover::spin(int curve, double angle, std::vector<double>& q) const noexcept {
  const double turn[3] = {angle, 0.0, 0.0};
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    if (entry.manifold == Manifold::circle) q[at(entry.coordinate)] += angle;
    if (entry.manifold != Manifold::rotation) continue;
    retract(entry.manifold, entry.dimension, q.data() + entry.coordinate, turn, q.data() + entry.coordinate);
  }
}

std::vector<double> Mover::spin_rate(int curve) const {
  std::vector<double> out(assembly_.free_of_unknown().size(), 0.0);
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    if (entry.manifold == Manifold::circle || entry.manifold == Manifold::rotation) out[at(entry.unknown)] = 1.0;
  }
  return out;
}

Status Mover::move(const std::vector<double>& q, int curve, const RigidMotion& motion, std::vector<double>& out) const {
  const Scene& scene = assembly_.scene();
  const int d = scene.dimension;
  const RigidMotion own = within(motion, d);
  out = q;
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    double* number = out.data() + entry.coordinate;
    if (entry.manifold == Manifold::vector) {
      if (entry.dimension != d) return unsupported(*scene.curves[at(curve)]);
      const Vector3 p = moved_point(own, load_point(number, d));
      for (int k = 0; k < d; ++k) number[k] = p[k];
    } else if (is_curved(entry.manifold)) {
      (lie::exp(own.turn) * lie::Rotation::load(number)).store(number);
    } else if (entry.manifold == Manifold::circle && d == 2) {
      number[0] += own.turn[2];
    }
  }
  if (Status status = turn_angles(q, curve, own, out); !status.ok()) return status;
  return verify(q, curve, own, out);
}

Status Mover::sample(const std::vector<double>& q, int curve, CurveSample& out) const {
  const Curve& c = *assembly_.scene().curves[at(curve)];
  std::vector<double> middles;
  for (int i = 0; i + 1 < c.view.nodes; ++i) middles.push_back(i + 0.5);
  const Span<const double> own(q.data() + c.coordinate_begin, at(c.coordinates));
  return c.kinematics->sample(own, middles, out);
}

/// An angle per edge is measured against a frame that follows the edge in a way of its own, so that a rigid rotation
/// changes it: by what the sampled frames miss.
Status Mover::turn_angles(const std::vector<double>& q, int curve, const RigidMotion& motion,
                          std::vector<double>& out) const {
  if (!has_edge_angles(curve)) return {};
  const Curve& c = *assembly_.scene().curves[at(curve)];
  CurveSample before, after;
  if (Status status = sample(q, curve, before); !status.ok()) return status;
  if (Status status = sample(out, curve, after); !status.ok()) return status;
  if (before.orientation.size() != at(4 * (c.view.nodes - 1))) return unsupported(c);
  int edge = 0;
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    if (entry.manifold != Manifold::circle) continue;
    if (edge == c.view.nodes - 1) return unsupported(c);
    const lie::Rotation wanted = lie::exp(motion.turn) * lie::Rotation::load(before.orientation.data() + 4 * edge);
    const lie::Rotation missing = lie::Rotation::load(after.orientation.data() + 4 * edge).inverse() * wanted;
    out[at(entry.coordinate)] += 2.0 * std::atan2(missing.w < 0.0 ? -missing.x : missing.x, std::fabs(missing.w));
    ++edge;
  }
  return {};
}

Status Mover::verify(const std::vector<double>& q, int curve, const RigidMotion& motion,
                     const std::vector<double>& moved) const {
  const int d = assembly_.scene().dimension;
  const Curve& c = *assembly_.scene().curves[at(curve)];
  CurveSample before, after;
  if (Status status = sample(q, curve, before); !status.ok()) return status;
  if (Status status = sample(moved, curve, after); !status.ok()) return status;
  const std::size_t points = before.position.size() / at(d);
  double size = norm(motion.shift) + norm(motion.centre);
  for (const double number : before.position) size = std::max(size, std::fabs(number));
  for (std::size_t i = 0; i < points; ++i) {
    const Vector3 wanted = moved_point(motion, load_point(before.position.data() + i * at(d), d));
    const Vector3 found = load_point(after.position.data() + i * at(d), d);
    if (!(norm(found - wanted) <= agreement * size)) return unsupported(c);
  }
  for (std::size_t i = 0; i < before.orientation.size() / 4; ++i) {
    const lie::Rotation frame = lie::exp(motion.turn) * lie::Rotation::load(before.orientation.data() + 4 * i);
    const lie::Rotation found = lie::Rotation::load(after.orientation.data() + 4 * i);
    if (!(norm(found.first_axis() - frame.first_axis()) <= agreement)) return unsupported(c);
    const double off = spins(curve) ? norm(lie::log(frame.inverse() * found)) : 0.0;
    if (!(off <= agreement)) return unsupported(c);
  }
  return {};
}

Status Mover::rate(const std::vector<double>& q, int curve, const RigidMotion& motion, std::vector<double>& out) const {
  const int d = assembly_.scene().dimension;
  const RigidMotion own = within(motion, d);
  out.assign(assembly_.free_of_unknown().size(), 0.0);
  std::vector<double> moved[4];
  const double multiple[4] = {-2.0, -1.0, 1.0, 2.0};
  const double step = 1e-3 / std::max(1e-300, norm(own.turn));  // to 1e-3 rad
  for (int k = 0; k < 4 && has_edge_angles(curve) && norm(own.turn) > 0.0; ++k) {
    const double t = multiple[k] * step;
    if (Status status = move(q, curve, {t * own.turn, t * own.shift, own.centre}, moved[k]); !status.ok())
      return status;
  }
  for (std::size_t i = first_entry_[at(curve)]; i < first_entry_[at(curve) + 1]; ++i) {
    const FieldEntry& entry = assembly_.entries()[i];
    const double* number = q.data() + entry.coordinate;
    double* rate = out.data() + entry.unknown;
    if (entry.manifold == Manifold::vector) {
      const Vector3 v = cross(own.turn, load_point(number, d) - own.centre) + own.shift;
      for (int k = 0; k < d; ++k) rate[k] = v[k];
    } else if (is_curved(entry.manifold)) {
      const Vector3 body = lie::Rotation::load(number).inverse() * own.turn;
      const int first = entry.manifold == Manifold::direction ? 1 : 0;
      for (int k = first; k < 3; ++k) rate[k - first] = body[k];
    } else if (entry.manifold == Manifold::circle && d == 2) {
      rate[0] = own.turn[2];
    } else if (entry.manifold == Manifold::circle && !moved[0].empty()) {
      const std::size_t c = at(entry.coordinate);
      rate[0] = first_difference(moved[0][c], moved[1][c], moved[2][c], moved[3][c], step);
    }
  }
  return {};
}

Vector3 Mover::centre(const std::vector<double>& q, int curve) const {
  const int d = assembly_.scene().dimension;
  const int nodes = assembly_.scene().curves[at(curve)]->view.nodes;
  const double* p = positions(q, curve);
  Vector3 out;
  for (int i = 0; p != nullptr && i < nodes; ++i) out += load_point(p + i * d, d) / nodes;
  return out;
}

double Mover::radius(const std::vector<double>& q, int curve) const {
  const int d = assembly_.scene().dimension;
  const double* p = positions(q, curve);
  const Vector3 middle = centre(q, curve);
  double out = 0.0;
  for (int i = 0; p != nullptr && i < assembly_.scene().curves[at(curve)]->view.nodes; ++i) {
    out = std::max(out, norm(load_point(p + i * d, d) - middle));
  }
  return out;
}

}  // namespace bowstring::checking
