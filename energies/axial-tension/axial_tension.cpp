#include <string>

#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "tension",
     .type = ParameterType::scalar,
     .unit = "N",
     .default_text = nullptr,
     .description = "dead axial load on the wire at the sheath; negative pushes",
     .differentiable = true},
};

/// T (L − chord) of the preprint's eq. (21): the work of a dead axial load as the length in the body changes. The
/// chord is a constant of the scene, so that a free end never feels it.
class TensionLaw final : public Law {
 public:
  double chord = 0.0;

  Status evaluate(const LawBatch& batch) const noexcept override {
    for (int i = 0; i < batch.count; ++i) {
      const double tension = batch.parameter[0][i];
      if (batch.energy != nullptr) batch.energy[i] = tension * (batch.x[i] - chord);
      if (batch.stress != nullptr) batch.stress[i] = tension;
      if (batch.modulus != nullptr) batch.modulus[i] = 0.0;
    }
    return {};
  }
};

class AxialTension final : public Energy {
 public:
  explicit AxialTension(const ParameterSet&) {}

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      law_.chord = curve.end_distance;
      LawDescription description;
      description.site = Site::length;
      description.weighing = Weighing::per_place;
      description.parameters = {"tension"};
      description.linear = true;
      out.laws = {&law_};
      out.descriptions = {description};
      if (curve.extension != Extension::sliding) {
        out.warnings.push_back("axial-tension has no effect on '" + std::string(curve.name) +
                               "': its length in the body does not slide");
      }
    });
  }

 private:
  TensionLaw law_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, bowstring::AxialTension>(
    bowstring::Kind::energy, "axial-tension", "Dead axial load on a wire that slides through its sheath: T (L − chord)",
    bowstring::schema))
