#pragma once

#include "core/interfaces/ground_cost.hpp"
#include "geodesic_flow.hpp"
#include "metric_frames.hpp"

namespace bowstring::geodesics {

/// A ground cost that is found by shooting, for κ = 0 or not. It is `dear` but where it has a closed form.
class GeodesicCost : public GroundCost {
 public:
  /// `lateral_motion`: w_l counts; without it κ = 0.
  GeodesicCost(const MetricWeights& metric, bool lateral_motion);

  const char* unit() const noexcept override { return ""; }
  bool needs_frames() const noexcept override { return true; }
  bool dear() const noexcept override;
  Status evaluate(const Measure& a, const Measure& b, Span<const int> pairs, Span<double> value,
                  Span<double> gradient) const noexcept override;
  Status lower_bounds(const Measure& a, const Measure& b, int begin, int end,
                      Span<double> value) const noexcept override;

 private:
  MetricWeights metric_;
  Weights weights_;
};

}  // namespace bowstring::geodesics
