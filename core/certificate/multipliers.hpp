#pragma once

#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring {

/// Multipliers of a point that came without: the minimisers of |g + J_Eᵀλ + J_Aᵀμ| with μ ≥ 0, over the equality rows
/// and the inequality rows within `reach` (mm) of their bound; the others are zero. Rotational entries are weighed by
/// `stationarity_scale`, so that the residual is in N. Block principal pivoting: Portugal, Júdice & Vicente, Math.
/// Comp. 63 (1994) 625. `out`: one number per row.
Status estimate_multipliers(Assembly& assembly, Span<const double> q, double reach, std::vector<double>& out);

}  // namespace bowstring
