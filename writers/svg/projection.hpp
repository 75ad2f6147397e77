#pragma once

#include <string>
#include <vector>

#include "core/lie/small_matrix.hpp"
#include "writers/reading/result.hpp"

namespace bowstring {

/// An orthogonal projection onto the plane of two orthonormal directions.
struct View {
  Vector3 right, up;
  std::string name;  ///< empty for the only view of a plane
};

/// In the plane its x and y; in space the views onto the first and second, and the first and third principal axes
/// of the State 1 vessel points (of all points where there is no vessel). Axis 1 points from the first to the last
/// of these points, axis 2 along its largest component.
std::vector<View> choose_views(const Result& result);

/// The view onto the two principal axes of points in space along which they spread most; x and y where they all lie in
/// one plane of these.
View widest_view(const std::vector<Vector3>& points);

Vector2 project(const View& view, const Vector3& point);

bool is_finite(const Vector3& point);

}  // namespace bowstring
