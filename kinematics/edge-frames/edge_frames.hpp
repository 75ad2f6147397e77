#pragma once

#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/curve_kinematics/fields.hpp"
#include "core/curve_kinematics/orientation.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

/// Straight edges that carry an orientation each: an angle in the plane, in space a direction, or a rotation where an
/// energy asks for material frames. The strain of a station is the rotation between neighbouring orientations, and the
/// closure rows p_{i+1} − p_i = ℓ_i R_i e₁ tie them to the node positions (README.md beside this file).
class EdgeFrames final : public Kinematics {
 public:
  explicit EdgeFrames(const ParameterSet&) {}

  Status declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept override;
  Status evaluate(const SiteEvaluation& evaluation) const noexcept override;
  Status sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept override;
  /// Orientations as they are given; lengths of edges from the positions; held tangents where the start has them.
  Status adopt(const CurveShape& shape, Span<double> q) const noexcept override;
  /// EI ε π/h², h the shortest edge: an angle of up to π is rounded to ε π, and a moment EI ζ/h acts with arm h.
  double rounding_floor(double bending_stiffness) const noexcept override;

 private:
  void declare_fields(const Needs& needs, KinematicsDeclaration& out);
  void declare_sites(KinematicsDeclaration& out) const;
  FieldDeclaration orientation_field(const Needs& needs, const std::vector<double>& reference) const;
  FieldDeclaration edge_length_field() const;
  SiteDeclaration stations() const;
  SiteDeclaration frames() const;
  SiteDeclaration stretching_edges() const;
  SiteDeclaration closure() const;

  /// By the number of an orientation, the held tangents' included.
  int orientation_coordinate(int index) const noexcept;
  int orientation_unknown(int index) const noexcept;
  /// The unknown that an edge's length depends on: its own, or L; −1 on a curve of fixed length.
  int length_unknown(int edge) const noexcept;
  LinearInLength closure_length(int edge) const noexcept;

  template <Manifold manifold>
  void evaluate_stations(const SiteEvaluation& out) const noexcept;
  template <Manifold manifold>
  void evaluate_closure(const SiteEvaluation& out) const noexcept;
  void evaluate_frames(const SiteEvaluation& out) const noexcept;
  void evaluate_edges(const SiteEvaluation& out) const noexcept;

  CurveMesh mesh_;
  Manifold manifold_ = Manifold::circle;
  FieldSlot position_, orientation_, edge_length_, length_, held_tangent_;
  std::vector<int> closed_edges_;    // those with closure rows
  std::vector<double> first_frame_;  // coordinates of the first edge's orientation in State 1
  std::vector<double> held_start_;   // coordinates of the held tangents at the start
  double first_angle_ = 0.0;         // of the first edge at the start, in the plane

  // What was computed at a state and serves all of its evaluations: strains of the stations, and in the plane, where
  // they are not had without sine and cosine, axes of the closed edges.
  mutable std::uint64_t strain_state_ = 0, axes_state_ = 0;
  mutable std::vector<StationStrain<Manifold::direction>> turns_;
  mutable std::vector<StationStrain<Manifold::rotation>> rotations_;
  mutable std::vector<Matrix2> axes_;
};

}  // namespace bowstring
