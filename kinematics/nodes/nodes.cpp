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

/// What a station reads of an edge or of a held tangent. An edge has `edge_numbers` unknowns of its own: its vector e,
/// as the difference of its nodes, and with material frames its angle.
template <Manifold manifold>
struct Side {
  static constexpr int d = Orientation<manifold>::dimension, m = Orientation<manifold>::components;
  static constexpr int angles = manifold == Manifold::rotation ? 1 : 0;
  static constexpr int edge_numbers = d + angles;

  Vector<d> tangent;
  lie::Rotation frame;           ///< in space: first axis along the tangent
  double length = 0.0;           ///< of an edge; 0 for a held tangent
  Matrix<m, edge_numbers> turn;  ///< ∂α/∂(e, φ): α the tangent numbers of the edge's orientation
  Vector<d> twist_rate;          ///< with material frames ∇D/D, D = ℓ² (1 + t·a) (README.md)

  bool is_edge() const noexcept { return length > 0.0; }
};
using PlanarSide = Side<Manifold::circle>;
using DirectionSide = Side<Manifold::direction>;
using FrameSide = Side<Manifold::rotation>;

/// The reference frame of an edge, which its tangent and its angle turn.
struct EdgeReference {
  const lie::Rotation* frame = nullptr;
  double angle = 0.0;
};

/// Rows of ∂α/∂e across the edge: N/ℓ, the rows of N orthonormal to the tangent.
Matrix<2, 3> across(const lie::Rotation& frame, double length) noexcept {
  const Matrix3 r = frame.matrix();
  return Matrix<2, 3>{{-r(0, 2), -r(1, 2), -r(2, 2), r(0, 1), r(1, 1), r(2, 1)}} / length;
}

void set_orientation(const EdgeReference&, PlanarSide& side) noexcept {
  side.turn = Matrix<1, 2>{{-side.tangent[1], side.tangent[0]}} / side.length;
}
void set_orientation(const EdgeReference&, DirectionSide& side) noexcept {
  side.frame = lie::frame_from_tangent(side.tangent);
  side.turn = across(side.frame, side.length);
}
/// The frame of State 1 after the least turn from its tangent a to the edge's t, then turned by the angle about t.
void set_orientation(const EdgeReference& reference, FrameSide& side) noexcept {
  const double half = 0.5 * reference.angle;
  side.frame = lie::transport(*reference.frame, side.tangent) * lie::Rotation{std::cos(half), std::sin(half), 0.0, 0.0};
  const Vector3 a = reference.frame->first_axis();
  const double cosine = dot(a, side.tangent);
  const double scale = side.length * (1.0 + cosine);
  const Vector3 twist = cross(side.tangent, a) / scale;
  side.twist_rate = ((2.0 + cosine) * side.tangent + a) / scale;
  for (int k = 0; k < 3; ++k) side.turn(0, k) = twist[k];
  side.turn(0, 3) = 1.0;
  side.turn.set_block(1, 0, across(side.frame, side.length));
}

/// Whether the least turn from State 1 exists.
bool has_frame(const EdgeReference&, const PlanarSide&) noexcept { return true; }
bool has_frame(const EdgeReference&, const DirectionSide&) noexcept { return true; }
bool has_frame(const EdgeReference& reference, const FrameSide& side) noexcept {
  constexpr double opposite = 1e-8;  // 1 + cos of a turn of π − 1.4e-4
  return 1.0 + dot(reference.frame->first_axis(), side.tangent) > opposite;
}

/// The edge from the node at `p` to the next one. Its length is not positive where it has no direction.
template <Manifold manifold>
Side<manifold> edge_side(const double* p, const EdgeReference& reference) noexcept {
  constexpr int d = Side<manifold>::d;
  Side<manifold> side;
  const Vector<d> edge = Vector<d>::load(p + d) - Vector<d>::load(p);
  side.length = norm(edge);
  side.tangent = edge / side.length;
  set_orientation(reference, side);
  return side;
}

void load_held(const double* q, PlanarSide& side) noexcept { side.tangent = tangent(PlanarOrientation::load(q)); }
template <Manifold manifold>
void load_held(const double* q, Side<manifold>& side) noexcept {
  side.frame = lie::Rotation::load(q);
  side.tangent = side.frame.first_axis();
}

template <Manifold manifold>
Orientation<manifold> orientation(const Side<manifold>& side) noexcept {
  return {side.frame};
}
StationStrain<1> strain_between(const PlanarSide& earlier, const PlanarSide& later) noexcept {
  const double turn = std::atan2(cross(earlier.tangent, later.tangent), dot(earlier.tangent, later.tangent));
  return {{{turn}}, {{-1.0}}, {{1.0}}};
}
template <Manifold manifold>
auto strain_between(const Side<manifold>& earlier, const Side<manifold>& later) noexcept {
  return station_strain(orientation(earlier), orientation(later));
}

/// Where the unknowns of one side begin within a station's stencil: of a held tangent all at `first`, of an edge its
/// two nodes there and its angle at `angle`.
struct SideColumns {
  int first = 0, angle = 0;
};
/// Two edges: their three nodes, then their angles. A held tangent stands before the first edge or after the last
/// one. L, which comes last, is left out.
struct StationColumns {
  SideColumns earlier, later;
};
constexpr StationColumns station_columns(const Station& station, int edges, int d, int m, int angles) noexcept {
  if (station.earlier >= edges) return {{0, 0}, {m, m + 2 * d}};
  if (station.later >= edges) return {{0, 2 * d}, {2 * d + angles, 0}};
  return {{0, 3 * d}, {d, 3 * d + 1}};
}
template <Manifold manifold>
constexpr int station_width = 3 * Side<manifold>::d + 2 * Side<manifold>::angles;

/// ∂α/∂δ over a station's stencil: rows of one side.
template <Manifold manifold, int rows, int columns>
void set_side(const Side<manifold>& side, int row, SideColumns at, Matrix<rows, columns>& out) noexcept {
  constexpr int d = Side<manifold>::d, m = Side<manifold>::m;
  for (int i = 0; i < m; ++i) {
    if (!side.is_edge()) {
      out(row + i, at.first + i) = 1.0;
      continue;
    }
    for (int k = 0; k < d; ++k) {
      out(row + i, at.first + k) = -side.turn(i, k);
      out(row + i, at.first + d + k) = side.turn(i, k);
    }
    if constexpr (Side<manifold>::angles != 0) out(row + i, at.angle) = side.turn(i, d);
  }
}

/// g·∂²α over an edge's own (e, φ). Across the edge it is −(t vᵀ + v tᵀ)/ℓ over e, with v = gᵀ∂α/∂e of the rows across.
template <Manifold manifold>
auto edge_turn_curvature(const Side<manifold>& side, const Vector<Side<manifold>::m>& g) noexcept {
  constexpr int d = Side<manifold>::d, m = Side<manifold>::m, n = Side<manifold>::edge_numbers;
  constexpr int twist = m - (d - 1);  // rows before those across the edge
  Vector<n> v, t;
  for (int k = 0; k < d; ++k) {
    t[k] = side.tangent[k];
    for (int i = twist; i < m; ++i) v[k] += g[i] * side.turn(i, k);
  }
  Matrix<n, n> out = (outer(t, v) + outer(v, t)) * (-1.0 / side.length);
  if constexpr (twist != 0) {
    // With ω the rows of ∂α: g₁ ω₁' + ω₁ (g₂ ω₃ − g₃ ω₂), ω₁' = −(ω₁ − φ')(∇D/D) (README.md).
    Vector<n> w1, along, rate, s;
    for (int k = 0; k < n; ++k) {
      w1[k] = side.turn(0, k);
      s[k] = g[1] * side.turn(2, k) - g[2] * side.turn(1, k);
      if (k < d) along[k] = w1[k], rate[k] = side.twist_rate[k];
    }
    out += symmetric_part(outer(w1, s)) - g[0] * symmetric_part(outer(along, rate));
  }
  return out;
}

/// Adds it over a station's stencil, where e is the difference of two nodes.
template <Manifold manifold, int columns>
void add_turn_curvature(const Side<manifold>& side, const Vector<Side<manifold>::m>& g, SideColumns at,
                        Matrix<columns, columns>& out) noexcept {
  constexpr int d = Side<manifold>::d, n = Side<manifold>::edge_numbers;
  if (!side.is_edge()) return;
  const Matrix<n, n> own = edge_turn_curvature(side, g);
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      out(at.first + i, at.first + j) += own(i, j);
      out(at.first + d + i, at.first + j) -= own(i, j);
      out(at.first + i, at.first + d + j) -= own(i, j);
      out(at.first + d + i, at.first + d + j) += own(i, j);
    }
  }
  if constexpr (Side<manifold>::angles != 0) {
    for (int i = 0; i < d; ++i) {
      out(at.angle, at.first + i) -= own(d, i);
      out(at.first + i, at.angle) -= own(d, i);
      out(at.angle, at.first + d + i) += own(d, i);
      out(at.first + d + i, at.angle) += own(d, i);
    }
    out(at.angle, at.angle) += own(d, d);
  }
}

}  // namespace

Status Nodes::declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept {
  return guard([&]() -> Status {
    mesh_ = make_curve_mesh(curve);
    if (Status status = check_curve(mesh_, needs); !status.ok()) return status;
    manifold_ =
        curve.dimension == 2 ? Manifold::circle : (needs.material_frames ? Manifold::rotation : Manifold::direction);
    measured_edges_.clear();
    for (int i = 0; i < mesh_.edges(); ++i) {
      if (mesh_.stretching() || needs_spacing(i)) measured_edges_.push_back(i);
    }
    declare_fields(needs, out);
    declare_sites(out);
    out.closure_name = "uniform spacing";
    return check_winding(out);
  });
}

/// In the plane whole turns between two held tangents live in the positions alone, and so in the start.
Status Nodes::check_winding(const KinematicsDeclaration& declared) const {
  if (manifold_ != Manifold::circle || mesh_.held_tangents != 2) return {};
  std::vector<double> q;
  for (const FieldDeclaration& field : declared.fields) q.insert(q.end(), field.start.begin(), field.start.end());
  const int each = 1 + (mesh_.sliding() ? 2 : 0);
  std::vector<double> strain(mesh_.stations.size() * at(each));
  SiteEvaluation evaluation;
  evaluation.site = Site::station;
  evaluation.q = q;
  evaluation.values = strain;
  if (Status status = evaluate(evaluation); !status.ok()) return status;
  const double* held = q.data() + held_tangent_.coordinate;
  double missing = held[1] - held[0];
  for (std::size_t i = 0; i < strain.size(); i += at(each)) missing -= strain[i];
  if (std::fabs(missing) < 1.0) return {};
  return Status::failure(Code::unsupported, std::string("the start of '") + mesh_.curve.name +
                                                "' does not wind as often as its held ends are turned, and node "
                                                "positions alone could not make up for it: use kinematics = "
                                                "\"edge-frames\"");
}

/// A row between two nodes that are wholly held would only freeze L, unless L has nothing else to follow.
bool Nodes::needs_spacing(int edge) const noexcept {
  if (mesh_.edge_held(edge)) return false;
  bool held = true;
  for (int k = 0; k < mesh_.dimension(); ++k) {
    held = held && mesh_.position_held(edge, k) && mesh_.position_held(edge + 1, k);
  }
  return !held || mesh_.sliding();
}

void Nodes::declare_fields(const Needs& needs, KinematicsDeclaration& out) {
  const std::vector<double> reference =
      transported_orientations(manifold_, edge_tangents(mesh_, mesh_.curve.reference), nullptr);
  first_frame_.assign(reference.begin(), reference.begin() + coordinate_count(manifold_, 1));
  position_ = add_field(position_field(mesh_), out);
  if (manifold_ == Manifold::rotation) {
    reference_frames_.clear();
    for (int i = 0; i < mesh_.edges(); ++i) reference_frames_.push_back(lie::Rotation::load(reference.data() + 4 * i));
    angle_ = add_field(angle_field(needs), out);
  }
  if (mesh_.sliding()) length_ = add_field(length_field(mesh_), out);
  if (mesh_.held_tangents > 0) held_tangent_ = add_field(held_tangent_field(mesh_, manifold_, reference), out);
}

/// Zero in State 1, whose frames are Bishop's. The start's are as well: the angle is what State 1's miss of them when
/// each follows its own edge.
FieldDeclaration Nodes::angle_field(const Needs& needs) const {
  FieldDeclaration field;
  field.name = "angle";
  field.reason = needs.reason;
  field.manifold = Manifold::circle;
  field.count = mesh_.edges();
  field.reference.assign(at(mesh_.edges()), 0.0);
  const std::vector<double> tangents = edge_tangents(mesh_, mesh_.curve.start);
  const std::vector<double> start = transported_orientations(manifold_, tangents, first_frame_.data());
  const double* turn = mesh_.curve.start_turn;
  for (int i = 0; i < mesh_.edges(); ++i) {
    const lie::Rotation follows = lie::transport(reference_frames_[at(i)], Vector3::load(tangents.data() + 3 * i));
    field.start.push_back(lie::log(follows.inverse() * lie::Rotation::load(start.data() + 4 * i))[0] +
                          (turn != nullptr ? turn[i] : 0.0));
    field.station.push_back(mesh_.edge_middle(i));
    field.fixed.push_back(mesh_.edge_held(i) ? 1 : 0);
  }
  return field;
}

void Nodes::declare_sites(KinematicsDeclaration& out) const {
  out.sites.push_back(node_site(mesh_, position_));
  out.sites.push_back(stations());
  if (!measured_edges_.empty()) out.sites.push_back(edge_lengths());
  if (mesh_.sliding()) out.sites.push_back(length_site(mesh_, length_));
}

SiteDeclaration Nodes::stations() const {
  const int d = mesh_.dimension(), m = tangent_count(manifold_, 1), angles = angle_.exists() ? 1 : 0;
  SiteDeclaration site = station_site(mesh_, m, 3 * d + 2 * angles + (mesh_.sliding() ? 1 : 0), length_);
  for (int k = 0; k < site.count; ++k) {
    const Station& station = mesh_.stations[at(k)];
    int* stencil = site.stencil.data() + k * site.width;
    const auto set = [&](int orientation, SideColumns columns) {
      const bool edge = orientation < mesh_.edges();
      const int first =
          edge ? position_.unknown_of(orientation) : held_tangent_.unknown_of(orientation - mesh_.edges());
      for (int j = 0; j < (edge ? 2 * d : m); ++j) stencil[columns.first + j] = first + j;
      if (edge && angles != 0) stencil[columns.angle] = angle_.unknown_of(orientation);
    };
    const StationColumns columns = station_columns(station, mesh_.edges(), d, m, angles);
    set(station.earlier, columns.earlier);
    set(station.later, columns.later);
  }
  return site;
}

SiteDeclaration Nodes::edge_lengths() const {
  const int d = mesh_.dimension();
  const int width = 2 * d + (mesh_.sliding() ? 1 : 0);
  SiteDeclaration site = mesh_.stretching() ? edge_site(mesh_, width) : closure_site(mesh_, measured_edges_, 1, width);
  site.bent_count = 2 * d;
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
      switch (manifold_) {
        case Manifold::circle:
          return evaluate_stations<Manifold::circle>(evaluation);
        case Manifold::direction:
          return evaluate_stations<Manifold::direction>(evaluation);
        default:
          return evaluate_stations<Manifold::rotation>(evaluation);
      }
    case Site::edge:
    case Site::closure:
      return planar ? evaluate_edge_lengths<2>(evaluation) : evaluate_edge_lengths<3>(evaluation);
    case Site::frame:
    case Site::field:
      break;
  }
  return Status::failure(Code::unsupported, "nodes has no such site");
}

/// ζ(α, β) of the two sides' orientations, with α(δ), β(δ) of their unknowns: B = ∂ζ/∂(α,β) A with A = ∂(α,β)/∂δ, and
/// Σ stress ∂²ζ/∂δ² = Aᵀ (Σ stress ∂²ζ/∂(α,β)²) A + Σ (stressᵀ∂ζ/∂(α,β)) ∂²(α,β)/∂δ².
template <Manifold manifold>
Status Nodes::evaluate_stations(const SiteEvaluation& evaluation) const noexcept {
  using EdgeSide = Side<manifold>;
  constexpr int d = EdgeSide::d, m = EdgeSide::m, width = station_width<manifold>;
  const double* q = evaluation.q.data();
  const StationOutput<m, width> out(mesh_, length_.exists() ? q[length_.coordinate] : 0.0, evaluation);
  const auto load = [&](int index, EdgeSide& side) {
    if (index < mesh_.edges()) {
      EdgeReference reference;
      if (EdgeSide::angles != 0) reference = {&reference_frames_[at(index)], q[angle_.coordinate_of(index)]};
      side = edge_side<manifold>(q + position_.coordinate_of(index), reference);
      return side.is_edge() && has_frame(reference, side);
    }
    side = {};
    load_held(q + held_tangent_.coordinate_of(index - mesh_.edges()), side);
    return true;
  };

  EdgeSide earlier, later;
  if (!load(mesh_.stations.front().earlier, earlier)) return no_orientation(mesh_.stations.front().earlier, q);
  for (int k = 0; k < static_cast<int>(mesh_.stations.size()); ++k) {
    const Station& station = mesh_.stations[at(k)];
    if (!load(station.later, later)) return no_orientation(station.later, q);
    const StationStrain<m> strain = strain_between(earlier, later);
    if (out.wants_values()) out.write_values(k, station, strain.value);
    if (out.wants_jacobian() || out.wants_curvature()) {
      const StationColumns columns = station_columns(station, mesh_.edges(), d, m, EdgeSide::angles);
      Matrix<2 * m, width> turns;
      set_side(earlier, 0, columns.earlier, turns);
      set_side(later, m, columns.later, turns);
      if (out.wants_jacobian()) {
        Matrix<m, 2 * m> by_turns;
        by_turns.set_block(0, 0, strain.by_earlier);
        by_turns.set_block(0, m, strain.by_later);
        out.write_jacobian(k, station, by_turns * turns);
      }
      if (out.wants_curvature()) {
        const Vector<m> stress = out.stress(k);
        Matrix<width, width> h;
        if constexpr (d == 3) {
          h = turns.transpose() * (station_curvature(orientation(earlier), orientation(later), stress) * turns);
        }
        add_turn_curvature(earlier, strain.by_earlier.transpose() * stress, columns.earlier, h);
        add_turn_curvature(later, strain.by_later.transpose() * stress, columns.later, h);
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
    if (!(measured > 0.0)) return no_orientation(edge, q);
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
      double* h = out.curvature.data() + k * packed_size(2 * d);
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

Status Nodes::no_orientation(int edge, const double* q) const noexcept {
  return guard([&] {
    const int d = mesh_.dimension();
    const double* p = q + position_.coordinate_of(edge);
    const bool has_length = !std::equal(p, p + d, p + d);
    return Status::failure(
        Code::failed, "edge " + std::to_string(edge) + " of '" + mesh_.curve.name + "' (nodes " + std::to_string(edge) +
                          " and " + std::to_string(edge + 1) +
                          (has_length ? ") points against its direction in State 1, so that its frame "
                                        "cannot follow it: use kinematics = \"edge-frames\""
                                      : ") has no length, and so no direction"));
  });
}

Status Nodes::sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept {
  return guard([&] {
    const double* points = q.data() + position_.coordinate;
    const std::vector<double> tangents = edge_tangents(mesh_, points);
    std::vector<double> frames;
    if (manifold_ == Manifold::rotation) {
      frames.resize(at(4 * mesh_.edges()));
      for (int i = 0; i < mesh_.edges(); ++i) {
        const double half = 0.5 * q[at(angle_.coordinate_of(i))];
        const lie::Rotation follows = lie::transport(reference_frames_[at(i)], Vector3::load(tangents.data() + 3 * i));
        (follows * lie::Rotation{std::cos(half), std::sin(half), 0.0, 0.0}).store(frames.data() + 4 * i);
      }
    } else {
      frames = frame_quaternions(manifold_, transported_orientations(manifold_, tangents, first_frame_.data()));
    }
    return sample_edges(mesh_, points, frames, edge_coordinate, out);
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
