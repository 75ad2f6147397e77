#include "core/contact/binding.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/gap.hpp"

namespace bowstring::contact {

namespace {

constexpr double slide_limit = 10.0;  // how far σ may move per edge of the wire, as lengths

void along_equal_arc(const ConstraintScene& scene, std::vector<double>& sigma) {
  const CurveView& wire = scene.on[0];
  const CurveView& vessel = scene.on[1];
  const double scale = (scene.end_arc - scene.start_arc) / wire.arc[wire.nodes - 1];
  int segment = 0;
  for (int i = 0; i < wire.nodes; ++i) {
    const double arc = scene.start_arc + scale * wire.arc[i];
    while (segment < vessel.nodes - 2 && vessel.arc[segment + 1] < arc) ++segment;
    const double length = vessel.arc[segment + 1] - vessel.arc[segment];
    sigma[static_cast<std::size_t>(i)] = segment + std::clamp((arc - vessel.arc[segment]) / length, 0.0, 1.0);
  }
}

}  // namespace

std::vector<double> first_places(const ConstraintScene& scene, const Centerline& centerline) {
  const CurveView& wire = scene.on[0];
  std::vector<double> sigma(static_cast<std::size_t>(wire.nodes));
  if (scene.starts_along) {
    along_equal_arc(scene, sigma);
  } else {
    bind_along(centerline, wire.start, wire.nodes, sigma.data());
  }
  return sigma;
}

std::vector<double> places_at(const CurveView& wire, const Centerline& vessel, const double* points,
                              const double* radius, const std::vector<double>& first) {
  Centerline spline = vessel;
  spline.interpolation = Interpolation::spline;
  const int dimension = vessel.dimension, last = wire.nodes - 1;
  const bool from_last = position_held(wire, last) && !position_held(wire, 0);
  const double along = (first.back() < first.front()) == from_last ? 1.0 : -1.0;
  std::vector<double> sigma(first.size());
  double start = from_last ? first.back() : first.front();
  Window window = whole(spline);
  for (int k = 0; k <= last; ++k) {
    const int node = from_last ? last - k : k;
    const double* x = points + node * dimension;
    if (k > 0) {
      const double* before = from_last ? x + dimension : x - dimension;
      const CurvePoint q = evaluate(spline, coordinate(start, spline.nodes));
      const double speed = std::max(std::hypot(q.slope[0], q.slope[1], q.slope[2]), 1e-300);
      const double chord = std::hypot(x[0] - before[0], x[1] - before[1], dimension == 3 ? x[2] - before[2] : 0.0);
      window = {start - slide_limit * chord / speed, start + slide_limit * chord / speed};
      start += along * chord / speed;
    }
    start = closest(spline, x, {GapForm::squared, radius == nullptr ? 0.0 : radius[node]}, window, start).at.sigma();
    sigma[static_cast<std::size_t>(node)] = start;
  }
  return sigma;
}

}  // namespace bowstring::contact
