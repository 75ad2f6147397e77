#pragma once

#include "study/plan/plan.hpp"
#include "study/results/collect.hpp"
#include "study/results/shapes.hpp"

namespace bowstring::study {

/// Shapes of runs whose documents are kept, at most `most`: of every formulation the one with the finest mesh, then
/// spread over the rest. In the plane of the two directions in which vessels and wires extend most (the principal axes
/// of all their points); in the plane as they stand.
Shapes collect_shapes(const Plan& plan, const Collected& collected, const Folder& folder, int most = 24);

}  // namespace bowstring::study
