#include "core/model/unheld_load.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring {

namespace {

bool end_holds(const Curve& curve, int axis) {
  return curve.view.end[0].position_held[axis] || curve.view.end[1].position_held[axis];
}

bool rows_hold(const Scene& scene, const Curve& curve) {
  return std::any_of(scene.constraints.begin(), scene.constraints.end(), [&](const ConstraintUse& use) {
    return std::any_of(use.rows.places.begin(), use.rows.places.end(),
                       [&](const Place& place) { return place.curve == curve.view.index; });
  });
}

/// Adds the forces of a linear law of node positions.
void add_force(const Curve& curve, const LawUse& law, double (&force)[3]) {
  const auto n = static_cast<std::size_t>(curve.view.dimension);
  const SiteDeclaration& nodes = *curve.site(Site::node);
  std::vector<int> places = law.description.places;
  for (int i = 0; places.empty() && i < nodes.count; ++i) places.push_back(i);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto node = static_cast<std::size_t>(places[k]);
    std::vector<const double*> parameter;
    for (const std::vector<double>& sampled : law.parameters) parameter.push_back(sampled.data() + k);
    double stress[3] = {};
    LawBatch batch;
    batch.count = 1;
    batch.dimension = curve.view.dimension;
    batch.x = batch.reference = curve.reference.data() + node * n;
    batch.parameter = parameter.data();
    batch.stress = stress;
    if (!law.law->evaluate(batch).ok()) continue;
    double weight = law.description.weight.empty() ? 1.0 : law.description.weight[k];
    if (law.description.weighing == Weighing::per_length) weight *= nodes.ds[node];
    for (std::size_t a = 0; a < n; ++a) force[a] -= weight * stress[a];
  }
}

}  // namespace

std::optional<UnheldLoad> unheld_load(const Scene& scene, const Curve& curve) {
  if (curve.view.rigid || rows_hold(scene, curve) || curve.site(Site::node) == nullptr) return std::nullopt;
  UnheldLoad out;
  for (std::size_t e = 0; e < scene.energies.size(); ++e) {
    const EnergyUse& use = scene.energies[e];
    if (use.curve != curve.view.index) continue;
    for (const LawUse& law : use.laws) {
      if (law.description.site != Site::node) continue;
      if (!law.description.linear) return std::nullopt;
      out.energy = static_cast<int>(e);
      add_force(curve, law, out.force);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (end_holds(curve, axis)) out.force[axis] = 0.0;
  }
  if (out.energy < 0 || std::hypot(out.force[0], out.force[1], out.force[2]) == 0.0) return std::nullopt;
  return out;
}

}  // namespace bowstring
