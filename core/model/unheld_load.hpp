#pragma once

#include <optional>

#include "core/model/scene.hpp"

namespace bowstring {

/// A dead load that nothing resists.
struct UnheldLoad {
  int energy = -1;                    ///< of the scene's: one that pulls
  double force[3] = {0.0, 0.0, 0.0};  ///< N, of all on that curve, along the axes that no end holds
};

/// The net dead force on a curve along an axis that nothing holds it in: no end, no row, and no energy of positions but
/// the linear ones. With it the energy falls without end along a translation, and there is no minimum. Empty where
/// something holds the curve, or the forces cancel.
std::optional<UnheldLoad> unheld_load(const Scene& scene, const Curve& curve);

}  // namespace bowstring
