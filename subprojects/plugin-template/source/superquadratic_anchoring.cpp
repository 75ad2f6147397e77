#include <cmath>
#include <string>

#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"
#include "plugins/sdk/templated_law.hpp"

namespace {

using namespace bowstring;

constexpr double unlimited = 1e308;

constexpr ParameterDeclaration schema[] = {
    {"stiffness", ParameterType::profile, "N/mm^2|N/mm", nullptr,
     "k: pull over displacement beyond the slack, at the reference displacement; per length (N/mm^2), or per node "
     "(N/mm), which depends on the mesh",
     0.0, unlimited, false, true},
    {"slack", ParameterType::profile, "mm", "\"0 mm\"", "u0: displacement up to which the tissue does not pull", 0.0,
     unlimited, false, true},
    {"reference-displacement", ParameterType::profile, "mm", "\"1 mm\"",
     "d: displacement beyond the slack at which the pull is k d, whatever the exponent", 0.0, unlimited, true, true},
    {"exponent", ParameterType::scalar, "", "4.0", "m: the energy grows like the power m of the displacement", 2.0, 6.0,
     true},
};
constexpr int per_node_unit = 1;

/// V = (k d²/m) (⟨|p − p⁰| − u₀⟩/d)^m with ⟨e⟩ = max(e, 0). README.md derives it.
struct SuperquadraticLaw {
  double exponent;
  Weighing weighing;

  LawDescription describe() const {
    LawDescription description;
    description.site = Site::node;
    description.weighing = weighing;
    description.parameters = {"stiffness", "slack", "reference-displacement"};
    description.objective = false;
    return description;
  }

  template <class T>
  T energy(const LawPoint<T>& place) const {
    using std::pow, std::sqrt;
    // mm²: nearer to State 1 the derivatives of the distance overflow, while V, V' and V'' are zero to rounding.
    constexpr double nearest_squared = 1e-100;
    const T &stiffness = place.parameter[0], &slack = place.parameter[1], &reference = place.parameter[2];
    T squared = 0.0;
    for (std::size_t k = 0; k < place.x.size(); ++k) {
      const T u = place.x[k] - place.reference[k];
      squared += u * u;
    }
    // Comparisons that a NaN fails, so that it goes on into the result, where the kernel finds it.
    if (squared <= nearest_squared) return 0.0;
    const T excess = sqrt(squared) - slack;
    if (excess <= 0.0) return 0.0;
    return stiffness * reference * reference / exponent * pow(excess / reference, exponent);
  }
};

class SuperquadraticAnchoring final : public Energy {
 public:
  explicit SuperquadraticAnchoring(const ParameterSet& parameters)
      : law_({parameters.scalar("exponent"), parameters.at("stiffness").unit_alternative == per_node_unit
                                                 ? Weighing::per_place
                                                 : Weighing::per_length}) {}

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      if (curve.extension == Extension::sliding && law_.description().weighing == Weighing::per_length) {
        throw StatusError(Code::unsupported,
                          "superquadratic-anchoring per length on '" + std::string(curve.name) +
                              "', whose length slides, would have to follow its material; put it on the vessel, give "
                              "the wire a fixed length, or give the stiffness per node (N/mm)");
      }
      out.laws = {&law_};
      out.descriptions = {law_.description()};
    });
  }

 private:
  TemplatedLaw<SuperquadraticLaw> law_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, SuperquadraticAnchoring>(
    bowstring::Kind::energy, "superquadratic-anchoring",
    "Tissue that gives way by a slack and then pulls the harder the further a curve moves from State 1", schema))
