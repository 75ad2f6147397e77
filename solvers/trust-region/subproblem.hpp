#pragma once

#include <vector>

#include "core/interfaces/solver.hpp"
#include "core/kkt/kkt_system.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/trust-region/metric.hpp"

namespace bowstring::trust_region {

/// The least curvature of W on the null space of the rows, in N/mm: ½·curvature·|δ|² is the energy along it.
struct Leftmost {
  bool known = false;
  double curvature = 0.0;
  std::vector<double> direction;  ///< n, of norm 1; its first large entry is positive
};

/// Tangential steps: min ½ tᵀWt − aᵀt subject to J t = 0, |t| ≤ Δ, after J. J. Moré and D. C. Sorensen, SIAM J. Sci.
/// Stat. Comput. 4 (1983) 553: factors of W + σS on the null space of J for a few σ. Inertia says whether σ is beyond
/// the leftmost curvature, Newton's method on 1/Δ − 1/|t(σ)| finds the boundary, and inverse iteration gives the
/// direction to be added in the hard case.
class Subproblem {
 public:
  Subproblem(newton::Point& point, const Metric& metric, SolverResult& count);

  /// At the point's patterns. Allocates.
  void analyse();

  struct Answer {
    bool found = false;      ///< false: no shift gives usable factors
    double shift = 0.0;      ///< σ ≥ 0, N/mm
    bool interior = false;   ///< |t| < Δ with σ = 0: Newton's own step
    bool hard = false;       ///< a direction of negative curvature was added
    double full_norm = 0.0;  ///< |t(0)|, infinity where W has negative curvature
    int negative = 0;        ///< negative curvatures of W on the null space
  };
  /// `right`: a. `least_gradient`: |aᵀz| below it (in N mm for z of norm 1) does not decide the sign of z. The factors
  /// stay for `solve`. W is the point's Hessian.
  Answer minimise(Span<const double> right, double radius, double least_gradient, std::vector<double>& step,
                  std::vector<double>& multipliers);

  /// Solves with the last factors.
  void solve(Span<const double> a, Span<const double> b, std::vector<double>& delta, std::vector<double>& lambda);

  /// Does W + σS, on the null space, have positive curvature alone? `negative`: how many there are that are not.
  bool positive(double shift, int& negative);
  /// The leftmost curvature, to `accuracy` (relative), by bisection on the inertia and inverse iteration.
  Leftmost leftmost(double accuracy = 1e-3);

 private:
  bool extend(Span<const double> right, double radius, double least_gradient, double shift, double share,
              double leftmost, std::vector<double>& step);
  bool factor(double shift, int* negative = nullptr);
  /// A few inverse iterations from the last direction; its Rayleigh quotient of W, NaN where the factors fail.
  double inverse_iteration(int steps);
  double curvature(Span<const double> direction) const;
  void multiply(Span<const double> direction, std::vector<double>& out) const;  // W direction
  void point_forward();

  newton::Point& point_;
  const Metric& metric_;
  SolverResult& count_;
  kkt::KktSystem system_;
  std::vector<double> shifted_, no_softness_, zero_rows_, right_, work_, product_, multipliers_, derivative_;
  std::vector<double> direction_;  // of the last inverse iteration
  double last_shift_ = 0.0;
};

}  // namespace bowstring::trust_region
