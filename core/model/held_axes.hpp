#pragma once

#include <vector>

#include "core/interfaces/constraint.hpp"

namespace bowstring {

/// A direction in which one node of a curve is held: axis·p = value.
struct HeldAxis {
  int curve = 0, node = 0, end = 0;
  double axis[3] = {0.0, 0.0, 0.0};  ///< unit
  double value = 0.0;                ///< mm
};

/// Rows of ends that are held along axes of their own, where no single coordinate can be eliminated. The force of the
/// support is −multiplier·axis.
class HeldAxes final : public Constraint {
 public:
  explicit HeldAxes(std::vector<HeldAxis> axes, int dimension) : axes_(std::move(axes)), dimension_(dimension) {}

  Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept override;
  Status evaluate(const RowEvaluation& evaluation) const noexcept override;
  Status rebind(RowDeclaration&) noexcept override { return {}; }

  const std::vector<HeldAxis>& axes() const noexcept { return axes_; }

 private:
  std::vector<HeldAxis> axes_;
  int dimension_;
};

}  // namespace bowstring
