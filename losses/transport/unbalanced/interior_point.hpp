#pragma once

#include <cstddef>

#include "losses/transport/unbalanced/dominant_system.hpp"

namespace bowstring::unbalanced {

/// min over γ ≥ 0 of ⟨C, γ⟩ + ε KL(γ, a bᵀ) + ρ KL(γ 1, a) + ρ KL(γᵀ 1, b), KL(x, y) = Σ x log(x/y) − x + y.
struct Problem {
  Vector a, b;          ///< > 0
  Matrix cost;          ///< a.size() × b.size(); +∞ forbids
  double weight = 0.0;  ///< ρ > 0
  double epsilon = 0.0;
};

/// A plan ≥ 0, whatever its sums, and duals.
struct Iterate {
  Vector u, v;
  Matrix plan;
  long iterations = 0;
  std::size_t memory_bytes = 0;
};

/// Costs are taken for at most this many ρ: an optimal plan has √(a_i b_j) e^{−c/2ρ} at most between two places, and
/// e^{−40} of a mass is beyond doubles.
inline constexpr double far = 80.0;

/// What a unit of mass may cost or forgo: ρ, or the largest cost where that is less and not zero.
double cost_scale(const Matrix& cost, double weight);

/// Throws the StatusError (`failed`) of a method that ended too far from the optimum; `gap` is relative.
void require_gap(const char* method, double gap);

/// Of ε = 0, by a primal-dual interior-point method with a predictor and a corrector (S. Mehrotra, SIAM J. Optim. 2
/// (1992) 575) on
///   a_i e^{−u_i/ρ} = Σ_j γ_ij,   b_j e^{−v_j/ρ} = Σ_i γ_ij,   s_ij = c_ij − u_i − v_j > 0,   γ_ij s_ij = μ → 0.
/// The plan has no sums to keep and u, v none but s > 0, so that each iterate bounds the optimum from both sides, by
///   Σ γ s + ρ Σ (γ1 log(γ1/a e^{−u/ρ}) − γ1 + a e^{−u/ρ}) + the same of b.
/// It ends where this is 1e-18 of the masses times `cost_scale` or gets no better.
/// Rows ≤ columns. Throws a StatusError (`failed`) where that bound stays above 1e-9 of it.
Iterate solve_by_interior_point(const Problem& problem);

}  // namespace bowstring::unbalanced
