#include "core/curve_kinematics/sample.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bowstring {

std::vector<double> frame_quaternions(Manifold manifold, const std::vector<double>& orientation) {
  if (manifold != Manifold::circle) return orientation;
  std::vector<double> out;
  out.reserve(4 * orientation.size());
  for (const double angle : orientation) {
    const double half = 0.5 * angle;
    out.insert(out.end(), {std::cos(half), 0.0, 0.0, std::sin(half)});
  }
  return out;
}

Status sample_edges(const CurveMesh& mesh, const double* points, const std::vector<double>& frames,
                    Span<const double> edge_coordinate, CurveSample& out) {
  constexpr double slack = 1e-9;  // of an edge: what rounding may put beyond the last node
  const int d = mesh.dimension();
  out.position.clear();
  out.orientation.clear();
  for (const double t : edge_coordinate) {
    if (!(t >= -slack && t <= mesh.edges() + slack)) {
      return Status::failure(Code::invalid_input, "edge coordinate " + std::to_string(t) + " is not on '" +
                                                      mesh.curve.name + "', which goes from 0 to " +
                                                      std::to_string(mesh.edges()));
    }
    const int edge = std::clamp(static_cast<int>(std::floor(t)), 0, mesh.edges() - 1);
    const double fraction = std::clamp(t - edge, 0.0, 1.0);
    for (int k = 0; k < d; ++k) {
      const double a = points[edge * d + k], b = points[(edge + 1) * d + k];
      out.position.push_back((1.0 - fraction) * a + fraction * b);
    }
    const double* frame = frames.data() + 4 * edge;
    out.orientation.insert(out.orientation.end(), frame, frame + 4);
  }
  return {};
}

}  // namespace bowstring
