#pragma once

#include <vector>

#include "core/interfaces/solver.hpp"
#include "core/kkt/kkt_system.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/trust-region/metric.hpp"

namespace bowstring::trust_region {

/// The rows by themselves, with factors of (S Jᵀ; J 0).
class NormalStep {
 public:
  NormalStep(newton::Point& point, const Metric& metric, SolverResult& count);

  /// At the point's patterns. Allocates.
  void analyse();
  /// At the point's Jacobian; false: it has no usable factors.
  bool factor();
  /// Multipliers with the least |∇E + Jᵀλ| in the metric's dual norm.
  void multipliers(std::vector<double>& out);
  /// The shortest step, in the metric's norm, that brings the linearised rows nearest to their values.
  void step(std::vector<double>& delta);
  /// Σ|c + Jδ|, mm.
  double left(Span<const double> delta) const;
  /// Solves S δ + Jᵀ λ = a, J δ = b.
  void solve(Span<const double> a, Span<const double> b, std::vector<double>& delta, std::vector<double>& lambda);

 private:
  newton::Point& point_;
  const Metric& metric_;
  SolverResult& count_;
  kkt::KktSystem system_;
  std::vector<double> weights_, no_softness_, a_, b_, delta_, lambda_;
};

}  // namespace bowstring::trust_region
