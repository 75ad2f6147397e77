#pragma once

#include "core/transport/transport_comparison.hpp"

namespace bowstring {

/// The derivatives of a transport value along a motion of the places, on either side of it.
///
/// F(x) = min over plans of ⟨C(x), γ⟩ is a minimum of smooth functions, so that along any motion
///   F'(0+) = min over OPTIMAL plans of ⟨Ċ, γ⟩ ≤ max over the same of ⟨Ċ, γ⟩ = F'(0−)
/// (J. Danskin, SIAM J. Appl. Math. 14 (1966) 641). The two are equal where the optimal plan is one, and what lies
/// between them is the set of subgradients (Clarke's) along the motion: kinks point down, and a line search that meets
/// one from either side goes down on both.
struct OneSidedDerivatives {
  double before = 0.0;  ///< of the values before the place: F'(0−)
  double after = 0.0;   ///< F'(0+) ≤ F'(0−)
};

/// `a`, `b`: measures that `comparison`, of an exact method, has compared with the answer `at`. `motion_a`, `motion_b`:
/// body twists (ω, ν) of their places, count × 6; of points without orientation ω counts for nothing and the axes are
/// the global ones. Both extremes over the optimal face are found by the method itself, started cold, with the rates of
/// cost on arcs without reduced cost (to 1e-9 of the certificate's scale) and the others forbidden. `unsupported` where
/// the method does not know whether its plan is unique, or lets mass go.
Status one_sided_derivatives(const TransportComparison& comparison, const Measure& a, const Measure& b,
                             const TransportResult& at, Span<const double> motion_a, Span<const double> motion_b,
                             OneSidedDerivatives& out);

}  // namespace bowstring
