#pragma once

#include "core/interfaces/transport.hpp"

namespace bowstring::unbalanced {

/// min over γ ≥ 0 of ⟨C, γ⟩ + ε KL(γ, a bᵀ) + ρ KL(γ 1, a) + ρ KL(γᵀ 1, b), with ε ≥ 0 and ρ = `weight` > 0 in the unit
/// of the cost. Derivatives by weights: ρ (1 − e^{−u_i/ρ}) + ε (Σ b − e^{−u_i/ρ}). Throws a StatusError.
void solve_kullback_leibler(const TransportProblem& problem, double weight, double epsilon, TransportAnswer& out);

}  // namespace bowstring::unbalanced
