#include "kinematics/edge-frames/edge_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/curve_kinematics/adopt.hpp"
#include "core/curve_kinematics/orientation.hpp"
#include "core/curve_kinematics/sample.hpp"
#include "core/curve_kinematics/sites.hpp"
#include "core/curve_kinematics/station_output.hpp"
#include "core/model/manifold.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double smallest_stretch = 0.2;  // an edge below it counts as folded

/// The strains of the manifold in question.
template <Manifold manifold, class Turns, class Rotations>
auto& found(Turns& turns, Rotations& rotations) noexcept {
  if constexpr (manifold == Manifold::direction) {
    return turns;
  } else {
    return rotations;
  }
}

}  // namespace

Status EdgeFrames::declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept {
  return guard([&]() -> Status {
    mesh_ = make_curve_mesh(curve);
    if (Status status = check_curve(mesh_, needs); !status.ok()) return status;
    manifold_ =
        curve.dimension == 2 ? Manifold::circle : (needs.material_frames ? Manifold::rotation : Manifold::direction);
    closed_edges_.clear();
    for (int i = 0; i < mesh_.edges(); ++i) {
      if (!mesh_.edge_held(i)) closed_edges_.push_back(i);
    }
    declare_fields(needs, out);
    declare_sites(out);
    strain_state_ = axes_state_ = 0;
    if (manifold_ == Manifold::circle) axes_.resize(closed_edges_.size());
    if (manifold_ == Manifold::direction) turns_.resize(mesh_.stations.size());
    if (manifold_ == Manifold::rotation) rotations_.resize(mesh_.stations.size());
    out.closure_name = "edge closure";
    return {};
  });
}

void EdgeFrames::declare_fields(const Needs& needs, KinematicsDeclaration& out) {
  const std::vector<double> reference =
      transported_orientations(manifold_, edge_tangents(mesh_, mesh_.curve.reference), nullptr);
  first_frame_.assign(reference.begin(), reference.begin() + coordinate_count(manifold_, 1));
  position_ = add_field(position_field(mesh_), out);
  FieldDeclaration orientation = orientation_field(needs, reference);
  first_angle_ = orientation.start.front();
  orientation_ = add_field(std::move(orientation), out);
  if (mesh_.stretching()) edge_length_ = add_field(edge_length_field(), out);
  if (mesh_.sliding()) length_ = add_field(length_field(mesh_), out);
  held_start_.clear();
  if (mesh_.held_tangents > 0) {
    FieldDeclaration held = held_tangent_field(mesh_, manifold_, reference);
    held_start_ = held.start;
    held_tangent_ = add_field(std::move(held), out);
  }
}

FieldDeclaration EdgeFrames::orientation_field(const Needs& needs, const std::vector<double>& reference) const {
  FieldDeclaration field;
  field.name = "orientation";
  field.reason = manifold_ == Manifold::rotation ? needs.reason : "edge-frames has one orientation per edge";
  field.manifold = manifold_;
  field.count = mesh_.edges();
  field.reference = reference;
  field.start = start_orientations(mesh_, manifold_, reference);
  for (int i = 0; i < mesh_.edges(); ++i) {
    field.station.push_back(mesh_.edge_middle(i));
    field.fixed.insert(field.fixed.end(), at(tangent_count(manifold_, 1)),
                       static_cast<char>(mesh_.edge_held(i) ? 1 : 0));
  }
  return field;
}

FieldDeclaration EdgeFrames::edge_length_field() const {
  const int d = mesh_.dimension();
  FieldDeclaration field;
  field.name = "edge-length";
  field.reason = "the curve stretches";
  field.manifold = Manifold::real;
  field.count = mesh_.edges();
  field.reference.assign(mesh_.curve.edge_length, mesh_.curve.edge_length + mesh_.edges());
  field.upper.assign(at(mesh_.edges()), std::numeric_limits<double>::infinity());
  for (int i = 0; i < mesh_.edges(); ++i) {
    const double* p = mesh_.curve.start + i * d;
    double squared = 0.0;
    for (int k = 0; k < d; ++k) squared += (p[d + k] - p[k]) * (p[d + k] - p[k]);
    field.start.push_back(std::sqrt(squared));
    field.lower.push_back(smallest_stretch * mesh_.curve.edge_length[i]);
    field.fixed.push_back(mesh_.edge_held(i) ? 1 : 0);
    field.station.push_back(mesh_.edge_middle(i));
  }
  return field;
}

void EdgeFrames::declare_sites(KinematicsDeclaration& out) const {
  out.sites.push_back(node_site(mesh_, position_));
  out.sites.push_back(stations());
  out.sites.push_back(frames());
  if (mesh_.stretching()) out.sites.push_back(stretching_edges());
  if (mesh_.sliding()) out.sites.push_back(length_site(mesh_, length_));
  if (!closed_edges_.empty()) out.sites.push_back(closure());
}

SiteDeclaration EdgeFrames::stations() const {
  const int m = tangent_count(manifold_, 1);
  SiteDeclaration site = station_site(mesh_, m, 2 * m + (mesh_.sliding() ? 1 : 0), length_);
  site.linear = manifold_ == Manifold::circle;
  for (int k = 0; k < site.count; ++k) {
    const Station& station = mesh_.stations[at(k)];
    int* stencil = site.stencil.data() + k * site.width;
    for (int j = 0; j < m; ++j) {
      stencil[j] = orientation_unknown(station.earlier) + j;
      stencil[m + j] = orientation_unknown(station.later) + j;
    }
  }
  return site;
}

SiteDeclaration EdgeFrames::frames() const {
  SiteDeclaration site;
  site.site = Site::frame;
  site.count = mesh_.edges();
  site.values = site.width = tangent_count(manifold_, 1);
  site.identity = site.linear = true;
  for (int i = 0; i < mesh_.edges(); ++i) {
    site.ds.push_back(mesh_.edge_length[at(i)].at(mesh_.start_length()));
    site.arc.push_back(mesh_.edge_middle(i));
    for (int k = 0; k < site.width; ++k) site.stencil.push_back(orientation_.unknown_of(i) + k);
  }
  return site;
}

SiteDeclaration EdgeFrames::stretching_edges() const {
  SiteDeclaration site = edge_site(mesh_, 1);
  site.linear = true;
  for (int i = 0; i < mesh_.edges(); ++i) site.stencil.push_back(edge_length_.unknown_of(i));
  return site;
}

SiteDeclaration EdgeFrames::closure() const {
  const int d = mesh_.dimension();
  const int m = tangent_count(manifold_, 1);
  const bool varying = mesh_.sliding() || mesh_.stretching();
  SiteDeclaration site = closure_site(mesh_, closed_edges_, d, 2 * d + m + (varying ? 1 : 0));
  site.bent_first = 2 * d;
  for (const int edge : closed_edges_) {
    for (int k = 0; k < d; ++k) site.stencil.push_back(position_.unknown_of(edge) + k);
    for (int k = 0; k < d; ++k) site.stencil.push_back(position_.unknown_of(edge + 1) + k);
    for (int k = 0; k < m; ++k) site.stencil.push_back(orientation_.unknown_of(edge) + k);
    if (varying) site.stencil.push_back(length_unknown(edge));
  }
  return site;
}

int EdgeFrames::orientation_coordinate(int index) const noexcept {
  return index < mesh_.edges() ? orientation_.coordinate_of(index) : held_tangent_.coordinate_of(index - mesh_.edges());
}

int EdgeFrames::orientation_unknown(int index) const noexcept {
  return index < mesh_.edges() ? orientation_.unknown_of(index) : held_tangent_.unknown_of(index - mesh_.edges());
}

int EdgeFrames::length_unknown(int edge) const noexcept {
  if (mesh_.stretching()) return edge_length_.unknown_of(edge);
  return mesh_.sliding() ? length_.unknown : -1;
}

Status EdgeFrames::evaluate(const SiteEvaluation& evaluation) const noexcept {
  switch (evaluation.site) {
    case Site::node:
      evaluate_nodes(mesh_, position_, evaluation);
      return {};
    case Site::frame:
      evaluate_frames(evaluation);
      return {};
    case Site::edge:
      evaluate_edges(evaluation);
      return {};
    case Site::length:
      evaluate_length(mesh_, length_, evaluation);
      return {};
    case Site::station:
      switch (manifold_) {
        case Manifold::circle:
          evaluate_stations<Manifold::circle>(evaluation);
          return {};
        case Manifold::direction:
          evaluate_stations<Manifold::direction>(evaluation);
          return {};
        default:
          evaluate_stations<Manifold::rotation>(evaluation);
          return {};
      }
    case Site::closure:
      switch (manifold_) {
        case Manifold::circle:
          evaluate_closure<Manifold::circle>(evaluation);
          return {};
        case Manifold::direction:
          evaluate_closure<Manifold::direction>(evaluation);
          return {};
        default:
          evaluate_closure<Manifold::rotation>(evaluation);
          return {};
      }
    case Site::field:
      break;
  }
  return Status::failure(Code::unsupported, "edge-frames has no such site");
}

template <Manifold manifold>
void EdgeFrames::evaluate_stations(const SiteEvaluation& evaluation) const noexcept {
  using EdgeOrientation = Orientation<manifold>;
  constexpr int m = EdgeOrientation::components;
  const double* q = evaluation.q.data();
  const StationOutput<m, 2 * m> out(mesh_, length_.exists() ? q[length_.coordinate] : 0.0, evaluation);
  const bool known = evaluation.state != 0 && evaluation.state == strain_state_;
  for (int k = 0; k < static_cast<int>(mesh_.stations.size()); ++k) {
    const Station& station = mesh_.stations[at(k)];
    const auto compute = [&] {
      return station_strain(EdgeOrientation::load(q + orientation_coordinate(station.earlier)),
                            EdgeOrientation::load(q + orientation_coordinate(station.later)));
    };
    const auto write = [&](const StationStrain<manifold>& strain) {
      if (out.wants_values()) out.write_values(k, station, strain.value);
      if (out.wants_jacobian()) {
        Matrix<m, 2 * m> b;
        b.set_block(0, 0, strain.by_a);
        b.set_block(0, m, strain.by_b);
        out.write_jacobian(k, station, b);
      }
      if (out.wants_curvature()) out.write_curvature(k, station_curvature(strain, out.stress(k)));
    };
    if constexpr (manifold == Manifold::circle) {
      write(compute());
    } else {
      auto& strains = found<manifold>(turns_, rotations_);
      if (!known) strains[at(k)] = compute();
      write(strains[at(k)]);
    }
  }
  strain_state_ = evaluation.state;
}

void EdgeFrames::evaluate_frames(const SiteEvaluation& out) const noexcept {
  // In the plane the increment is counted from angle zero, elsewhere from the orientation itself.
  const int m = tangent_count(manifold_, 1);
  if (!out.values.empty()) {
    if (manifold_ == Manifold::circle) {
      std::copy_n(out.q.data() + orientation_.coordinate, mesh_.edges(), out.values.data());
    } else {
      std::fill(out.values.begin(), out.values.end(), 0.0);
    }
  }
  std::fill(out.curvature.begin(), out.curvature.end(), 0.0);
  if (out.jacobian.empty()) return;
  std::fill(out.jacobian.begin(), out.jacobian.end(), 0.0);
  for (int k = 0; k < mesh_.edges() * m; ++k) out.jacobian[at(k * m + k % m)] = 1.0;
}

void EdgeFrames::evaluate_edges(const SiteEvaluation& out) const noexcept {
  if (!out.values.empty()) std::copy_n(out.q.data() + edge_length_.coordinate, mesh_.edges(), out.values.data());
  std::fill(out.jacobian.begin(), out.jacobian.end(), 1.0);
  std::fill(out.curvature.begin(), out.curvature.end(), 0.0);
}

/// Rows r = p_{i+1} − p_i − ℓ t, with t = R_i e₁ and ℓ = constant + slope u, u the unknown length:
///   ∂r = (−I, I, −ℓ ∂t/∂δ, −slope t),  w·∂²r/∂δ² = −ℓ w·∂²t/∂δ²,  w·∂²r/∂δ∂u = −slope w·∂t/∂δ.
template <Manifold manifold>
void EdgeFrames::evaluate_closure(const SiteEvaluation& out) const noexcept {
  using EdgeOrientation = Orientation<manifold>;
  constexpr int d = EdgeOrientation::dimension, m = EdgeOrientation::components, fixed_columns = 2 * d + m;
  const bool varying = mesh_.sliding() || mesh_.stretching();
  const int width = fixed_columns + (varying ? 1 : 0);
  const double* q = out.q.data();
  const bool known = out.state != 0 && out.state == axes_state_;
  for (int k = 0; k < static_cast<int>(closed_edges_.size()); ++k) {
    const int edge = closed_edges_[at(k)];
    const auto compute = [&] { return axes(EdgeOrientation::load(q + orientation_.coordinate_of(edge))); };
    Matrix<d, d> r;
    if constexpr (manifold == Manifold::circle) {
      if (!known) axes_[at(k)] = compute();
      r = axes_[at(k)];
    } else {
      r = compute();
    }
    const LinearInLength length = closure_length(edge);
    const double unknown =
        mesh_.stretching() ? q[edge_length_.coordinate_of(edge)] : (mesh_.sliding() ? q[length_.coordinate] : 0.0);
    const Vector<d> t = tangent(r);
    const double edge_length = length.at(unknown);
    if (!out.values.empty()) {
      const double* p = q + position_.coordinate_of(edge);
      for (int a = 0; a < d; ++a) out.values[at(k * d + a)] = p[d + a] - p[a] - edge_length * t[a];
    }
    if (!out.jacobian.empty()) {
      double* b = out.jacobian.data() + k * d * width;
      for (int a = 0; a < d; ++a, b += width) {
        const Vector<m> gradient = tangent_gradient<manifold>(r, a);
        for (int j = 0; j < d; ++j) {
          b[j] = j == a ? -1.0 : 0.0;
          b[d + j] = j == a ? 1.0 : 0.0;
        }
        for (int j = 0; j < m; ++j) b[2 * d + j] = -edge_length * gradient[j];
        if (varying) b[fixed_columns] = -length.slope * t[a];
      }
    }
    if (!out.curvature.empty()) {
      const Vector<d> weight = Vector<d>::load(out.stress.data() + k * d);
      const Matrix<m, m> bend = tangent_curvature<manifold>(r, weight);
      double* h = out.curvature.data() + k * packed_size(width - 2 * d);
      Vector<m> pull;
      for (int a = 0; a < d; ++a) pull += weight[a] * tangent_gradient<manifold>(r, a);
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j <= i; ++j) h[packed_index(i, j)] = -edge_length * bend(i, j);
        if (varying) h[packed_index(m, i)] = -length.slope * pull[i];
      }
      if (varying) h[packed_index(m, m)] = 0.0;
    }
  }
  axes_state_ = out.state;
}

LinearInLength EdgeFrames::closure_length(int edge) const noexcept {
  return mesh_.stretching() ? LinearInLength{0.0, 1.0} : mesh_.edge_length[at(edge)];
}

Status EdgeFrames::sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept {
  return guard([&] {
    const double* begin = q.data() + orientation_.coordinate;
    std::vector<double> orientation(begin, begin + mesh_.edges() * orientation_.coordinates_each);
    if (manifold_ == Manifold::direction) {
      std::vector<double> tangents(at(3 * mesh_.edges()));
      for (int i = 0; i < mesh_.edges(); ++i) {
        tangent(DirectionOrientation::load(begin + 4 * i)).store(tangents.data() + 3 * i);
      }
      // The twist that directions carry is immaterial: frames of an untwisted curve are Bishop's.
      orientation = transported_orientations(manifold_, tangents, first_frame_.data());
    }
    return sample_edges(mesh_, q.data() + position_.coordinate, frame_quaternions(manifold_, orientation),
                        edge_coordinate, out);
  });
}

Status EdgeFrames::adopt(const CurveShape& shape, Span<double> q) const noexcept {
  return guard([&]() -> Status {
    if (Status status = check_shape(mesh_, shape); !status.ok()) return status;
    adopt_positions(mesh_, shape, position_, length_, q);
    double* orientation = q.data() + orientation_.coordinate;
    if (manifold_ == Manifold::circle) {
      const std::vector<double> angles = adopted_angles(mesh_, shape, held_start_, first_angle_);
      std::copy(angles.begin(), angles.end(), orientation);
    } else {
      std::copy(shape.orientation.begin(), shape.orientation.end(), orientation);
    }
    const int d = mesh_.dimension();
    for (int i = 0; edge_length_.exists() && i < mesh_.edges(); ++i) {
      const double* p = shape.position.data() + i * d;
      q[at(edge_length_.coordinate_of(i))] = std::hypot(p[d] - p[0], p[d + 1] - p[1], d == 3 ? p[d + 2] - p[2] : 0.0);
    }
    if (held_tangent_.exists()) std::copy(held_start_.begin(), held_start_.end(), q.data() + held_tangent_.coordinate);
    return {};
  });
}

double EdgeFrames::rounding_floor(double bending_stiffness) const noexcept {
  const double shortest = *std::min_element(mesh_.curve.edge_length, mesh_.curve.edge_length + mesh_.edges());
  return bending_stiffness * std::numeric_limits<double>::epsilon() * M_PI / (shortest * shortest);
}

}  // namespace bowstring
