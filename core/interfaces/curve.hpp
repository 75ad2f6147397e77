#pragma once

#include "core/interfaces/span.hpp"

namespace bowstring {

enum class CurveKind : int { wire, vessel };

/// How the length of a curve may change. `sliding`: one unknown L, edge lengths f_i L (a wire that runs through
/// its sheath). `fixed`: every edge keeps its length. `stretching`: every edge has its own length (a vessel).
enum class Extension : int { sliding, fixed, stretching };

/// One end of a curve. Axes are global.
struct EndCondition {
  bool position_held[3] = {false, false, false};
  bool rotation_held = false;           ///< the tangent, with material frames the whole frame, is held at the node
  bool edge_held = false;               ///< both nodes of the end edge are held, and its length does not count in L
  double tangent[3] = {0.0, 0.0, 0.0};  ///< unit, along the curve; the direction that is held in State 1
  /// Prescribed rotation of the held direction from State 1, rad, whole turns counted: a rotation vector in global axes
  /// (in the plane its third component), after a twist about the tangent.
  double turn[3] = {0.0, 0.0, 0.0};
  double twist = 0.0;
};

/// What plugins see of one curve. Pointers stay valid as long as the scene.
struct CurveView {
  int index = 0;
  const char* name = "";
  CurveKind kind = CurveKind::vessel;
  int dimension = 3;
  int nodes = 0;
  Extension extension = Extension::stretching;
  bool rigid = false;                 ///< no unknowns
  const double* reference = nullptr;  ///< State 1 node positions, nodes × dimension, mm
  const double* start = nullptr;      ///< node positions that a solver starts from, nodes × dimension, mm
  /// nodes − 1: what an edge is turned from State 1 at the start, rad, whole turns counted: its angle in the plane, its
  /// twist about itself, beyond parallel transport, in space.
  const double* start_turn = nullptr;
  const double* edge_length = nullptr;  ///< nodes − 1: edge lengths at State 1 (vessel) or at the start (wire), mm
  const double* fraction = nullptr;     ///< nodes − 1: f_i of a sliding wire, summing to 1; 0 on a held edge
  const double* arc = nullptr;          ///< nodes: arc coordinate, mm
  /// Node positions at the end of the step before, nodes × dimension, mm; null in the first step, and where the curve
  /// was not there. For terms that remember where they came from.
  const double* previous = nullptr;
  double start_length = 0.0;  ///< L at the start without held edges, mm
  double held_length = 0.0;   ///< sum of the held edges' lengths, mm
  double end_distance = 0.0;  ///< of the two end nodes in State 1 with their prescribed moves, mm
  EndCondition end[2];        ///< first end, last end
};

/// Whether an end holds this coordinate of a node. A held edge holds both of its nodes.
inline bool position_held(const CurveView& curve, int node, int axis) noexcept {
  const int last = curve.nodes - 1;
  return curve.rigid || (node == 0 && curve.end[0].position_held[axis]) ||
         (node == last && curve.end[1].position_held[axis]) || (node <= 1 && curve.end[0].edge_held) ||
         (node >= last - 1 && curve.end[1].edge_held);
}
/// Wholly held: no row on that node could do anything.
inline bool position_held(const CurveView& curve, int node) noexcept {
  for (int axis = 0; axis < curve.dimension; ++axis) {
    if (!position_held(curve, node, axis)) return false;
  }
  return true;
}

}  // namespace bowstring
