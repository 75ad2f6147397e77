#include "writers/vtp/sweep.hpp"

#include <cmath>

#include "core/lie/s2.hpp"

namespace bowstring {

namespace {

constexpr double full_turn = 2.0 * 3.14159265358979323846;

void add_ring(const ModelPoint& node, const lie::Rotation& frame, int sides, std::vector<ModelPoint>& points) {
  for (int k = 0; k < sides; ++k) {
    const double angle = full_turn * k / sides;
    ModelPoint point = node;
    point.normal = frame * Vector3{{0.0, std::cos(angle), std::sin(angle)}};
    point.position = node.position + node.radius * point.normal;
    points.push_back(point);
  }
}

/// The triangles between the ring that starts at point `ring` and the next.
void add_band(std::int64_t ring, int sides, std::int32_t part, ModelCells& triangles) {
  for (int k = 0; k < sides; ++k) {
    const std::int64_t here = ring + k, beside = ring + (k + 1) % sides;
    triangles.add({here, beside, beside + sides}, part);
    triangles.add({here, beside + sides, here + sides}, part);
  }
}

/// Normals of the points from `first_point` on: the mean, by area, of those of the triangles around. A point where that
/// is none, because the rings beside it coincide, keeps the direction away from the centerline.
void set_normals(Model& model, std::size_t first_point, std::size_t first_corner) {
  std::vector<Vector3> sum(model.points.size() - first_point);
  const std::vector<std::int64_t>& corners = model.triangles.connectivity;
  for (std::size_t c = first_corner; c < corners.size(); c += 3) {
    const std::size_t index[] = {static_cast<std::size_t>(corners[c]), static_cast<std::size_t>(corners[c + 1]),
                                 static_cast<std::size_t>(corners[c + 2])};
    const Vector3& corner = model.points[index[0]].position;
    const Vector3 area = cross(model.points[index[1]].position - corner, model.points[index[2]].position - corner);
    for (const std::size_t i : index) sum[i - first_point] += area;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (norm(sum[i]) > 0.0) model.points[first_point + i].normal = normalized(sum[i]);
  }
}

}  // namespace

void add_tube(const std::vector<ModelPoint>& centerline, int sides, const ModelPart& part, Model& model) {
  const auto number = static_cast<std::int32_t>(model.parts.size());
  model.parts.push_back(part);
  const std::size_t first_point = model.points.size(), first_corner = model.triangles.connectivity.size();
  lie::Rotation frame = lie::Rotation::identity();
  for (std::size_t i = 0; i < centerline.size(); ++i) {
    frame = lie::transport(frame, centerline[i].frame.first_axis());
    if (i + 1 < centerline.size()) {
      add_band(static_cast<std::int64_t>(model.points.size()), sides, number, model.triangles);
    }
    add_ring(centerline[i], frame, sides, model.points);
  }
  set_normals(model, first_point, first_corner);
}

}  // namespace bowstring
