#pragma once

#include <functional>
#include <vector>

#include "core/procedure/records.hpp"

namespace bowstring {

/// Solves the session from several starts, and tells their equilibria apart. The first start is where `solution` came
/// from; the others are perturbed by `MultistartTable`: smooth displacements of every curve's nodes, seeded. Every
/// equilibrium that converges is certified and listed, those of a lower energy first; `solution` becomes the lowest
/// that is a minimum, or else the lowest. With `saddles` the saddle between each two neighbouring minima is looked for,
/// and listed as what it is.
void find_equilibria(Session& session, const MultistartTable& table,
                     const std::function<bool(const IterationRecord&)>& progress, Solution& solution,
                     std::vector<Equilibrium>& equilibria);

}  // namespace bowstring
