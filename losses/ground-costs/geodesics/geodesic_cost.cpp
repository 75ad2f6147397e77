#include "geodesic_cost.hpp"

#include <cstddef>
#include <string>

#include "geodesic_distance.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::geodesics {

GeodesicCost::GeodesicCost(const MetricWeights& metric, bool lateral_motion) : metric_(metric) {
  const double roll = metric.roll / metric.bend, lateral = metric.forward / metric.lateral;
  weights_.roll_squared = roll * roll;
  weights_.lateral_compliance = lateral_motion ? lateral * lateral : 0.0;
}

bool GeodesicCost::dear() const noexcept { return weights_.lateral_compliance != 1.0 || weights_.roll_squared != 1.0; }

Status GeodesicCost::evaluate(const Measure& a, const Measure& b, Span<const int> pairs, Span<double> value,
                              Span<double> gradient) const noexcept {
  return guard([&] {
    const std::vector<lie::Se3> from = frames_of(a, metric_.shrink()), to = frames_of(b, metric_.shrink());
    const double scale = metric_.bend * metric_.bend;
    for (std::size_t k = 0; k < value.size(); ++k) {
      const auto i = static_cast<std::size_t>(pairs[2 * k]), j = static_cast<std::size_t>(pairs[2 * k + 1]);
      const GeodesicDistance distance = geodesic_distance(from[i].inverse() * to[j], weights_);
      if (!distance.found) {
        throw StatusError(Code::failed, "the pair of place " + std::to_string(i) + " of the first measure and place " +
                                            std::to_string(j) + " of the second: " + distance.failure +
                                            "; expected a shortest geodesic between them; weights closer to each "
                                            "other make one easier to find");
      }
      value[k] = scale * distance.squared;
      if (gradient.empty()) continue;
      double* out = gradient.data() + 6 * k;
      (-2.0 * scale * moment(distance.start)).store(out);
      (-2.0 * scale * metric_.shrink() * force(distance.start)).store(out + 3);
    }
  });
}

Status GeodesicCost::lower_bounds(const Measure& a, const Measure& b, int begin, int end,
                                  Span<double> value) const noexcept {
  return guard([&] {
    const std::vector<lie::Se3> from = frames_of(a, metric_.shrink()), to = frames_of(b, metric_.shrink());
    // A search accepts what lies this much below the bound, relative to it.
    const double scale = metric_.bend * metric_.bend * (1.0 - 1e-8);
    double* out = value.data();
    for (int i = begin; i < end; ++i) {
      const lie::Se3 inverse = from[static_cast<std::size_t>(i)].inverse();
      for (const lie::Se3& frame : to) {
        const double lower = lower_bound(inverse * frame, weights_);
        *out++ = scale * lower * lower;
      }
    }
  });
}

}  // namespace bowstring::geodesics
