#include "core/contact/binding.hpp"

#include <algorithm>

#include "core/contact/crossing.hpp"
#include "core/contact/gap.hpp"

namespace bowstring::contact {

namespace {

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
  const auto nodes = static_cast<std::size_t>(wire.nodes), dimension = static_cast<std::size_t>(vessel.dimension);
  const bool from_last = position_held(wire, wire.nodes - 1) && !position_held(wire, 0);
  std::vector<double> x(points, points + nodes * dimension), r;
  if (radius != nullptr) r.assign(radius, radius + nodes);
  if (from_last) {
    for (std::size_t i = 0; i < nodes; ++i) {
      std::copy_n(points + (nodes - 1 - i) * dimension, dimension, x.begin() + static_cast<long>(i * dimension));
    }
    std::reverse(r.begin(), r.end());
  }
  std::vector<double> sigma(nodes);
  const WirePolyline polyline{wire.nodes, x.data(), r.empty() ? nullptr : r.data()};
  follow_nodes(vessel, polyline, from_last ? first.back() : first.front(), sigma.data());
  if (from_last) std::reverse(sigma.begin(), sigma.end());
  return sigma;
}

}  // namespace bowstring::contact
