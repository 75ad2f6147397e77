#pragma once

#include <cstddef>
#include <vector>

#include "losses/transport/fused-gromov-wasserstein/structure.hpp"
#include "losses/transport/network-simplex/network_simplex.hpp"

namespace bowstring::gromov {

/// F(γ) = (1 − α) ⟨C, γ⟩ + α Σ_ijkl (A_ik − B_jl)² γ_ij γ_kl over plans γ with sums a and b.
struct Problem {
  Vector a, b;
  Matrix cost;                      ///< C, m × n; empty with α = 1
  Matrix structure_a, structure_b;  ///< A, B: symmetric
  double alpha = 0.5;
};

struct Settings {
  double tolerance;  ///< of the Frank-Wolfe gap, relative to `scale_of`
  long max_iterations;
};

/// A plan from which no step towards another one goes down, but for the tolerance.
struct Stationary {
  Matrix plan;
  double value = 0.0;
  double gap = 0.0;                 ///< max over plans of ⟨∇F, γ − ·⟩ (Frank and Wolfe's)
  std::vector<double> row, column;  ///< potentials of ∇F: of the last linear program
  long iterations = 0, pivots = 0;
  std::size_t memory_bytes = 0;  ///< of the method, but for the simplex
};

/// What F could be of a bad plan.
double scale_of(const Problem& problem);
double value_of(const Problem& problem, const Matrix& plan);

/// Conditional gradient with an exact line search (T. Vayer et al., ICML 2019): the best vertex for ∇F by network
/// simplex, which goes on from the one before. Where F, a parabola along that way, is concave, the plan becomes that
/// vertex; where A and B are Euclidean distances, plain or squared, it always is, and the method ends by itself.
/// Elsewhere the vertex takes mass from the one of those that the plan is mixed of that costs most (pairwise steps,
/// S. Lacoste-Julien, M. Jaggi, NIPS 2015): plain steps close the gap like 1/k. `simplex` has the masses of a and b.
/// Throws a StatusError (`failed`) after too many steps.
Stationary descend(const Problem& problem, const Matrix& start, const Settings& settings,
                   simplex::NetworkSimplex& simplex);

/// The simplex method's plan as a matrix.
Matrix vertex_of(const simplex::NetworkSimplex& simplex);

}  // namespace bowstring::gromov
