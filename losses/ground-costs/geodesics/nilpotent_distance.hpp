#pragma once

#include "core/lie/small_matrix.hpp"

namespace bowstring::geodesics {

/// A twist in the coordinates of the nilpotent approximation, lengths in units of β/w₁ and roll apart:
/// s = ν₁, ψ = (ω₃, −ω₂), z = (ν₂, ν₃).
struct NilpotentOffset {
  double forward = 0.0;
  Vector2 bend, lateral;
};

struct NilpotentSolution {
  double squared = 0.0;  ///< squared distance without roll, in units of β²
  Vector2 dual;          ///< λ*, |λ*| ≤ 2π
  double by_forward = 0.0;
  Vector2 by_bend;  ///< the derivative by z is 2λ*
  int iterations = 0;
  /// sin(|λ*|/2) keeps its relative precision near |λ*| = 2π in 1 − |λ*|²/4π² = this.
  double distance_to_pole = 1.0;
};

/// The squared distance of the nilpotent approximation of the sub-Riemannian metric,
///   max over |λ| < 2π of s² + |ψ|² + 2λ·z − ¼ q(|λ|/2)[s²|λ|² + (ψ·λ)²],   q(t) = (1 − t cot t)/t²,
/// a concave maximum in two variables. Where s = 0 and ψ·z = 0, z ≠ 0, the maximum lies on |λ| = 2π, and the
/// derivatives are limits for s → 0 with the sign of s.
///
/// `enough`: the maximisation may stop as soon as the value is certain to be larger; `squared` is then a lower bound
/// that is, and nothing else counts.
NilpotentSolution nilpotent_distance(const NilpotentOffset& offset, double enough = 1e308) noexcept;

}  // namespace bowstring::geodesics
