#pragma once

#include <vector>

#include "core/interfaces/transport.hpp"
#include "losses/transport/network-simplex/dense_costs.hpp"
#include "losses/transport/network-simplex/network_simplex.hpp"

namespace bowstring::unbalanced {

/// min over γ ≥ 0 of ⟨C, γ⟩ + ρ Σ |a − γ 1| + ρ Σ |b − γᵀ 1|, with costs ≥ 0: then no optimal plan has sums above the
/// weights, and it is a linear program. One more row, of mass Σ b, and one more column, of mass Σ a, take what is given
/// up, at cost ρ, and their own rest, at cost 0. It keeps its tree from call to call; of dear costs it evaluates those
/// that a plan uses.
class TotalVariation {
 public:
  /// `weight`: ρ > 0, in the unit of the cost. Throws a StatusError.
  void solve(const TransportProblem& problem, double weight, TransportAnswer& out);
  void forget() noexcept { simplex_.forget(); }

 private:
  void extend(const TransportProblem& problem, double weight);
  std::size_t evaluate(const std::vector<simplex::Arc>& plan);

  simplex::NetworkSimplex simplex_;
  simplex::DenseCosts costs_;
  std::size_t rows_ = 0, columns_ = 0;  // of the measures
  std::vector<double> weight_a_, weight_b_, extended_;
};

}  // namespace bowstring::unbalanced
