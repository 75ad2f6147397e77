#include <cmath>
#include <string>

#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "bending-stiffness",
     .type = ParameterType::profile,
     .unit = "N mm^2",
     .default_text = nullptr,
     .description = "EI of the vessel",
     .lower = 0.0,
     .differentiable = true},
    {.key = "torsional-stiffness",
     .type = ParameterType::profile,
     .unit = "N mm^2",
     .default_text = "0.0",
     .description = "GJ; in space 0 means that only the magnitude of the curvature is felt. No effect in the plane",
     .lower = 0.0,
     .differentiable = true},
    {.key = "stretch-stiffness",
     .type = ParameterType::profile,
     .unit = "N",
     .default_text = "0.0",
     .description = "EA; 0 means that nothing resists stretching along the vessel",
     .lower = 0.0,
     .differentiable = true},
};

bool vanishes(const Profile& profile) {
  if (profile.form == Profile::Form::constant) return profile.constant == 0.0;
  if (profile.form == Profile::Form::column) return false;
  for (const double value : profile.value) {
    if (value != 0.0) return false;
  }
  return true;
}

/// W = ½ (ω − ω⁰)ᵀ diag(GJ, EI, EI) (ω − ω⁰); in the plane its one bending component. Objective: ω is the rotation
/// between neighbouring edge frames in the body frame. Preprint eq. (17), vessel strain energy, per material length.
class StrainLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    if (batch.dimension == 1) evaluate<1>(batch);
    if (batch.dimension == 2) evaluate<2>(batch);
    if (batch.dimension == 3) evaluate<3>(batch);
    return {};
  }

 private:
  template <int n>
  static double stiffness(const LawBatch& batch, int i, int k) noexcept {
    return batch.parameter[n == 3 && k == 0 ? 1 : 0][i];
  }

  template <int n>
  static void evaluate(const LawBatch& batch) noexcept {
    for (int i = 0; i < batch.count; ++i) {
      double energy = 0.0;
      for (int k = 0; k < n; ++k) {
        const double difference = batch.x[i * n + k] - batch.reference[i * n + k];
        const double stress = stiffness<n>(batch, i, k) * difference;
        energy += 0.5 * stress * difference;
        if (batch.stress != nullptr) batch.stress[i * n + k] = stress;
      }
      if (batch.energy != nullptr) batch.energy[i] = energy;
    }
    for (int i = 0; batch.modulus != nullptr && i < batch.count; ++i) {
      double* c = batch.modulus + i * packed_size(n);
      for (int k = 0; k < n; ++k) {
        for (int l = 0; l <= k; ++l) c[packed_index(k, l)] = k == l ? stiffness<n>(batch, i, k) : 0.0;
      }
    }
  }
};

/// W = ½ EI (|κ| − |κ⁰|)²: the energy of the preprint's spatial toy, which feels the magnitude of the curvature only.
/// Where |κ| = 0 and |κ⁰| > 0 it has no derivative; there the stress is zero and the modulus that of |κ⁰| = 0.
class MagnitudeLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    const int n = batch.dimension;
    const int first = n == 3 ? 1 : 0;
    for (int i = 0; i < batch.count; ++i) {
      const double* kappa = batch.x + i * n;
      const double ei = batch.parameter[0][i];
      const double magnitude = norm(kappa, first, n);
      const double rest = norm(batch.reference + i * n, first, n);
      const double difference = magnitude - rest;
      // W' / |κ|, the secant modulus.
      const double secant = magnitude > 0.0 ? ei * difference / magnitude : (rest > 0.0 ? 0.0 : ei);
      if (batch.energy != nullptr) batch.energy[i] = 0.5 * ei * difference * difference;
      if (batch.stress != nullptr) {
        for (int k = 0; k < n; ++k) batch.stress[i * n + k] = k < first ? 0.0 : secant * kappa[k];
      }
      if (batch.modulus != nullptr) {
        double* c = batch.modulus + i * packed_size(n);
        for (int k = 0; k < n; ++k) {
          for (int l = 0; l <= k; ++l) {
            const bool bending = k >= first && l >= first;
            const double along = magnitude > 0.0 ? kappa[k] * kappa[l] / (magnitude * magnitude) : 0.0;
            c[packed_index(k, l)] = bending ? (k == l ? secant : 0.0) + (ei - secant) * along : 0.0;
          }
        }
      }
    }
    return {};
  }

 private:
  static double norm(const double* x, int first, int n) {
    double squared = 0.0;
    for (int k = first; k < n; ++k) squared += x[k] * x[k];
    return std::sqrt(squared);
  }
};

/// W = ½ EA (λ − 1)², λ the stretch ratio of an edge.
class StretchLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    for (int i = 0; i < batch.count; ++i) {
      const double ea = batch.parameter[0][i];
      const double extension = batch.x[i] - 1.0;
      if (batch.energy != nullptr) batch.energy[i] = 0.5 * ea * extension * extension;
      if (batch.stress != nullptr) batch.stress[i] = ea * extension;
      if (batch.modulus != nullptr) batch.modulus[i] = ea;
    }
    return {};
  }
};

class VesselStrain final : public Energy {
 public:
  explicit VesselStrain(const ParameterSet& parameters)
      : torsion_(!vanishes(parameters.profile("torsional-stiffness"))),
        stretch_(!vanishes(parameters.profile("stretch-stiffness"))) {}

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      LawDescription strain;
      strain.site = Site::station;
      strain.parameters = {"bending-stiffness", "torsional-stiffness"};
      const bool space = curve.dimension == 3;
      if (!space) out.without_effect.push_back({"torsional-stiffness", "a curve in the plane does not twist"});
      if (space && torsion_) {
        strain.isotropic = false;
        out.needs.material_frames = true;
        out.needs.reason = "vessel-strain of '" + std::string(curve.name) + "' has torsional-stiffness > 0";
      }
      if (!space || torsion_) {
        out.laws.push_back(&strain_law_);
      } else {
        out.laws.push_back(&magnitude_law_);
      }
      out.descriptions.push_back(strain);
      if (stretch_) {
        LawDescription stretch;
        stretch.site = Site::edge;
        stretch.parameters = {"stretch-stiffness"};
        out.laws.push_back(&stretch_law_);
        out.descriptions.push_back(stretch);
        out.needs.stretch = true;
      }
      warn(curve, out);
    });
  }

 private:
  void warn(const CurveView& curve, EnergyDeclaration& out) const {
    if (curve.rigid) return;
    const std::string name = "vessel '" + std::string(curve.name) + "': ";
    if (!stretch_) {
      out.warnings.push_back(
          name +
          "stretch-stiffness is 0, so nothing resists stretching along it: edges bunch up and may fold as "
          "meshes get finer and wires stiffer (planar iliac: stretch ratios 0.76…1.19 at 320 nodes, where EA = 11 N "
          "gives 0.89…0.92), and the peak displacement is that of EA = 0 (10.55 mm against 9.75 mm). A thin tube "
          "has EA = 2 EI/R²");
    }
    if (curve.dimension == 3 && !torsion_) {
      out.warnings.push_back(
          name +
          "torsional-stiffness is 0, so only the magnitude of the curvature is felt: curvature vectors may "
          "zigzag at mesh scale (helix: bending energy 0.07 N mm against 2.69 with frames; 257 iterations "
          "against 17 at 240 nodes). A thin tube has GJ = ⅔ EI");
    }
  }

  bool torsion_, stretch_;
  StrainLaw strain_law_;
  MagnitudeLaw magnitude_law_;
  StretchLaw stretch_law_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, bowstring::VesselStrain>(
    bowstring::Kind::energy, "vessel-strain",
    "Bending, torsion and stretch of a vessel away from State 1: ½ ∫ Δωᵀ diag(GJ, EI, EI) Δω + EA (λ − 1)² ds",
    bowstring::schema))
