#pragma once

#include <string>
#include <vector>

#include "core/interfaces/curve.hpp"
#include "core/interfaces/law.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

/// What a composed energy asks of its curve's kinematics. Fields exist because some term needs them.
struct Needs {
  bool material_frames = false;  ///< three-component strain in space (torsion, anisotropy, preshape)
  bool stretch = false;          ///< the length of every edge
  std::string reason;            ///< for `explain` and refusals: "vessel-strain: torsional-stiffness > 0"
};

struct EnergyDeclaration {
  std::vector<const Law*> laws;              ///< owned by the energy, alive as long as it
  std::vector<LawDescription> descriptions;  ///< one per law
  Needs needs;
  std::vector<std::string> warnings;  ///< what the user should know of this formulation in this scene
  std::vector<IdleParameter> without_effect;
};

/// kind `energy`: one J term on one curve, as laws at places.
class Energy {
 public:
  virtual ~Energy() = default;
  /// Called once per scene, before any evaluation. `unsupported` with a reason refuses the curve.
  virtual Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept = 0;
};

}  // namespace bowstring
