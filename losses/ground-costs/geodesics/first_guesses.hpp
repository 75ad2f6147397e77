#pragma once

#include <vector>

#include "geodesic_flow.hpp"
#include "nilpotent_distance.hpp"

namespace bowstring::geodesics {

/// s, ψ, z of a twist; its roll is left out.
NilpotentOffset nilpotent_offset(const lie::se3::Twist& twist) noexcept;

/// Initial covector of the nilpotent geodesic that the dual solution belongs to: with
/// μ = |λ*|, n = λ*/μ, ψ = ψ_n n + ψ_p and k = (μ/2)/sin(μ/2),
///   a₀ = k(s cos(μ/2) − ψ_n sin(μ/2)),  b₀ = k(s sin(μ/2) + ψ_n cos(μ/2)),  Q = b₀ n + ψ_p,
///   p₀ = (a₀, λ₁*, λ₂*),  m₀ = (ρ²ω₁, −Q₂, Q₁).
Covector nilpotent_covector(const lie::se3::Twist& twist, const NilpotentSolution& solution,
                            const Weights& weights) noexcept;

/// The same with (a₀, b₀) turned to the angle `phase`: near |λ*| = 2π, where all geodesics of the nilpotent
/// approximation go through whole turns and end in places near to each other, nothing else tells the right one.
Covector nilpotent_covector(const lie::se3::Twist& twist, const NilpotentSolution& solution, const Weights& weights,
                            double phase) noexcept;

/// G·log: the covector of the one-parameter path at its start, κ > 0.
Covector one_parameter_covector(const lie::se3::Twist& twist, const Weights& weights) noexcept;

/// What is left of a geodesic when its middle is long: a turn from the first tangent into the direction p̂ of the force,
/// a straight drive, and a turn out of it into the last tangent, each turn an arc of the separatrix.
///
/// With the force as unit, P = |p₀|, σ = m₁/P, c² = 1 − κ > 0, t the tangent of a turn, u = p̂·t and S = √(c²(1+u)² −
/// σ²),
///   u' = (1 − u) S,  φ' = σ/(1 + u),
/// integrate to: a turn falls behind along p̂ by √(4c² − σ²) − S, moves sideways by (S t⊥ ± σ p̂ × t)/(1 + u), + for the
/// first turn and − for the last, and carries frames like the shortest rotation between t and p̂ with one about p̂ by
/// asin(σ/(c(1 + u))) − asin(σ/2c). Without roll σ = 0 and the distance is |x − c(t₀ + t₁)| + 2c. What it leaves out
/// falls like exp(−cP).
struct FarField {
  bool exists = false;
  Vector3 direction;     ///< p̂
  double length = 0.0;   ///< P
  double charge = 0.0;   ///< σ, of the tangent that drives along +p̂
  double roll = 0.0;     ///< turn about the tangent that is spread evenly
  double squared = 0.0;  ///< squared distance, approximately
  Covector start;
};

/// `backward`: drives against its tangent. `turns`: whole turns of roll on top of the shortest.
FarField far_field(const lie::Se3& target, const Weights& weights, bool backward, int turns) noexcept;

/// Covectors at the starts of `parts` equal parts.
std::vector<Covector> far_field_guess(const lie::Se3& target, const Weights& weights, const FarField& field,
                                      bool backward, int parts);

}  // namespace bowstring::geodesics
