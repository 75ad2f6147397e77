#pragma once

#include <string>

#include "geodesic_flow.hpp"

namespace bowstring::geodesics {

/// Of a target, in units of β.
struct DistanceBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// Certified bounds of the distance, κ = 0 or not.
///
/// Lower: the closed form with the smallest of the weights, and of a metric without lateral motion also those that
/// `lower_bound` adds. Upper: turn, drive, turn, forward and backward, with the turn before the drive or after it
/// chosen as it costs least; with κ > 0 also the one-parameter path.
DistanceBounds distance_bounds(const lie::Se3& target, const Weights& weights) noexcept;

/// The lower one alone. With t the last tangent, n any direction and θ the angle of R, a curve without lateral motion
/// satisfies each of
///   d² ≥ |x|² + min(ρ, 1)² θ²,
///   d ≥ |x + t − e₁| and d ≥ |x − t + e₁|,
///   d ≥ √(2π|x·n|) − |ψ| and d ≥ √(4π(|x·n − x₁ψ'| − …)) − …   (README.md has the proofs)
double lower_bound(const lie::Se3& target, const Weights& weights) noexcept;

/// A shortest geodesic, as far as the search can know.
struct GeodesicDistance {
  bool found = false;
  double squared = 0.0;  ///< in units of β²
  Covector start;        ///< at the identity; minus half of the derivative of `squared` by the first place
  int shots = 0;         ///< boundary value problems that were solved for it
  std::string failure;   ///< why not, where it was not found
};

/// The squared distance of `target` from the identity.
GeodesicDistance geodesic_distance(const lie::Se3& target, const Weights& weights);

/// |x|² + |Log R|² and its covector, the closed form for κ = 1, ρ = 1.
GeodesicDistance isotropic_distance(const lie::Se3& target) noexcept;

}  // namespace bowstring::geodesics
