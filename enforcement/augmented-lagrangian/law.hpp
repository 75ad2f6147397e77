#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/enforcement/softened_problem.hpp"
#include "enforcement/shared/row_sides.hpp"

namespace bowstring::augmented {

/// λ r + ½ w r² of equality rows; of sides r ≤ 0 the same while λ + w r > 0, and constant beyond.
class AugmentedLaw final : public RowLaw {
 public:
  AugmentedLaw(const softening::RowSides& sides, int rows)
      : multipliers(static_cast<std::size_t>(rows), 0.0), sides_(sides) {}

  double weight = 0.0;
  std::vector<double> multipliers;  ///< of all rows; read of those taken away

  RowEnergy at(int row, double value) const noexcept override {
    const double lower = sides_.lower(row), upper = sides_.upper(row);
    const double multiplier = multipliers[static_cast<std::size_t>(row)];
    if (lower == upper) {
      const double off = value - upper;
      return {off * (multiplier + 0.5 * weight * off), multiplier + weight * off, weight};
    }
    RowEnergy out;
    if (std::isfinite(upper)) out = side(value - upper, std::max(multiplier, 0.0));
    if (std::isfinite(lower)) {
      const RowEnergy other = side(lower - value, std::max(-multiplier, 0.0));
      out.energy += other.energy;
      out.force -= other.force;
      out.stiffness += other.stiffness;
    }
    return out;
  }
  double stiffest() const noexcept override { return weight; }

 private:
  RowEnergy side(double r, double multiplier) const noexcept {
    const double force = multiplier + weight * r;
    if (!(force > 0.0)) return {-0.5 * multiplier * multiplier / weight, 0.0, 0.0};
    return {r * (multiplier + 0.5 * weight * r), force, weight};
  }

  const softening::RowSides& sides_;
};

}  // namespace bowstring::augmented
