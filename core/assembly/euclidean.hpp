#pragma once

#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring {

/// Coordinates x ∈ Rⁿ around a base point: the number itself on real, vector and circle entries, base·Exp(x) on
/// rotations and directions. After summation each curved block is pulled back,
///   g_x = Jᵀg,  H_x = JᵀHJ + Σ_a g_a ∂²δ_a/∂x²,
/// with J = ∂δ/∂x and g the Lagrangian's tangent gradient.
class EuclideanChart final : public EuclideanProblem {
 public:
  EuclideanChart(Assembly& assembly, Span<const double> base);

  void start(Span<double> x) const noexcept override;
  void state(Span<const double> x, Span<double> q) const noexcept override;
  Status evaluate(Span<const double> x, const ProblemEvaluation& evaluation) noexcept override;
  Status lagrangian_hessian(Span<const double> x, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override;
  bool recentre_due(Span<const double> x) const noexcept override;

 private:
  struct CurvedBlock {
    Manifold manifold = Manifold::rotation;
    int block = 0, first = 0, size = 0;
    double jacobian[9] = {};  // size × size, row major: ∂δ/∂x
  };
  struct Run {  // `size` consecutive entries of a Jacobian row that belong to a curved block
    int position = 0, curved = 0;
  };
  void locate();
  void update(Span<const double> x);
  void pull_back_pair(const HessianPattern::Pair& pair, Span<double> values) const noexcept;

  Assembly& assembly_;
  std::vector<double> base_, q_, x_;
  bool has_x_ = false;
  std::vector<CurvedBlock> curved_;
  std::vector<int> curved_of_block_;
  std::vector<Run> runs_;
  std::vector<HessianPattern::Pair> pairs_;  // stored pairs with a curved block
  std::vector<double> gradient_, jacobian_;  // tangent Lagrangian gradient, tangent Jacobian
};

}  // namespace bowstring
