#pragma once

#include "core/interfaces/solver.hpp"
#include "core/kkt/kkt_system.hpp"

namespace bowstring::newton {

/// Finds the shift of the Hessian's diagonal with which a Newton step descends: none where the curvature on the rows'
/// null space is positive, otherwise the smallest of a growing sequence that makes it so (Wächter and Biegler 2006,
/// algorithm IC).
class InertiaCorrection {
 public:
  /// Factorises; false: no shift within bounds helps, which means that exact rows contradict each other.
  bool factor(kkt::KktSystem& system, kkt::KktSystem::Values values, double least_shift, SolverResult& count);

  double shift() const noexcept { return shift_; }
  const kkt::KktSystem::Outcome& outcome() const noexcept { return outcome_; }

 private:
  double shift_ = 0.0;  // N/mm, of the last factorisation
  double last_ = 0.0;   // the last one that was needed
  kkt::KktSystem::Outcome outcome_;
};

}  // namespace bowstring::newton
