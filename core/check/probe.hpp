#pragma once

#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring::checking {

/// Everything that is differenced, at q·Exp δ. Gradients are those of the function δ ↦ f(q·Exp δ) of Rⁿ, so that its
/// derivative at δ = 0 is the Taylor Hessian.
struct Probe {
  Status energy_status, row_status;
  std::vector<std::vector<double>> energy;              ///< per term, one number, N mm
  std::vector<std::vector<double>> gradient;            ///< per term, n
  std::vector<std::vector<double>> rows;                ///< per group of rows
  std::vector<std::vector<double>> pull;                ///< per group of rows, n: Jᵀλ
  std::vector<double> lagrangian, lagrangian_gradient;  ///< 1 and n: of energy_factor·E + λᵀr

  bool ok() const noexcept { return energy_status.ok() && row_status.ok(); }
};

/// An arbitrary factor of the energies in the Lagrangian, so that a missing one is seen.
inline constexpr double energy_factor = 0.7;

/// `multipliers`: m.
Probe probe(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta,
            const std::vector<double>& multipliers);

/// Energies of the terms alone.
Status probe_energies(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta,
                      std::vector<double>& out);

}  // namespace bowstring::checking
