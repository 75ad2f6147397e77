#pragma once

#include <vector>

#include "core/interfaces/measure.hpp"
#include "core/interfaces/status.hpp"
#include "core/measure/curve_sampling.hpp"

namespace bowstring {

/// A curve in space, as its nodes give it.
struct NodalCurve {
  std::vector<double> points;  ///< nodes × 3, mm, in the order of the curve
  std::vector<double> radius;  ///< one per node, mm; empty: not known

  std::size_t nodes() const noexcept { return points.size() / 3; }
};

/// Nodes of `dimension` 2 or 3, lifted into space with z = 0.
NodalCurve nodal_curve(const std::vector<double>& points, int dimension, std::vector<double> radius = {});

struct CurveMeasure {
  Measure measure;          ///< with frames; its weights sum to 1
  std::vector<double> arc;  ///< of each place, from the first end, mm
};

/// The measure of a curve. Its places are the nodes, or, resampled, the midpoints of equal arc lengths along the
/// polyline, where position, direction and radius are interpolated linearly.
///
/// A node's tangent is the mean of its edges' unit tangents; the first frame is the least turn of the global axes to
/// the first tangent, and every other that of the place before, carried on by parallel transport (Bishop frames, which
/// have no roll of their own where Frenet's jump at inflections): like curves carry like rolls.
///
/// A node stands for half of each of its edges, a resampled place for its share of the length; `uniform` weights count
/// places alone.
///
/// `invalid_input` with the reason: fewer than two nodes, a node that is not finite, no length, or `lumen_section`
/// without radii above 0 everywhere.
Status measure_of_curve(const NodalCurve& curve, const CurveSampling& sampling, CurveMeasure& out);

/// Orientations of the nodes alone, as above: nodes × 4 quaternions. The curve has a length.
std::vector<double> node_frames(const NodalCurve& curve);

}  // namespace bowstring
