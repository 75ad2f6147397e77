#pragma once

#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/interfaces/kinematics.hpp"

namespace bowstring {

/// Quaternions of frames whose coordinates are of the given manifold; in the plane rotations about the third axis.
std::vector<double> frame_quaternions(Manifold manifold, const std::vector<double>& orientation);

/// Material points of straight edges between `points` (nodes × dimension), each with its edge's frame out of `frames`
/// (edges × 4). A node belongs to the edge that begins there. `invalid_input` for a coordinate beyond the curve.
Status sample_edges(const CurveMesh& mesh, const double* points, const std::vector<double>& frames,
                    Span<const double> edge_coordinate, CurveSample& out);

}  // namespace bowstring
