#include "kinematics/nodes/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/curve_kinematics/orientation.hpp"
#include "core/curve_kinematics/sample.hpp"
#include "core/curve_kinematics/sites.hpp"
#include "core/curve_kinematics/station_output.hpp"
#include "core/model/manifold.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What a station reads of an edge or of a held tangent.
template <int d>
struct Side {
  Vector<d> tangent;
  lie::Rotation frame;    ///< in space: first axis along the tangent
  double length = 0.0;    ///< of an edge; 0 for a held tangent
  Matrix<d - 1, d> turn;  ///< ∂α/∂e of an edge: α the tangent numbers of its direction, e its vector

  bool is_edge() const noexcept { return length > 0.0; }
};

/// α of a direction that follows e has ∂α/∂e = N/ℓ, the rows of N orthonormal to the tangent.
Matrix<1, 2> normals(const Side<2>& side) noexcept { return {{-side.tangent[1], side.tangent[0]}}; }
Matrix<2, 3> normals(const Side<3>& side) noexcept {
  const Matrix3 r = side.frame.matrix();
  return {{-r(0, 2), -r(1, 2), -r(2, 2), r(0, 1), r(1, 1), r(2, 1)}};
}

void set_frame(Side<2>&) noexcept {}
void set_frame(Side<3>& side) noexcept { side.frame = lie::frame_from_tangent(side.tangent); }

/// The edge from the node at `p` to the next one. Its length is not positive where it has no direction.
template <int d>
Side<d> edge_side(const double* p) noexcept {
  Side<d> side;
  const Vector<d> edge = Vector<d>::load(p + d) - Vector<d>::load(p);
  side.length = norm(edge);
  side.tangent = edge / side.length;
  set_frame(side);
  side.turn = normals(side) / side.length;
  return side;
}

void load_held(const double* q, Side<2>& side) noexcept { side.tangent = tangent(PlanarOrientation::load(q)); }
void load_held(const double* q, Side<3>& side) noexcept {
  side.frame = lie::Rotation::load(q);
  side.tangent = side.frame.first_axis();
}

StationStrain<1> strain_between(const Side<2>& earlier, const Side<2>& later) noexcept {
  const double turn = std::atan2(cross(earlier.tangent, later.tangent), dot(earlier.tangent, later.tangent));
  return {{{turn}}, {{-1.0}}, {{1.0}}};
}
DirectionOrientation direction(const Side<3>& side) noexcept { return {side.frame}; }
StationStrain<2> strain_between(const Side<3>& earlier, const Side<3>& later) noexcept {
  return station_strain(direction(earlier), direction(later));
}

/// First unknown of each side within a station's stencil, L left out. Two edges: their three nodes; a held tangent
/// stands before the first edge's nodes or after the last one's.
struct Columns {
  int earlier, later;
};
constexpr Columns columns_of(const Station& station, int edges, int d) noexcept {
  if (station.earlier >= edges) return {0, d - 1};
  return {0, station.later >= edges ? 2 * d : d};
}

/// ∂α/∂δ over a station's stencil: rows of one side.
template <int d>
void set_side(const Side<d>& side, int row, int column, Matrix<2 * (d - 1), 3 * d>& out) noexcept {
  if (!side.is_edge()) {
    for (int i = 0; i < d - 1; ++i) out(row + i, column + i) = 1.0;
    return;
  }
  out.set_block(row, column, -side.turn);
  out.set_block(row, column + d, side.turn);
}

/// Adds g·∂²α/∂δ² of an edge: over its vector it is −(t vᵀ + v tᵀ)/ℓ with v = gᵀ∂α/∂e.
template <int d>
void add_turn_curvature(const Side<d>& side, const Vector<d - 1>& g, int column, Matrix<3 * d, 3 * d>& out) noexcept {
  if (!side.is_edge()) return;
  const Vector<d> v = side.turn.transpose() * g;
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      const double k = -(side.tangent[i] * v[j] + v[i] * side.tangent[j]) / side.length;
      out(column + i, column + j) += k;
      out(column + d + i, column + j) -= k;
      out(column + i, column + d + j) -= k;
      out(column + d + i, column + d + j) += k;
    }
  }
}

}  // namespace

Status Nodes::declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept {
  return guard([&]() -> Status {
    if (needs.material_frames && curve.dimension == 3) {
      return Status::failure(Code::unsupported, "node positions alone carry no twist, but " + needs.reason +
                                                    ": use kinematics = \"edge-frames\"");
    }
    mesh_ = make_curve_mesh(curve);
    if (Status status = check_curve(mesh_, needs); !status.ok()) return status;
    measured_edges_.clear();
    for (int i = 0; i < mesh_.edges(); ++i) {
      if (mesh_.stretching() || needs_spacing(i)) measured_edges_.push_back(i);
    }
    declare_fields(out);
    declare_sites(out);
    out.closure_name = "uniform spacing";
    return {};
  });
}

Manifold Nodes::manifold() const noexcept { return mesh_.dimension() == 2 ? Manifold::circle : Manifold::direction; }

/// A row between two nodes that are wholly held would only freeze L, unless L has nothing else to follow.
bool Nodes::needs_spacing(int edge) const noexcept {
  if (mesh_.edge_held(edge)) return false;
  bool held = true;
  for (int k = 0; k < mesh_.dimension(); ++k) {
    held = held && mesh_.position_held(edge, k) && mesh_.position_held(edge + 1, k);
  }
  return !held || mesh_.sliding();
}

void Nodes::declare_fields(KinematicsDeclaration& out) {
  const std::vector<double> reference =
      transported_orientations(manifold(), edge_tangents(mesh_, mesh_.curve.reference), nullptr);
  first_frame_.assign(reference.begin(), reference.begin() + coordinate_count(manifold(), 1));
  position_ = add_field(position_field(mesh_), out);
  if (mesh_.sliding()) length_ = add_field(length_field(mesh_), out);
  if (mesh_.held_tangents > 0) held_tangent_ = add_field(held_tangent_field(mesh_, manifold(), reference), out);
}

void Nodes::declare_sites(KinematicsDeclaration& out) const {
  out.sites.push_back(node_site(mesh_, position_));
  out.sites.push_back(stations());
  if (!measured_edges_.empty()) out.sites.push_back(edge_lengths());
  if (mesh_.sliding()) out.sites.push_back(length_site(mesh_, length_));
}

SiteDeclaration Nodes::stations() const {
  const int d = mesh_.dimension();
  SiteDeclaration site = station_site(mesh_, d - 1, 3 * d + (mesh_.sliding() ? 1 : 0), length_);
  for (int k = 0; k < site.count; ++k) {
    const Station& station = mesh_.stations[at(k)];
    int* stencil = site.stencil.data() + k * site.width;
    const auto set = [&](int orientation, int column) {
      const bool edge = orientation < mesh_.edges();
      const int first =
          edge ? position_.unknown_of(orientation) : held_tangent_.unknown_of(orientation - mesh_.edges());
      for (int j = 0; j < (edge ? 2 * d : d - 1); ++j) stencil[column + j] = first + j;
    };
    const Columns columns = columns_of(station, mesh_.edges(), d);
    set(station.earlier, columns.earlier);
    set(station.later, columns.later);
  }
  return site;
}

SiteDeclaration Nodes::edge_lengths() const {
  const int d = mesh_.dimension();
  const int width = 2 * d + (mesh_.sliding() ? 1 : 0);
  SiteDeclaration site = mesh_.stretching() ? edge_site(mesh_, width) : closure_site(mesh_, measured_edges_, 1, width);
  for (const int edge : measured_edges_) {
    for (int k = 0; k < 2 * d; ++k) site.stencil.push_back(position_.unknown_of(edge) + k);
    if (mesh_.sliding()) site.stencil.push_back(length_.unknown);
  }
  return site;
}

Status Nodes::evaluate(const SiteEvaluation& evaluation) const noexcept {
  const bool planar = mesh_.dimension() == 2;
  switch (evaluation.site) {
    case Site::node:
      evaluate_nodes(mesh_, position_, evaluation);
      return {};
    case Site::length:
      evaluate_length(mesh_, length_, evaluation);
      return {};
    case Site::station:
      return planar ? evaluate_stations<2>(evaluation) : evaluate_stations<3>(evaluation);
    case Site::edge:
    case Site::closure:
      return planar ? evaluate_edge_lengths<2>(evaluation) : evaluate_edge_lengths<3>(evaluation);
    case Site::frame:
    case Site::field:
      break;
  }
  return Status::failure(Code::unsupported, "nodes has no such site");
}

/// ζ(α, β) of the two sides' directions, with α(δ), β(δ) of the nodes: B = ∂ζ/∂(α,β) A with A = ∂(α,β)/∂δ, and
/// Σ stress ∂²ζ/∂δ² = Aᵀ (Σ stress ∂²ζ/∂(α,β)²) A + Σ (stressᵀ∂ζ/∂(α,β)) ∂²(α,β)/∂δ².
template <int d>
Status Nodes::evaluate_stations(const SiteEvaluation& evaluation) const noexcept {
  constexpr int m = d - 1;
  const double* q = evaluation.q.data();
  const StationOutput<m, 3 * d> out(mesh_, length_.exists() ? q[length_.coordinate] : 0.0, evaluation);
  const auto load = [&](int orientation, Side<d>& side) {
    if (orientation < mesh_.edges()) {
      side = edge_side<d>(q + position_.coordinate_of(orientation));
      return side.is_edge();
    }
    side = {};
    load_held(q + held_tangent_.coordinate_of(orientation - mesh_.edges()), side);
    return true;
  };

  Side<d> earlier, later;
  if (!load(mesh_.stations.front().earlier, earlier)) return no_direction(mesh_.stations.front().earlier);
  for (int k = 0; k < static_cast<int>(mesh_.stations.size()); ++k) {
    const Station& station = mesh_.stations[at(k)];
    if (!load(station.later, later)) return no_direction(station.later);
    const StationStrain<m> strain = strain_between(earlier, later);
    if (out.wants_values()) out.write_values(k, station, strain.value);
    if (out.wants_jacobian() || out.wants_curvature()) {
      const auto [first, second] = columns_of(station, mesh_.edges(), d);
      Matrix<2 * m, 3 * d> turns;
      set_side(earlier, 0, first, turns);
      set_side(later, m, second, turns);
      if (out.wants_jacobian()) {
        Matrix<m, 2 * m> by_turns;
        by_turns.set_block(0, 0, strain.by_earlier);
        by_turns.set_block(0, m, strain.by_later);
        out.write_jacobian(k, station, by_turns * turns);
      }
      if (out.wants_curvature()) {
        const Vector<m> stress = out.stress(k);
        Matrix<3 * d, 3 * d> h;
        if constexpr (d == 3) {
          h = turns.transpose() * (station_curvature(direction(earlier), direction(later), stress) * turns);
        }
        add_turn_curvature(earlier, strain.by_earlier.transpose() * stress, first, h);
        add_turn_curvature(later, strain.by_later.transpose() * stress, second, h);
        out.write_curvature(k, h);
      }
    }
    earlier = later;
  }
  return {};
}

/// y = |e| on a stretching curve, |e| − ℓ(L) on a wire: ∂|e| = t, ∂²|e| = (I − t tᵀ)/|e|, and ℓ is linear.
template <int d>
Status Nodes::evaluate_edge_lengths(const SiteEvaluation& out) const noexcept {
  const int varying = mesh_.sliding() ? 1 : 0;
  const int width = 2 * d + varying;
  const double* q = out.q.data();
  const double length = mesh_.sliding() ? q[length_.coordinate] : 0.0;
  for (int k = 0; k < static_cast<int>(measured_edges_.size()); ++k) {
    const int edge = measured_edges_[at(k)];
    const double* p = q + position_.coordinate_of(edge);
    const Vector<d> vector = Vector<d>::load(p + d) - Vector<d>::load(p);
    const double measured = norm(vector);
    if (!(measured > 0.0)) return no_direction(edge);
    const Vector<d> t = vector / measured;
    const LinearInLength share = mesh_.stretching() ? LinearInLength{} : mesh_.edge_length[at(edge)];
    if (!out.values.empty()) out.values[at(k)] = measured - share.at(length);
    if (!out.jacobian.empty()) {
      double* b = out.jacobian.data() + k * width;
      for (int i = 0; i < d; ++i) b[i] = -t[i], b[d + i] = t[i];
      if (varying != 0) b[2 * d] = -share.slope;
    }
    if (!out.curvature.empty()) {
      const double scale = out.stress[at(k)] / measured;
      double* h = out.curvature.data() + k * packed_size(width);
      std::fill(h, h + packed_size(width), 0.0);
      for (int i = 0; i < d; ++i) {
        for (int j = 0; j < d; ++j) {
          const double entry = scale * ((i == j ? 1.0 : 0.0) - t[i] * t[j]);
          h[packed_index(d + i, j)] = -entry;
          if (j > i) continue;
          h[packed_index(i, j)] = entry;
          h[packed_index(d + i, d + j)] = entry;
        }
      }
    }
  }
  return {};
}

Status Nodes::no_direction(int edge) const noexcept {
  return guard([&] {
    return Status::failure(Code::failed, "edge " + std::to_string(edge) + " of '" + mesh_.curve.name + "' (nodes " +
                                             std::to_string(edge) + " and " + std::to_string(edge + 1) +
                                             ") has no length, and so no direction");
  });
}

Status Nodes::sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept {
  return guard([&] {
    const double* points = q.data() + position_.coordinate;
    const std::vector<double> orientation =
        transported_orientations(manifold(), edge_tangents(mesh_, points), first_frame_.data());
    return sample_edges(mesh_, points, frame_quaternions(manifold(), orientation), edge_coordinate, out);
  });
}

double Nodes::rounding_floor(double bending_stiffness) const noexcept {
  const int d = mesh_.dimension();
  double farthest = 0.0;
  for (int i = 0; i < mesh_.nodes(); ++i) {
    double squared = 0.0;
    for (int k = 0; k < d; ++k) squared += mesh_.curve.reference[i * d + k] * mesh_.curve.reference[i * d + k];
    farthest = std::max(farthest, std::sqrt(squared));
  }
  const double shortest = *std::min_element(mesh_.curve.edge_length, mesh_.curve.edge_length + mesh_.edges());
  return bending_stiffness * std::numeric_limits<double>::epsilon() * farthest / (shortest * shortest * shortest);
}

}  // namespace bowstring
