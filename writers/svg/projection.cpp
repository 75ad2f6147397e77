#include "writers/svg/projection.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace bowstring {

namespace {

std::vector<Vector3> reference_points(const Result& result, bool with_wires) {
  std::vector<Vector3> out;
  for (const ResultCurve& curve : result.curves) {
    if (curve.wire && !with_wires) continue;
    for (const Vector3& point : curve.reference) {
      if (is_finite(point)) out.push_back(point);
    }
  }
  return out;
}

/// Directions of largest to least variance, as columns.
Eigen::Matrix3d principal_axes(const std::vector<Vector3>& points) {
  Eigen::Matrix3Xd cloud(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.col(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
  }
  cloud.colwise() -= cloud.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cloud * cloud.transpose());
  return solver.eigenvectors().rowwise().reverse();
}

Vector3 oriented(const Eigen::Vector3d& axis, double sense) {
  return Vector3{{axis.x(), axis.y(), axis.z()}} * (sense < 0.0 ? -1.0 : 1.0);
}

double largest_component(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest];
}

/// Axis 1 along the chord from the first to the last of the points, axis 2 along its largest component.
View principal_view(const std::vector<Vector3>& points) {
  const Eigen::Matrix3d axes = principal_axes(points);
  const Vector3 chord = points.back() - points.front();
  return {oriented(axes.col(0), dot(chord, oriented(axes.col(0), 1.0))),
          oriented(axes.col(1), largest_component(axes.col(1))), "principal axes 1, 2"};
}

bool lie_in_one_height(const std::vector<Vector3>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vector3& point) { return point[2] == points.front()[2]; });
}

}  // namespace

View widest_view(const std::vector<Vector3>& points) {
  return lie_in_one_height(points) ? View{Vector3::unit(0), Vector3::unit(1), ""} : principal_view(points);
}

std::vector<View> choose_views(const Result& result) {
  const View plane{Vector3::unit(0), Vector3::unit(1), ""};
  if (result.dimension == 2) return {plane};
  std::vector<Vector3> points = reference_points(result, false);
  if (points.empty()) points = reference_points(result, true);
  if (points.empty()) return {plane};
  const View widest = principal_view(points);
  return {widest, {widest.right, cross(widest.right, widest.up), "principal axes 1, 3"}};
}

Vector2 project(const View& view, const Vector3& point) { return {{dot(view.right, point), dot(view.up, point)}}; }

bool is_finite(const Vector3& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

}  // namespace bowstring
