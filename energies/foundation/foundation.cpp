#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "stiffness",
     .type = ParameterType::profile,
     .unit = "N/mm^2|N/mm",
     .default_text = nullptr,
     .description = "foundation modulus per length (N/mm^2), or one spring per node (N/mm), which depends on the mesh",
     .lower = 0.0,
     .differentiable = true},
};
constexpr int per_node_unit = 1;

/// V = ½ k |p − p⁰|²: a Winkler foundation that holds each point near its State 1 position. Preprint eqs. (18) and
/// (19), extravascular resistance and anatomic anchoring, which have one form: only their sum enters an equilibrium.
class FoundationLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    batch.dimension == 2 ? evaluate<2>(batch) : evaluate<3>(batch);
    return {};
  }

 private:
  template <int n>
  static void evaluate(const LawBatch& batch) noexcept {
    const double* stiffness = batch.parameter[0];
    for (int i = 0; i < batch.count; ++i) {
      double squared = 0.0;
      for (int a = 0; a < n; ++a) {
        const double u = batch.x[i * n + a] - batch.reference[i * n + a];
        squared += u * u;
        if (batch.stress != nullptr) batch.stress[i * n + a] = stiffness[i] * u;
      }
      if (batch.energy != nullptr) batch.energy[i] = 0.5 * stiffness[i] * squared;
    }
    for (int i = 0; batch.modulus != nullptr && i < batch.count; ++i) {
      double* c = batch.modulus + i * packed_size(n);
      for (int a = 0; a < n; ++a) {
        for (int b = 0; b <= a; ++b) c[packed_index(a, b)] = a == b ? stiffness[i] : 0.0;
      }
    }
  }
};

class Foundation final : public Energy {
 public:
  explicit Foundation(const ParameterSet& parameters)
      : per_node_(parameters.at("stiffness").unit_alternative == per_node_unit) {}

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      if (curve.extension == Extension::sliding && !per_node_) {
        throw StatusError(Code::unsupported,
                          "a foundation per length on a wire whose length slides would have to follow its material; "
                          "put it on the vessel, or on a wire of fixed length");
      }
      LawDescription description;
      description.site = Site::node;
      description.weighing = per_node_ ? Weighing::per_place : Weighing::per_length;
      description.parameters = {"stiffness"};
      description.objective = false;
      out.laws = {&law_};
      out.descriptions = {description};
    });
  }

 private:
  bool per_node_;
  FoundationLaw law_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(
    bowstring::component<bowstring::Energy, bowstring::Foundation>(
        bowstring::Kind::energy, "anchoring",
        "Anatomic anchoring: springs that hold a curve near its State 1 position, per length or per node",
        bowstring::schema),
    bowstring::component<bowstring::Energy, bowstring::Foundation>(
        bowstring::Kind::energy, "extravascular",
        "Resistance of the tissue around a vessel: springs to State 1 like anchoring, kept apart for their meaning",
        bowstring::schema))
