#pragma once

#include <tuple>
#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/curve_kinematics/fields.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/interfaces/parameter.hpp"
#include "kinematics/nodes/side.hpp"

namespace bowstring {

/// Node positions: the orientation of an edge is that of p_{i+1} − p_i, and the strain of a station is the turn between
/// neighbouring edges. Where a term needs material frames, one angle per edge turns the edge's frame of State 1,
/// carried to its present direction by the least turn. A wire has rows |p_{i+1} − p_i| = ℓ_i. README.md has the
/// formulas.
class Nodes final : public Kinematics {
 public:
  explicit Nodes(const ParameterSet&) {}

  /// `unsupported` in the plane where the start does not wind as often as two held ends are turned.
  Status declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept override;
  /// `failed` naming the edge where one has length zero, and so no direction, or has turned by half a turn against
  /// State 1, so that its frame cannot follow.
  Status evaluate(const SiteEvaluation& evaluation) const noexcept override;
  Status sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept override;
  /// Positions as they are given; angles, without jumps along the curve, from how the orientations are turned about
  /// their edges. `failed` where an edge has turned by half a turn against State 1.
  Status adopt(const CurveShape& shape, Span<double> q) const noexcept override;
  /// EI ε |p|/h³, |p| the largest distance from the origin and h the shortest edge: a position is rounded to ε |p|,
  /// which turns an edge by ε |p|/h, and a moment EI ζ/h acts with arm h.
  double rounding_floor(double bending_stiffness) const noexcept override;

 private:
  void declare_fields(const Needs& needs, KinematicsDeclaration& out);
  Status check_winding(const KinematicsDeclaration& declared) const;
  FieldDeclaration angle_field(const Needs& needs) const;
  void declare_sites(KinematicsDeclaration& out) const;
  SiteDeclaration stations() const;
  SiteDeclaration edge_lengths() const;
  bool needs_spacing(int edge) const noexcept;

  void make_room();

  // What all sites compute first. `failed` naming an edge without a direction or a frame.
  template <int d>
  Status find_measures(const SiteEvaluation& evaluation) const noexcept;
  template <Manifold manifold>
  Status find_sides(const SiteEvaluation& evaluation) const noexcept;
  template <int d>
  EdgeMeasure<d> measure(int edge) const noexcept;

  template <Manifold manifold>
  Status evaluate_stations(const SiteEvaluation& evaluation) const noexcept;
  template <int d>
  Status evaluate_edge_lengths(const SiteEvaluation& out) const noexcept;
  Status no_orientation(int edge, const double* q) const noexcept;

  CurveMesh mesh_;
  Manifold manifold_ = Manifold::direction;  ///< of an edge's orientation
  FieldSlot position_, angle_, length_, held_tangent_;
  std::vector<lie::Rotation> reference_frames_;  ///< of the edges in State 1; with material frames only
  /// Edges whose length is a place: on a stretching curve all, at site `edge`; on a wire those with a spacing row, at
  /// site `closure`.
  std::vector<int> measured_edges_;
  std::vector<double> first_frame_;  // coordinates of the first edge's orientation in State 1
  std::vector<double> held_start_;   // coordinates of the held tangents at the start
  double first_angle_ = 0.0;         // of the first edge at the start

  // What was computed at a state and serves all of its evaluations: tangent and length of each edge; the sides of the
  // stations, those of held tangents last, and their strains.
  template <Manifold manifold>
  struct Found {
    std::vector<Side<manifold>> sides;
    std::vector<StationStrain<manifold>> strains;
  };
  mutable std::uint64_t measure_state_ = 0, side_state_ = 0;
  mutable std::vector<double> measures_;
  mutable std::tuple<Found<Manifold::circle>, Found<Manifold::direction>, Found<Manifold::rotation>> found_;
};

}  // namespace bowstring
