#pragma once

#include <vector>

#include "losses/transport/network-simplex/masses.hpp"
#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// The last column with mass: the root of the trees below.
int root_column(const Masses& masses);

// First trees, strongly feasible from `root_column`: the arcs of a greedy plan of masses that are disturbed as A. Orden
// (Management Science 2 (1956) 276) has it, each supply by one and the root's demand by all of these, in a second
// digit. No place then runs out together with another one, and the plan has as many arcs as a tree. Places without mass
// are left out.

/// The north-west corner rule: rows and columns as they come.
std::vector<Arc> north_west_start(const Masses& masses);

/// Row by row in the given order, each to the columns that are the cheapest for it among those left, at cost[i][j] +
/// add[j]; +∞ last.
std::vector<Arc> cheapest_start(const Masses& masses, const std::vector<int>& rows, const double* cost,
                                const std::vector<double>& add);

}  // namespace bowstring::simplex
