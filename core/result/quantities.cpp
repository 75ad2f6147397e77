#include "core/result/quantities.hpp"

#include <algorithm>
#include <cmath>

#include "core/curve/arc_length.hpp"
#include "core/lie/so3.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double touching_force = 1e-6;  // N: a row that carries more is in contact

/// Node that a station belongs to: end nodes own their half stations.
int station_node(const Curve& curve, int station) {
  const EndCondition& first = curve.view.end[0];
  const bool half = first.rotation_held && !first.edge_held;
  return half ? station : station + 1;
}

/// Unit vector about which a curve in space turns at a node: from its edge before, or a held tangent, to the one after.
Vector3 binormal(const Curve& curve, const std::vector<double>& points, int node) {
  const int last = curve.view.nodes - 1;
  const auto edge = [&](int i) {
    return Vector3::load(points.data() + at(3 * (i + 1))) - Vector3::load(points.data() + at(3 * i));
  };
  const auto held = [&](int e) {
    return lie::exp(Vector3::load(curve.view.end[e].turn)) * Vector3::load(curve.view.end[e].tangent);
  };
  const Vector3 before = node > 0 ? edge(node - 1) : held(0);
  const Vector3 after = node < last ? edge(node) : held(1);
  const Vector3 normal = cross(before, after);
  const double length = norm(normal);
  return length > 0.0 ? normal / length : normal;
}

void read_strain(Session& session, const Solution& solution, const Curve& curve, CurveRecord& out) {
  const int n = curve.view.nodes;
  const SiteDeclaration* site = curve.site(Site::station);
  const double* y = session.assembly->table(curve.view.index, Site::station);
  out.curvature.assign(at(n), 0.0);
  if (site == nullptr || y == nullptr || out.frames.empty()) return;
  std::vector<double> stress;
  if (!session.assembly->site_stress(solution.q, curve.view.index, Site::station, stress).ok()) return;
  const int components = site->values - (site->lengths_vary ? 2 : 0);
  const bool space = curve.view.dimension == 3;
  const bool frames = components == 3;
  if (frames) out.twist.assign(at(n), 0.0);
  out.moment.assign(at(space ? 3 * n : n), 0.0);
  for (int i = 0; i < site->count; ++i) {
    const int node = station_node(curve, i);
    const double* zeta = y + i * site->values;
    const double* m = stress.data() + i * site->values;
    const double ds = site->lengths_vary ? zeta[components] : site->ds[at(i)];
    double squared = 0.0;
    for (int k = frames ? 1 : 0; k < components; ++k) squared += zeta[k] * zeta[k];
    out.curvature[at(node)] = components == 1 ? zeta[0] / ds : std::sqrt(squared) / ds;
    if (frames) out.twist[at(node)] = zeta[0] / ds;
    if (!space) {
      out.moment[at(node)] = m[0];
    } else if (frames) {
      std::copy_n(m, 3, out.moment.begin() + 3 * node);
    } else if (squared > 0.0) {
      // The station's basis is the kinematics' own; an isotropic moment lies along the binormal in any.
      const Vector3 moment = (m[0] * zeta[0] + m[1] * zeta[1]) / std::sqrt(squared) * binormal(curve, out.points, node);
      const lie::Rotation frame = lie::Rotation::load(out.frames.data() + at(4 * node));
      (frame.inverse() * moment).store(out.moment.data() + 3 * node);
    }
  }
}

void read_frames(const Curve& curve, Span<const double> q, CurveRecord& out) {
  const int n = curve.view.nodes;
  std::vector<double> middle;
  for (int i = 0; i + 1 < n; ++i) middle.push_back(i + 0.5);
  CurveSample sample;
  if (!curve.kinematics->sample(q, middle, sample).ok()) return;
  const auto edge = [&](int i) { return lie::Rotation::load(sample.orientation.data() + at(4 * i)); };
  for (int i = 0; i < n; ++i) {
    lie::Rotation frame = edge(std::min(i, n - 2));
    if (i > 0 && i < n - 1) {
      const lie::Rotation before = edge(i - 1);
      frame = before * lie::exp(0.5 * lie::log(before.inverse() * edge(i)));
    }
    double numbers[4];
    frame.store(numbers);
    out.frames.insert(out.frames.end(), numbers, numbers + 4);
  }
}

void read_internal_force(const Session& session, const Solution& solution, const Curve& curve, CurveRecord& out) {
  const SiteDeclaration* closure = curve.site(Site::closure);
  if (closure == nullptr || closure->values != curve.view.dimension || closure->count != curve.view.nodes - 1) return;
  for (const RowOrigin& group : session.assembly->row_origins()) {
    if (group.curve != curve.view.index) continue;
    out.internal_force.assign(solution.multipliers.begin() + group.first,
                              solution.multipliers.begin() + group.first + group.count);
  }
}

CurveRecord read_curve(Session& session, const Solution& solution, const Curve& curve) {
  CurveRecord out;
  out.curve = curve.view.index;
  const double* p = session.assembly->table(curve.view.index, Site::node);
  out.points.assign(p, p + curve.view.nodes * curve.view.dimension);
  out.arc = polyline_arc(out.points, curve.view.dimension);
  read_frames(curve, {solution.q.data() + curve.coordinate_begin, at(curve.coordinates)}, out);
  read_strain(session, solution, curve, out);
  read_internal_force(session, solution, curve, out);
  return out;
}

bool is_same_place(const ContactRecord& a, const ContactRecord& b) {
  return a.wire == b.wire && a.vessel == b.vessel && a.wire_coordinate == b.wire_coordinate;
}

/// Bilateral rows of one place are components of one force.
void add_force(const ContactRecord& component, ContactRecord& contact) {
  Vector3 force;
  for (int k = 0; k < 3; ++k) {
    force[k] = contact.force * contact.direction[k] + component.force * component.direction[k];
  }
  contact.gap = std::hypot(contact.gap, component.gap);
  contact.force = norm(force);
  for (int k = 0; k < 3 && contact.force > 0.0; ++k) contact.direction[k] = force[k] / contact.force;
}

Status read_contacts(Session& session, const Solution& solution, Readings& out) {
  for (const RowOrigin& group : session.assembly->row_origins()) {
    if (group.constraint < 0) continue;
    const ConstraintUse& use = session.scene->constraints[at(group.constraint)];
    std::vector<RowReport> reports;
    Status status = session.assembly->report(solution.q, group.constraint, reports);
    if (!status.ok()) return status;
    for (std::size_t r = 0; r < reports.size(); ++r) {
      const RowReport& report = reports[r];
      if (report.wire_curve < 0) continue;  // not a place of a curve
      ContactRecord contact;
      contact.wire = report.wire_curve;
      contact.vessel = report.vessel_curve;
      contact.row = static_cast<int>(r);
      contact.wire_coordinate = report.wire_coordinate;
      const auto along = [](const std::vector<double>& arc, double coordinate) {
        const int i = std::clamp(static_cast<int>(coordinate), 0, static_cast<int>(arc.size()) - 2);
        return arc[at(i)] + (coordinate - i) * (arc[at(i + 1)] - arc[at(i)]);
      };
      contact.wire_arc = along(out.curves[at(report.wire_curve)].arc, report.wire_coordinate);
      if (report.vessel_curve >= 0) {
        contact.vessel_arc = along(session.scene->curves[at(report.vessel_curve)]->arc, report.vessel_coordinate);
      }
      contact.gap = report.gap;
      const bool bilateral = use.rows.lower[r] == use.rows.upper[r];
      const double force = solution.multipliers[at(group.first) + r] * report.force_per_multiplier;
      contact.force = bilateral ? std::fabs(force) : force;
      for (int k = 0; k < 3; ++k)
        contact.direction[k] = bilateral && force < 0.0 ? -report.direction[k] : report.direction[k];
      if (bilateral && r > 0 && is_same_place(out.contacts.back(), contact)) {
        add_force(contact, out.contacts.back());
      } else {
        out.contacts.push_back(contact);
      }
    }
  }
  return {};
}

/// In space, the axis of an edge's angle.
Vector3 edge_tangent(const CurveRecord& record, int edge) {
  const double* p = record.points.data() + at(3 * edge);
  return normalized(Vector3::load(p + 3) - Vector3::load(p));
}

/// Ends that are held along axes of their own have rows instead of eliminated coordinates.
void add_held_axes(const Session& session, const Solution& solution, const Curve& curve, SupportRecord (&ends)[2],
                   bool (&held)[2]) {
  for (const RowOrigin& group : session.assembly->row_origins()) {
    if (group.constraint < 0) continue;
    const std::vector<HeldAxis>& axes = session.scene->constraints[at(group.constraint)].held_axes;
    for (std::size_t r = 0; r < axes.size(); ++r) {
      if (axes[r].curve != curve.view.index) continue;
      held[axes[r].end] = true;
      for (int k = 0; k < 3; ++k) {
        ends[axes[r].end].force[k] -= solution.multipliers[at(group.first) + r] * axes[r].axis[k];
      }
    }
  }
}

/// Support reactions: the Lagrangian gradient of the fixed unknowns, gathered at the nearer end.
Status read_supports(Session& session, const Solution& solution, Readings& out) {
  std::vector<double> gradient;
  Status status = session.assembly->full_gradient(solution.q, solution.multipliers, gradient);
  if (!status.ok()) return status;
  const std::vector<FieldEntry>& entries = session.assembly->entries();
  std::size_t entry = 0;
  for (const auto& curve : session.scene->curves) {
    SupportRecord ends[2];
    bool held[2] = {false, false};
    const CurveRecord& record = out.curves[at(curve->view.index)];
    const int d = curve->view.dimension;
    for (const FieldDeclaration& field : curve->declaration.fields) {
      for (int i = 0; i < field.count; ++i, ++entry) {
        const FieldEntry& e = entries[entry];
        const int tangents = tangent_count(e.manifold, e.dimension);
        const int end = e.arc_fraction < 0.5 ? 0 : 1;
        double g[3] = {};
        bool any = false;
        for (int k = 0; k < tangents; ++k) {
          if (session.assembly->free_of_unknown()[at(e.unknown + k)] >= 0) continue;
          g[k] = gradient[at(e.unknown + k)];
          any = true;
        }
        if (!any || e.manifold == Manifold::real) continue;
        held[end] = true;
        SupportRecord& support = ends[end];
        if (e.manifold == Manifold::vector) {
          const double* origin = record.points.data() + (end == 0 ? 0 : (curve->view.nodes - 1) * d);
          double arm[3] = {};
          for (int k = 0; k < d; ++k) arm[k] = solution.q[at(e.coordinate + k)] - origin[k];
          for (int k = 0; k < 3; ++k) {
            support.force[k] += g[k];
            support.moment[k] += arm[(k + 1) % 3] * g[(k + 2) % 3] - arm[(k + 2) % 3] * g[(k + 1) % 3];
          }
        } else if (e.manifold == Manifold::circle) {
          const Vector3 axis = d == 2 ? Vector3::unit(2) : edge_tangent(record, std::min(i, curve->view.nodes - 2));
          for (int k = 0; k < 3; ++k) support.moment[k] += g[0] * axis[k];
        } else {
          const Vector3 body = body_rotation_vector(e.manifold, g);
          const Vector3 moment = lie::Rotation::load(solution.q.data() + e.coordinate) * body;
          for (int k = 0; k < 3; ++k) support.moment[k] += moment[k];
        }
      }
    }
    add_held_axes(session, solution, *curve, ends, held);
    for (int end = 0; end < 2; ++end) {
      if (!held[end]) continue;
      ends[end].curve = curve->view.index;
      ends[end].end = end;
      out.supports.push_back(ends[end]);
    }
  }
  return {};
}

void read_displacements(const Scene& scene, const Readings& readings, Quantities& out) {
  double weighted = 0.0, length = 0.0, sum = 0.0, peak = 0.0, change = 0.0;
  int nodes = 0;
  for (const auto& curve : scene.curves) {
    if (curve->view.kind != CurveKind::vessel) continue;
    const CurveRecord& record = readings.curves[at(curve->view.index)];
    const int d = curve->view.dimension;
    double previous = 0.0;
    for (int i = 0; i < curve->view.nodes; ++i) {
      double squared = 0.0;
      for (int k = 0; k < d; ++k) {
        const double u = record.points[at(i * d + k)] - curve->reference[at(i * d + k)];
        squared += u * u;
      }
      const double displacement = std::sqrt(squared);
      peak = std::max(peak, displacement);
      sum += displacement;
      ++nodes;
      if (i > 0) weighted += 0.5 * (displacement + previous) * curve->view.edge_length[i - 1];
      previous = displacement;
    }
    const double at_rest = curve->state1.empty() ? curve->arc.back() : polyline_arc(curve->reference, d).back();
    length += at_rest;
    change += record.arc.back() - at_rest;
  }
  if (nodes == 0) return;
  out.peak_displacement = peak;
  out.mean_displacement = weighted / length;
  out.mean_displacement_nodes = sum / nodes;
  out.vessel_length_change = change;
}

void read_wires(Session& session, const Solution& solution, const Readings& readings, Quantities& out) {
  double length = 0.0, chord = 0.0;
  bool any = false;
  for (const auto& curve : session.scene->curves) {
    if (curve->view.kind != CurveKind::wire) continue;
    any = true;
    const CurveRecord& record = readings.curves[at(curve->view.index)];
    const int d = curve->view.dimension;
    double squared = 0.0;
    for (int k = 0; k < d; ++k) {
      const double difference = record.points[record.points.size() - at(d) + at(k)] - record.points[at(k)];
      squared += difference * difference;
    }
    length += record.arc.back();
    chord += std::sqrt(squared);
    std::vector<double> tension;
    Status status = session.assembly->site_stress(solution.q, curve->view.index, Site::length, tension);
    if (!status.ok() || tension.empty()) continue;  // only a wire that slides has its tension as an energy
    double peak = 0.0, integral = 0.0;
    std::vector<char> touching(at(curve->view.nodes), 0);
    for (const ContactRecord& contact : readings.contacts) {
      if (contact.wire != curve->view.index || contact.force <= touching_force) continue;
      touching[at(static_cast<int>(std::lround(contact.wire_coordinate)))] = 1;
    }
    for (int node = 0; node < curve->view.nodes; ++node) {
      if (touching[at(node)] == 0) continue;
      const double before = node > 0 ? record.arc[at(node)] - record.arc[at(node - 1)] : 0.0;
      const double after = node + 1 < curve->view.nodes ? record.arc[at(node + 1)] - record.arc[at(node)] : 0.0;
      const double line_load = std::fabs(tension[0] * record.curvature[at(node)]);
      peak = std::max(peak, line_load);
      integral += line_load * 0.5 * (before + after);
    }
    out.line_load_peak = std::max(out.line_load_peak.value_or(0.0), peak);
    out.line_load_integral = out.line_load_integral.value_or(0.0) + integral;
  }
  if (!any) return;
  out.wire_length = length;
  if (chord > 0.0) out.arc_to_chord = length / chord;
}

}  // namespace

Status read_solution(Session& session, const Solution& solution, Readings& out) {
  out = {};
  const Status energies = session.assembly->term_energies(solution.q, out.term_energy);
  // Where a plugin has failed the shapes are known all the same.
  for (const auto& curve : session.scene->curves) out.curves.push_back(read_curve(session, solution, *curve));
  if (!energies.ok()) return energies;
  if (Status status = read_contacts(session, solution, out); !status.ok()) return status;
  if (Status status = read_supports(session, solution, out); !status.ok()) return status;
  read_displacements(*session.scene, out, out.quantities);
  for (const ContactRecord& contact : out.contacts) {
    if (contact.force > touching_force) ++out.quantities.contact_count;
    out.quantities.contact_force += std::max(contact.force, 0.0);
  }
  read_wires(session, solution, out, out.quantities);
  return {};
}

}  // namespace bowstring
