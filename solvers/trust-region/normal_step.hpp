#pragma once

#include <vector>

#include "core/interfaces/solver.hpp"
#include "core/kkt/kkt_system.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/trust-region/metric.hpp"

namespace bowstring::trust_region {

/// Steps to the rows, with factors of (M Jᵀ; J 0): M is the energy's Hessian, shifted by the metric: by
/// about its own curvature for displacements as smooth as the scene is long, and further where M is not positive. What
/// restores rows is then as smooth as the energy asks for, in whatever unknowns a curve has, and no longer than needed.
class NormalStep {
 public:
  NormalStep(newton::Point& point, const Metric& metric, SolverResult& count);

  /// At the point's patterns. Allocates.
  void analyse();
  /// At the point; it leaves the energy's own Hessian there. `usable`: false where no shift gives sound factors.
  Status factor(bool& usable);
  /// Multipliers with the least |∇E + Jᵀλ| in the dual norm of M.
  void multipliers(std::vector<double>& out);
  /// The step δ with the least δᵀMδ to the linearised rows.
  void step(std::vector<double>& delta);
  /// Σ|c + Jδ|, mm.
  double left(Span<const double> delta) const;
  /// Solves M δ + Jᵀ λ = a, J δ = b.
  void solve(Span<const double> a, Span<const double> b, std::vector<double>& delta, std::vector<double>& lambda);

 private:
  double smooth_curvature() const;

  newton::Point& point_;
  const Metric& metric_;
  SolverResult& count_;
  kkt::KktSystem system_;
  double shift_ = 0.0;
  std::vector<double> energy_hessian_, no_multipliers_, no_softness_, a_, b_, delta_, lambda_;
};

}  // namespace bowstring::trust_region
