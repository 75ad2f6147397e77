#pragma once

#include <vector>

#include "core/lie/small_matrix.hpp"

namespace bowstring {

using Polyline = std::vector<Vector2>;

/// The projection of a tube: the plane figure swept by a disc of variable radius along a curve, with open ends.
struct Tube {
  Polyline points;
  std::vector<double> radius;  ///< one per point
};

/// The same tube with smooth bends: a Catmull-Rom curve through its points, subdivided where it turns, and without
/// the points that coincide in the projection.
Tube refine(const Tube& tube);

/// Polygons of one orientation whose union is the area of the tube.
std::vector<Polyline> tube_area(const Tube& tube);

/// The visible outline on both sides, which is the envelope of the discs. What lies inside another part of the tube, as
/// on the inner side of a bend sharper than the radius, is cut off.
std::vector<Polyline> tube_outline(const Tube& tube);

}  // namespace bowstring
