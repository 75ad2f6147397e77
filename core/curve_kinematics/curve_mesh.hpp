#pragma once

#include <vector>

#include "core/interfaces/curve.hpp"

namespace bowstring {

/// constant + slope · L, with L the unknown length of a sliding wire: how lengths of material depend on unknowns.
struct LinearInLength {
  double constant = 0.0, slope = 0.0;

  constexpr double at(double length) const noexcept { return constant + slope * length; }
};

constexpr LinearInLength operator+(LinearInLength a, LinearInLength b) noexcept {
  return {a.constant + b.constant, a.slope + b.slope};
}
constexpr LinearInLength operator*(double factor, LinearInLength a) noexcept {
  return {factor * a.constant, factor * a.slope};
}

/// The rotation from one orientation to the next one along the curve. Orientations are numbered: the edges
/// 0 … n − 2, then the held tangents, the first end's before the last end's.
struct Station {
  int earlier = 0, later = 0;
  LinearInLength ds;   ///< length of material that the rotation is spread over
  LinearInLength arc;  ///< arc coordinate: of the node, or of the middle of a half station's material
};

/// What every kinematics of straight edges needs to know of a curve: its lengths as functions of L, what its ends
/// hold, and its stations. `curve` points into the scene.
struct CurveMesh {
  CurveView curve;
  std::vector<LinearInLength> edge_length;  ///< edges
  std::vector<LinearInLength> node_arc;     ///< nodes
  /// A half station at the first end where its tangent is held, one per interior node, one at the last end.
  std::vector<Station> stations;
  int held_tangent[2] = {-1, -1};  ///< per end: which held tangent, −1 where there is none
  int held_tangents = 0;

  int dimension() const noexcept { return curve.dimension; }
  int nodes() const noexcept { return curve.nodes; }
  int edges() const noexcept { return curve.nodes - 1; }
  bool sliding() const noexcept { return curve.extension == Extension::sliding; }
  bool stretching() const noexcept { return curve.extension == Extension::stretching; }

  /// Both of the edge's nodes, its orientation and its length are held.
  bool edge_held(int edge) const noexcept;
  /// L at the start; 0 where no length depends on it.
  double start_length() const noexcept { return sliding() ? curve.start_length : 0.0; }
  double edge_middle(int edge) const noexcept;  ///< arc coordinate at the start, mm
};

/// A rigid curve has everything held and no held tangents.
CurveMesh make_curve_mesh(const CurveView& curve);

}  // namespace bowstring
