#include "core/contact/binding.hpp"

#include <algorithm>

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

}  // namespace bowstring::contact
