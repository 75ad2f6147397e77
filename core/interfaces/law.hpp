#pragma once

#include <string>
#include <vector>

#include "core/interfaces/place.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// What a law's number is per.
enum class Weighing : int {
  per_length,  ///< a density: E = ds·W
  per_place    ///< E = W, whatever the mesh
};

struct LawDescription {
  Site site = Site::station;
  Weighing weighing = Weighing::per_length;
  /// Keys of the component's profile parameters (and scalars), in the order of `LawBatch::parameter`.
  std::vector<std::string> parameters;
  /// Which places of the site the law acts on, and what multiplies E there; empty: all of them, and 1. A load at an
  /// arc length inside an edge acts on two nodes with weights 1 − t and t.
  std::vector<int> places;
  std::vector<double> weight;
  bool linear = false;    ///< W is linear in what it reads: no modulus is asked for
  bool isotropic = true;  ///< depends on ζ through |ζ| (and |ζ⁰|) alone: may read two-component strains
  bool objective = true;  ///< claims invariance under rigid motions of the whole scene
};

/// A batch of places of one site. Outputs that are not wanted are null. n = dimension, P = number of parameters.
struct LawBatch {
  int count = 0;
  int dimension = 0;                         ///< numbers in x
  const double* x = nullptr;                 ///< count × n: strain ω = ζ/ds, stretch ratio ℓ/ds, position p, or L
  const double* reference = nullptr;         ///< count × n: x in State 1
  const double* const* parameter = nullptr;  ///< P arrays of count values, sampled at the places
  double* energy = nullptr;                  ///< count: W
  double* stress = nullptr;                  ///< count × n: W_x
  double* modulus = nullptr;                 ///< count × packed_size(n): W_xx
  /// Only asked for where `has_parameter_derivatives`: for sensitivities, and where a parameter moves with the place.
  double* parameter_energy = nullptr;   ///< count × P: W_p
  double* parameter_stress = nullptr;   ///< count × n × P: W_xp
  double* parameter_modulus = nullptr;  ///< count × packed_size(P): W_pp
};

/// An energy W(x, p) that reads one place at a time: a strain energy of ω, a stretch energy of λ, a foundation of a
/// position, or a function of a curve's length, with parameters p that may vary along the curve. The law
/// differentiates in x and p only. The kernel multiplies by ds, knows that ω = ζ/ds and where the place lies, and owns
/// every chain rule: with E = ds·W(ζ/ds, p),
///   E_ζ = W_ω,  E_ds = W − ω·W_ω,  E_ζζ = W_ωω/ds,  E_ζ,ds = −W_ωω ω/ds,  E_ds,ds = ωᵀW_ωω ω/ds.
/// E_ds is the configurational force behind N + M²/2EI = T on a wire that slides.
class Law {
 public:
  virtual ~Law() = default;
  virtual Status evaluate(const LawBatch& batch) const noexcept = 0;
  virtual bool has_parameter_derivatives() const noexcept { return false; }
};

}  // namespace bowstring
