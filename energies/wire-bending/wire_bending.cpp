#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "bending-stiffness",
     .type = ParameterType::profile,
     .unit = "N mm^2",
     .default_text = nullptr,
     .description = "EI of the wire",
     .lower = 0.0,
     .differentiable = true},
};

/// W = ½ EI |κ|² with κ the bending part of the strain: all of it in the plane and without material frames, its last
/// two components with them (the first one is twist). Preprint eq. (14) with a straight rest shape.
class BendingLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    if (batch.dimension == 1) evaluate<1>(batch);
    if (batch.dimension == 2) evaluate<2>(batch);
    if (batch.dimension == 3) evaluate<3>(batch);
    return {};
  }

 private:
  template <int n>
  static void evaluate(const LawBatch& batch) noexcept {
    constexpr int first = n == 3 ? 1 : 0;
    const double* stiffness = batch.parameter[0];
    for (int i = 0; batch.energy != nullptr && i < batch.count; ++i) {
      double squared = 0.0;
      for (int k = first; k < n; ++k) squared += batch.x[i * n + k] * batch.x[i * n + k];
      batch.energy[i] = 0.5 * stiffness[i] * squared;
    }
    for (int i = 0; batch.stress != nullptr && i < batch.count; ++i) {
      for (int k = 0; k < n; ++k) batch.stress[i * n + k] = k < first ? 0.0 : stiffness[i] * batch.x[i * n + k];
    }
    for (int i = 0; batch.modulus != nullptr && i < batch.count; ++i) {
      double* c = batch.modulus + i * packed_size(n);
      for (int k = 0; k < n; ++k) {
        for (int l = 0; l <= k; ++l) c[packed_index(k, l)] = k == l && k >= first ? stiffness[i] : 0.0;
      }
    }
  }
};

class WireBending final : public Energy {
 public:
  explicit WireBending(const ParameterSet&) {}

  Status declare(const CurveView&, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      LawDescription description;
      description.site = Site::station;
      description.parameters = {"bending-stiffness"};
      out.laws = {&law_};
      out.descriptions = {description};
    });
  }

 private:
  BendingLaw law_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, bowstring::WireBending>(
    bowstring::Kind::energy, "wire-bending", "Bending of a wire that is straight at rest: ½ ∫ EI κ² ds",
    bowstring::schema))
