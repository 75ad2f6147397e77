#include "core/model/held_axes.hpp"

#include <algorithm>

namespace bowstring {

Status HeldAxes::declare(const ConstraintScene&, RowDeclaration& out) noexcept {
  out.rows = static_cast<int>(axes_.size());
  out.place_begin.assign(1, 0);
  for (const HeldAxis& held : axes_) {
    out.places.push_back({held.curve, Site::node, held.node});
    out.place_begin.push_back(static_cast<int>(out.places.size()));
  }
  out.lower.assign(axes_.size(), 0.0);
  out.upper.assign(axes_.size(), 0.0);
  return {};
}

Status HeldAxes::evaluate(const RowEvaluation& evaluation) const noexcept {
  for (std::size_t r = 0; r < axes_.size(); ++r) {
    const HeldAxis& held = axes_[r];
    const double* p = evaluation.at->table(held.curve, Site::node) + held.node * dimension_;
    if (!evaluation.residual.empty()) {
      double along = -held.value;
      for (int k = 0; k < dimension_; ++k) along += held.axis[k] * p[k];
      evaluation.residual[r] = along;
    }
    if (!evaluation.jacobian.empty()) {
      std::copy_n(held.axis, dimension_, evaluation.jacobian.data() + static_cast<int>(r) * dimension_);
    }
  }
  std::fill(evaluation.hessian.begin(), evaluation.hessian.end(), 0.0);
  return {};
}

}  // namespace bowstring
