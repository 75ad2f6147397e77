#pragma once

#include <string>
#include <vector>

#include "core/check/check.hpp"
#include "core/check/motion.hpp"

namespace bowstring::checking {

/// Motions that neither ends, nor equality rows, nor energies resist, as rates of all tangent numbers, and the lines
/// that name them.
struct RigidModes {
  std::vector<std::vector<double>> rates;
  std::vector<CheckLine> lines;
};

/// Of each curve, or of the curves that equality rows tie together: rigid motions, and turns of material frames about
/// their tangents. Held numbers and rows are looked at to first order; energies along the exact motion, there and back,
/// so that it does not matter whether `q` is an equilibrium.
RigidModes find_rigid_modes(Assembly& assembly, const std::vector<double>& q);

}  // namespace bowstring::checking
