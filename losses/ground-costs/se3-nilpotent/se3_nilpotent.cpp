#include <cstddef>
#include <vector>

#include "../geodesics/metric_frames.hpp"
#include "../geodesics/nilpotent_cost.hpp"
#include "core/interfaces/ground_cost.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::geodesics;

constexpr ParameterDeclaration schema[] = {forward_weight, bend_weight, roll_weight};

/// β² d̂² of the nilpotent approximation of the sub-Riemannian metric at the identity; see README.md.
class Se3Nilpotent final : public GroundCost {
 public:
  explicit Se3Nilpotent(const ParameterSet& set) {
    const double bend = set.scalar("bend-weight"), roll = set.scalar("roll-weight") / bend;
    shrink_ = set.scalar("forward-weight") / bend;
    scale_ = bend * bend;
    roll_squared_ = roll * roll;
  }

  const char* unit() const noexcept override { return ""; }
  bool needs_frames() const noexcept override { return true; }

  Status evaluate(const Measure& a, const Measure& b, Span<const int> pairs, Span<double> value,
                  Span<double> gradient) const noexcept override {
    return guard([&] {
      const std::vector<lie::Se3> from = frames_of(a, shrink_), to = frames_of(b, shrink_);
      for (std::size_t k = 0; k < value.size(); ++k) {
        const auto i = static_cast<std::size_t>(pairs[2 * k]), j = static_cast<std::size_t>(pairs[2 * k + 1]);
        const NilpotentCost cost = nilpotent_cost(from[i].inverse() * to[j], roll_squared_, !gradient.empty());
        value[k] = scale_ * cost.squared;
        if (gradient.empty()) continue;
        double* out = gradient.data() + 6 * k;
        (scale_ * lie::se3::angular(cost.gradient)).store(out);
        (scale_ * shrink_ * lie::se3::linear(cost.gradient)).store(out + 3);
      }
    });
  }

  Status rows(const Measure& a, const Measure& b, int begin, int end, Span<double> value) const noexcept override {
    return guard([&] {
      const std::vector<lie::Se3> from = frames_of(a, shrink_), to = frames_of(b, shrink_);
      double* out = value.data();
      for (int i = begin; i < end; ++i) {
        const lie::Se3 inverse = from[static_cast<std::size_t>(i)].inverse();
        for (const lie::Se3& frame : to)
          *out++ = scale_ * nilpotent_cost(inverse * frame, roll_squared_, false).squared;
      }
    });
  }

 private:
  double shrink_, scale_, roll_squared_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::GroundCost, Se3Nilpotent>(
    bowstring::Kind::ground_cost, "se3-nilpotent",
    "Squared distance of frames in the nilpotent approximation of the metric without lateral motion", schema))
