#pragma once

#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/interfaces/kinematics.hpp"

namespace bowstring {

/// Where a field's numbers stand among the curve's coordinates and among its unknowns.
struct FieldSlot {
  int coordinate = -1, unknown = -1;            ///< of the first entry; −1: the field does not exist
  int coordinates_each = 0, unknowns_each = 0;  ///< numbers per entry

  bool exists() const noexcept { return coordinate >= 0; }
  int coordinate_of(int entry) const noexcept { return coordinate + entry * coordinates_each; }
  int unknown_of(int entry) const noexcept { return unknown + entry * unknowns_each; }
};

/// Appends the field to the declaration.
FieldSlot add_field(FieldDeclaration field, KinematicsDeclaration& out);

/// "position": one vector per node; what the ends hold is fixed.
FieldDeclaration position_field(const CurveMesh& mesh);

/// "length": L of a sliding wire without its held edges, mm. It stays above half the distance of the ends.
FieldDeclaration length_field(const CurveMesh& mesh);

/// "held-tangent": the orientations that clamped ends hold, all fixed. `orientation` holds the edges' coordinates in
/// State 1. In the plane the angle is the one nearest to the end edge's; in space the end edge's frame is carried over
/// by parallel transport, so that State 1 has no twist there.
FieldDeclaration held_tangent_field(const CurveMesh& mesh, Manifold manifold, const std::vector<double>& orientation);

/// Unit tangents of the edges between `points` (nodes × dimension); not numbers for an edge of length zero.
std::vector<double> edge_tangents(const CurveMesh& mesh, const double* points);

/// Coordinates of orientations with these first axes: angles without jumps in the plane, Bishop frames in space
/// (Bishop 1975). The first follows `first` (one orientation's coordinates) by the nearest angle or by parallel
/// transport; where that is null it is any.
std::vector<double> transported_orientations(Manifold manifold, const std::vector<double>& tangents,
                                             const double* first);

/// Orientations of the edges at the start: in the plane the angles next to State 1's (`reference`) after each edge's
/// prescribed turn, in space the Bishop frames of the start, from State 1's first one, with each edge's twist.
std::vector<double> start_orientations(const CurveMesh& mesh, Manifold manifold, const std::vector<double>& reference);

/// `invalid_input` naming the first edge of length zero, in State 1 or at the start; `unsupported` where an energy
/// needs the length of every edge and they have none of their own.
Status check_curve(const CurveMesh& mesh, const Needs& needs);

}  // namespace bowstring
