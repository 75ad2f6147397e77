#include "kinematics/nodes/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/curve_kinematics/adopt.hpp"
#include "core/curve_kinematics/sample.hpp"
#include "core/curve_kinematics/sites.hpp"
#include "core/curve_kinematics/station_output.hpp"
#include "core/model/manifold.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

/// Adds g·∂²α of a side over a station's stencil, where e is the difference of two nodes.
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

/// B of a station between two edges: ∂ζ/∂α ∂α/∂(e, φ) of both, at the nodes.
template <Manifold manifold>
auto station_jacobian(const Side<manifold>& a, const Side<manifold>& b,
                      const StationStrain<manifold>& strain) noexcept {
  constexpr int m = Side<manifold>::m, width = station_width<manifold>;
  const auto by_a = strain.by_a * a.turn, by_b = strain.by_b * b.turn;
  Matrix<m, width> out;
  for (int i = 0; i < m; ++i) {
    const Vector<width> row = at_nodes<manifold>(by_a.row(i), by_b.row(i));
    for (int j = 0; j < width; ++j) out(i, j) = row[j];
  }
  return out;
}

/// stress·∂²ζ of a station between two edges, lower triangle: first in the edges' own unknowns, where matrices are
/// small.
template <Manifold manifold>
auto station_bend(const Side<manifold>& a, const Side<manifold>& b, const StationStrain<manifold>& strain,
                  const Vector<Side<manifold>::m>& stress) noexcept {
  constexpr int m = Side<manifold>::m, n = Side<manifold>::edge_numbers;
  Matrix<n, n> aa = edge_turn_curvature(a, strain.by_a.transpose() * stress);
  Matrix<n, n> bb = edge_turn_curvature(b, strain.by_b.transpose() * stress);
  Matrix<n, n> ba;
  if constexpr (manifold != Manifold::circle) {
    const Matrix<2 * m, 2 * m> h = station_curvature(strain, stress);
    const Matrix<n, m> a_turn = a.turn.transpose(), b_turn = b.turn.transpose();
    aa += a_turn * (h.template block<m, m>(0, 0) * a.turn);
    ba = b_turn * (h.template block<m, m>(m, 0) * a.turn);
    bb += b_turn * (h.template block<m, m>(m, m) * b.turn);
  }
  return at_nodes<manifold>(aa, ba, bb);
}

/// ∂(α, β)/∂δ of a station with a held tangent on one side.
template <Manifold manifold>
auto half_station_turns(const Side<manifold>& a, const Side<manifold>& b, const StationColumns& columns) noexcept {
  Matrix<2 * Side<manifold>::m, station_width<manifold>> out;
  set_side(a, 0, columns.earlier, out);
  set_side(b, Side<manifold>::m, columns.later, out);
  return out;
}

template <Manifold manifold>
auto half_station_jacobian(const Side<manifold>& a, const Side<manifold>& b, const StationStrain<manifold>& strain,
                           const StationColumns& columns) noexcept {
  constexpr int m = Side<manifold>::m;
  Matrix<m, 2 * m> by_turns;
  by_turns.set_block(0, 0, strain.by_a);
  by_turns.set_block(0, m, strain.by_b);
  return by_turns * half_station_turns(a, b, columns);
}

template <Manifold manifold>
auto half_station_curvature(const Side<manifold>& a, const Side<manifold>& b, const StationStrain<manifold>& strain,
                            const StationColumns& columns, const Vector<Side<manifold>::m>& stress) noexcept {
  constexpr int width = station_width<manifold>;
  Matrix<width, width> out;
  if constexpr (manifold != Manifold::circle) {
    const auto turns = half_station_turns(a, b, columns);
    out = turns.transpose() * (station_curvature(strain, stress) * turns);
  }
  add_turn_curvature(a, strain.by_a.transpose() * stress, columns.earlier, out);
  add_turn_curvature(b, strain.by_b.transpose() * stress, columns.later, out);
  return out;
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
    make_room();
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

void Nodes::make_room() {
  measure_state_ = side_state_ = 0;
  measures_.resize(at(mesh_.edges() * (mesh_.dimension() + 1)));
  const auto sides = at(mesh_.edges() + mesh_.held_tangents);
  const auto resize = [&](auto& found) {
    found.sides.resize(sides);
    found.strains.resize(mesh_.stations.size());
  };
  if (manifold_ == Manifold::circle) resize(std::get<Found<Manifold::circle>>(found_));
  if (manifold_ == Manifold::direction) resize(std::get<Found<Manifold::direction>>(found_));
  if (manifold_ == Manifold::rotation) resize(std::get<Found<Manifold::rotation>>(found_));
}

/// A row between two nodes that are wholly held would only freeze L, unless L has nothing else to follow.
bool Nodes::needs_spacing(int edge) const noexcept {
  if (mesh_.edge_held(edge)) return false;
  const bool held = position_held(mesh_.curve, edge) && position_held(mesh_.curve, edge + 1);
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
    FieldDeclaration angle = angle_field(needs);
    first_angle_ = angle.start.front();
    angle_ = add_field(std::move(angle), out);
  }
  if (mesh_.sliding()) length_ = add_field(length_field(mesh_), out);
  held_start_.clear();
  if (mesh_.held_tangents > 0) {
    FieldDeclaration held = held_tangent_field(mesh_, manifold_, reference);
    held_start_ = held.start;
    held_tangent_ = add_field(std::move(held), out);
  }
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

template <int d>
Status Nodes::find_measures(const SiteEvaluation& evaluation) const noexcept {
  if (evaluation.state != 0 && evaluation.state == measure_state_) return {};
  measure_state_ = 0;
  const double* p = evaluation.q.data() + position_.coordinate;
  double* out = measures_.data();
  for (int edge = 0; edge < mesh_.edges(); ++edge, p += d, out += d + 1) {
    const Vector<d> vector = Vector<d>::load(p + d) - Vector<d>::load(p);
    const double length = norm(vector);
    if (!(length > 0.0)) return no_orientation(edge, evaluation.q.data());
    (vector * (1.0 / length)).store(out);
    out[d] = length;
  }
  measure_state_ = evaluation.state;
  return {};
}

template <int d>
EdgeMeasure<d> Nodes::measure(int edge) const noexcept {
  const double* found = measures_.data() + edge * (d + 1);
  return {Vector<d>::load(found), found[d]};
}

template <Manifold manifold>
Status Nodes::find_sides(const SiteEvaluation& evaluation) const noexcept {
  if (evaluation.state != 0 && evaluation.state == side_state_) return {};
  constexpr int d = Side<manifold>::d;
  side_state_ = 0;
  if (Status status = find_measures<d>(evaluation); !status.ok()) return status;
  const double* q = evaluation.q.data();
  auto& found = std::get<Found<manifold>>(found_);
  for (int edge = 0; edge < mesh_.edges(); ++edge) {
    Side<manifold>& side = found.sides[at(edge)];
    const EdgeMeasure<d> measured = measure<d>(edge);
    side.tangent = measured.tangent;
    side.length = measured.length;
    EdgeReference reference;
    if (Side<manifold>::angles != 0) reference = {&reference_frames_[at(edge)], q[angle_.coordinate_of(edge)]};
    set_orientation(reference, side);
    if (!has_frame(reference, side)) return no_orientation(edge, q);
  }
  for (int k = 0; k < mesh_.held_tangents; ++k) {
    load_held(q + held_tangent_.coordinate_of(k), found.sides[at(mesh_.edges() + k)]);
  }
  for (std::size_t k = 0; k < mesh_.stations.size(); ++k) {
    const Station& station = mesh_.stations[k];
    found.strains[k] = strain_between(found.sides[at(station.earlier)], found.sides[at(station.later)]);
  }
  side_state_ = evaluation.state;
  return {};
}

/// ζ(α, β) of the two sides' orientations, with α(δ), β(δ) of their unknowns: B = ∂ζ/∂(α,β) A with A = ∂(α,β)/∂δ, and
/// Σ stress ∂²ζ/∂δ² = Aᵀ (Σ stress ∂²ζ/∂(α,β)²) A + Σ (stressᵀ∂ζ/∂(α,β)) ∂²(α,β)/∂δ².
template <Manifold manifold>
Status Nodes::evaluate_stations(const SiteEvaluation& evaluation) const noexcept {
  using EdgeSide = Side<manifold>;
  constexpr int m = EdgeSide::m, width = station_width<manifold>;
  if (Status status = find_sides<manifold>(evaluation); !status.ok()) return status;
  const double* q = evaluation.q.data();
  const StationOutput<m, width> out(mesh_, length_.exists() ? q[length_.coordinate] : 0.0, evaluation);
  const auto& found = std::get<Found<manifold>>(found_);
  for (std::size_t k = 0; k < mesh_.stations.size(); ++k) {
    const Station& station = mesh_.stations[k];
    const int index = static_cast<int>(k);
    const EdgeSide& earlier = found.sides[at(station.earlier)];
    const EdgeSide& later = found.sides[at(station.later)];
    const StationStrain<manifold>& strain = found.strains[k];
    if (out.wants_values()) out.write_values(index, station, strain.value);
    if (!earlier.is_edge() || !later.is_edge()) {
      const StationColumns columns = station_columns(station, mesh_.edges(), EdgeSide::d, m, EdgeSide::angles);
      if (out.wants_jacobian()) {
        out.write_jacobian(index, station, half_station_jacobian(earlier, later, strain, columns));
      }
      if (out.wants_curvature()) {
        out.write_curvature(index, half_station_curvature(earlier, later, strain, columns, out.stress(index)));
      }
      continue;
    }
    if (out.wants_jacobian()) out.write_jacobian(index, station, station_jacobian(earlier, later, strain));
    if (out.wants_curvature()) {
      out.write_curvature(index, station_bend(earlier, later, strain, out.stress(index)));
    }
  }
  return {};
}

/// y = |e| on a stretching curve, |e| − ℓ(L) on a wire: ∂|e| = t, ∂²|e| = (I − t tᵀ)/|e|, and ℓ is linear.
template <int d>
Status Nodes::evaluate_edge_lengths(const SiteEvaluation& out) const noexcept {
  const int varying = mesh_.sliding() ? 1 : 0;
  const int width = 2 * d + varying;
  if (Status status = find_measures<d>(out); !status.ok()) return status;
  const double length = mesh_.sliding() ? out.q[at(length_.coordinate)] : 0.0;
  for (int k = 0; k < static_cast<int>(measured_edges_.size()); ++k) {
    const int edge = measured_edges_[at(k)];
    const EdgeMeasure<d> measured = measure<d>(edge);
    const Vector<d>& t = measured.tangent;
    const LinearInLength share = mesh_.stretching() ? LinearInLength{} : mesh_.edge_length[at(edge)];
    if (!out.values.empty()) out.values[at(k)] = measured.length - share.at(length);
    if (!out.jacobian.empty()) {
      double* b = out.jacobian.data() + k * width;
      for (int i = 0; i < d; ++i) b[i] = -t[i], b[d + i] = t[i];
      if (varying != 0) b[2 * d] = -share.slope;
    }
    if (!out.curvature.empty()) {
      const double scale = out.stress[at(k)] / measured.length;
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
        const lie::Rotation follows = lie::transport(reference_frames_[at(i)], Vector3::load(tangents.data() + 3 * i));
        (follows * lie::about_first_axis(q[at(angle_.coordinate_of(i))])).store(frames.data() + 4 * i);
      }
    } else {
      frames = frame_quaternions(manifold_, transported_orientations(manifold_, tangents, first_frame_.data()));
    }
    return sample_edges(mesh_, points, frames, edge_coordinate, out);
  });
}

Status Nodes::adopt(const CurveShape& shape, Span<double> q) const noexcept {
  return guard([&]() -> Status {
    if (Status status = check_shape(mesh_, shape); !status.ok()) return status;
    adopt_positions(mesh_, shape, position_, length_, q);
    if (held_tangent_.exists()) std::copy(held_start_.begin(), held_start_.end(), q.data() + held_tangent_.coordinate);
    if (!angle_.exists()) return {};
    const std::vector<double> tangents = edge_tangents(mesh_, shape.position.data());
    double before = first_angle_;
    for (int i = 0; i < mesh_.edges(); ++i) {
      FrameSide side;
      side.tangent = Vector3::load(tangents.data() + 3 * i);
      const lie::Rotation& reference = reference_frames_[at(i)];
      if (!has_frame({&reference, 0.0}, side)) return no_orientation(i, q.data());
      const lie::Rotation given = lie::transport(lie::Rotation::load(shape.orientation.data() + 4 * i), side.tangent);
      double angle = lie::log(lie::transport(reference, side.tangent).inverse() * given)[0];
      angle -= 2.0 * M_PI * std::round((angle - before) / (2.0 * M_PI));
      q[at(angle_.coordinate_of(i))] = before = angle;
    }
    return {};
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
