#pragma once

#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/curve_kinematics/fields.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

/// Node positions alone: the orientation of an edge is that of p_{i+1} − p_i, so that there is no twist, and the strain
/// of a station is the turn between neighbouring edges. A wire has rows |p_{i+1} − p_i| = ℓ_i (README.md beside this
/// file).
class Nodes final : public Kinematics {
 public:
  explicit Nodes(const ParameterSet&) {}

  /// Refuses material frames.
  Status declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept override;
  /// `failed` naming the edge where one has length zero, and so no direction.
  Status evaluate(const SiteEvaluation& evaluation) const noexcept override;
  Status sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept override;
  /// EI ε |p|/h³, |p| the largest distance from the origin and h the shortest edge: a position is rounded to ε |p|,
  /// which turns an edge by ε |p|/h, and a moment EI ζ/h acts with arm h.
  double rounding_floor(double bending_stiffness) const noexcept override;

 private:
  void declare_fields(KinematicsDeclaration& out);
  void declare_sites(KinematicsDeclaration& out) const;
  SiteDeclaration stations() const;
  SiteDeclaration edge_lengths() const;
  bool needs_spacing(int edge) const noexcept;
  Manifold manifold() const noexcept;

  template <int d>
  Status evaluate_stations(const SiteEvaluation& evaluation) const noexcept;
  template <int d>
  Status evaluate_edge_lengths(const SiteEvaluation& out) const noexcept;
  Status no_direction(int edge) const noexcept;

  CurveMesh mesh_;
  FieldSlot position_, length_, held_tangent_;
  /// Edges whose length is a place: on a stretching curve all, at site `edge`; on a wire those with a spacing row, at
  /// site `closure`.
  std::vector<int> measured_edges_;
  std::vector<double> first_frame_;  // coordinates of the first edge's orientation in State 1
};

}  // namespace bowstring
