#include <cstddef>

#include "core/interfaces/ground_cost.hpp"
#include "core/lie/so3.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;

/// |p − q|², mm². By the body tangent of the first place: 0 in ω, 2 Rᵀ(p − q) in ν.
class Euclidean final : public GroundCost {
 public:
  explicit Euclidean(const ParameterSet&) {}

  const char* unit() const noexcept override { return "mm^2"; }
  bool needs_frames() const noexcept override { return false; }

  Status evaluate(const Measure& a, const Measure& b, Span<const int> pairs, Span<double> value,
                  Span<double> gradient) const noexcept override {
    for (std::size_t k = 0; k < value.size(); ++k) {
      const auto i = static_cast<std::size_t>(pairs[2 * k]), j = static_cast<std::size_t>(pairs[2 * k + 1]);
      const Vector3 apart = Vector3::load(&a.position[3 * i]) - Vector3::load(&b.position[3 * j]);
      value[k] = norm_squared(apart);
      if (gradient.empty()) continue;
      const lie::Rotation frame = a.has_frames() ? lie::Rotation::load(&a.orientation[4 * i]) : lie::Rotation();
      double* out = gradient.data() + 6 * k;
      Vector3().store(out);
      (2.0 * (frame.inverse() * apart)).store(out + 3);
    }
    return {};
  }

  Status rows(const Measure& a, const Measure& b, int begin, int end, Span<double> value) const noexcept override {
    double* out = value.data();
    for (int i = begin; i < end; ++i) {
      const double* p = &a.position[3 * static_cast<std::size_t>(i)];
      for (const double *q = b.position.data(), *last = q + b.position.size(); q != last; q += 3) {
        const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
        *out++ = x * x + y * y + z * z;
      }
    }
    return {};
  }
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::GroundCost, Euclidean>(
    bowstring::Kind::ground_cost, "euclidean", "|p - q|^2 of points, in mm^2; frames count for nothing"))
