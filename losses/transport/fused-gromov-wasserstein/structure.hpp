#pragma once

#include <Eigen/Core>

#include "core/interfaces/transport.hpp"

namespace bowstring::gromov {

using Vector = Eigen::ArrayXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What is compared of two places of one measure: their distance √c, or c.
enum class StructureForm { distance, squared_distance };

/// D of all pairs of one measure: symmetric, zeros on the diagonal. Throws the StatusError of what fails.
Matrix structure_of(PairCosts& within, StructureForm form);

/// From Σ_ik `by_structure`_ik dD_ik, both matrices symmetric, to derivatives by the costs of pairs i < k, each of
/// which stands for (k, i) too. Pairs at the same place, where the distance has a cone, are left out and counted.
SparseEntries by_cost_within(const Matrix& structure, const Matrix& by_structure, StructureForm form, long& coincident);

}  // namespace bowstring::gromov
