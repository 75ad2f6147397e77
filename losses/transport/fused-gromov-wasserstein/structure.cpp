#include "losses/transport/fused-gromov-wasserstein/structure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plugins/sdk/guard.hpp"

namespace bowstring::gromov {
namespace {

void require(const Status& status) {
  if (!status.ok()) throw StatusError(status);
}

std::vector<int> pairs_of(int count) {
  std::vector<int> out;
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count; ++k) out.insert(out.end(), {i, k});
  }
  return out;
}

}  // namespace

Matrix structure_of(PairCosts& within, StructureForm form) {
  const int count = within.row_count();
  const std::vector<int> pairs = pairs_of(count);
  std::vector<double> cost(pairs.size() / 2);
  if (!cost.empty()) require(within.evaluate(pairs, cost));
  Matrix out = Matrix::Zero(count, count);
  for (std::size_t k = 0; k < cost.size(); ++k) {
    const double between = form == StructureForm::distance ? std::sqrt(std::max(cost[k], 0.0)) : cost[k];
    out(pairs[2 * k], pairs[2 * k + 1]) = out(pairs[2 * k + 1], pairs[2 * k]) = between;
  }
  return out;
}

SparseEntries by_cost_within(const Matrix& structure, const Matrix& by_structure, StructureForm form,
                             long& coincident) {
  SparseEntries out;
  const int count = static_cast<int>(structure.rows());
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count; ++k) {
      double derivative = 2.0 * by_structure(i, k);
      if (form == StructureForm::distance) {
        if (structure(i, k) == 0.0 && derivative != 0.0) ++coincident;
        derivative = structure(i, k) > 0.0 ? derivative / (2.0 * structure(i, k)) : 0.0;
      }
      if (derivative == 0.0) continue;
      out.row.push_back(i);
      out.column.push_back(k);
      out.value.push_back(derivative);
    }
  }
  return out;
}

}  // namespace bowstring::gromov
