#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"
#include "core/kkt/kkt_system.hpp"

namespace bowstring::newton {

/// What a solver lends after a solve: the KKT system at its result, active rows and equality rows held exactly, other
/// rows off. It is evaluated and factorised when it is first asked for, so that a solve that nobody borrows from costs
/// nothing more; until then the problem has to be there, in the epoch that the solve ended in.
class LentSystem {
 public:
  void keep(Problem& problem, const std::vector<double>& q, const std::vector<double>& multipliers);
  /// (a, b) → (δ, λ), n + m numbers each: W δ + Jᵀλ = a, J δ = b of the rows that are held, λ = 0 of the others. Not ok
  /// where nothing was solved, an unknown lies on its bound, or the system is singular.
  Status solve(Span<const double> right_hand_side, Span<double> out);

 private:
  Status factor();

  Problem* problem_ = nullptr;
  int epoch_ = 0;
  bool factorised_ = false;
  kkt::KktSystem system_;
  std::vector<double> q_, multipliers_, jacobian_, hessian_, softness_;
};

}  // namespace bowstring::newton
