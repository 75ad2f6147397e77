#pragma once

#include "losses/transport/unbalanced/interior_point.hpp"

namespace bowstring::unbalanced {

/// Of ε > 0: scaling in the log domain (L. Chizat et al., Math. Comp. 87 (2018) 2563),
///   u_i = −ρε/(ρ + ε) log Σ_j b_j e^{(v_j − c_ij)/ε}, and v alike, which gains a factor (ρ/(ρ + ε))² at a time,
/// in turns with Newton's method, with a line search, on the dual,
///   max Σ a ρ (1 − e^{−u/ρ}) + Σ b ρ (1 − e^{−v/ρ}) + ε Σ a_i b_j (1 − e^{(u_i + v_j − c_ij)/ε}),
/// at ε that come down by four from the mean cost; near the end Newton's alone. γ_ij = a_i b_j e^{(u_i + v_j −
/// c_ij)/ε}, and the duality gap is
///   ρ Σ (γ1 log(γ1/a e^{−u/ρ}) − γ1 + a e^{−u/ρ}) + the same of b.
/// It ends where this is 1e-28 of the masses times `cost_scale` or gets no better. Rows ≤ columns. Throws a StatusError
/// (`failed`) where it stays above 1e-9 of the masses times ρ.
Iterate solve_by_scaling(const Problem& problem);

}  // namespace bowstring::unbalanced
