#pragma once

#include <cmath>

#include "core/enforcement/softened_problem.hpp"
#include "enforcement/shared/row_sides.hpp"

namespace bowstring::penalty {

/// Of r ≤ 0: φ = ½ w max(r, 0)².
struct Quadratic {
  double weight = 0.0;
  RowEnergy operator()(double r) const noexcept {
    if (!(r > 0.0)) return {};
    return {0.5 * weight * r * r, weight * r, weight};
  }
};

/// Of r ≤ 0, with d = f/w: φ = −(f²/w) ln(−r/d) up to r = −d, and from there its Taylor polynomial of second order.
struct LogQuadratic {
  double weight = 0.0, force = 0.0;
  RowEnergy operator()(double r) const noexcept {
    const double d = force / weight;
    if (r <= -d) {
      const double barrier = force * d;
      return {-barrier * std::log(-r / d), -barrier / r, barrier / (r * r)};
    }
    const double t = r + d;
    return {force * t + 0.5 * weight * t * t, force + weight * t, weight};
  }
};

/// A law whose weight may be set.
class WeightedLaw : public RowLaw {
 public:
  virtual void set_weight(double weight) noexcept = 0;
};

/// φ over the finite sides of a row; an equality row has the parabola ½ w r² on both.
template <class Form>
class PenaltyLaw final : public WeightedLaw {
 public:
  PenaltyLaw(const softening::RowSides& sides, const Form& form) : sides_(sides), form_(form) {}

  void set_weight(double weight) noexcept override { form_.weight = weight; }

  RowEnergy at(int row, double value) const noexcept override {
    const double lower = sides_.lower(row), upper = sides_.upper(row);
    if (lower == upper) {
      const double off = value - upper;
      return {0.5 * form_.weight * off * off, form_.weight * off, form_.weight};
    }
    RowEnergy out;
    if (std::isfinite(upper)) out = form_(value - upper);
    if (std::isfinite(lower)) {
      const RowEnergy side = form_(lower - value);
      out.energy += side.energy;
      out.force -= side.force;
      out.stiffness += side.stiffness;
    }
    return out;
  }
  double stiffest() const noexcept override { return form_.weight; }

 private:
  const softening::RowSides& sides_;
  Form form_;
};

}  // namespace bowstring::penalty
