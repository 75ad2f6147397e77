#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"
#include "core/interfaces/solver.hpp"
#include "core/kkt/kkt_system.hpp"

namespace bowstring::newton {

/// A point of a problem, with what Newton's method reads there. Calls are counted and timed into a SolverResult.
class Point {
 public:
  Point(Problem& problem, SolverResult& count);

  /// Gradient, rows and Jacobian at q.
  Status expand();
  /// energy and rows at `at`, which may need a new epoch once it is accepted.
  Status try_out(Span<const double> at, double& energy, std::vector<double>& rows);
  /// Hessian of E + λᵀr at q, into `hessian`.
  Status find_hessian(Span<const double> multipliers);
  /// Makes q the accepted point, and begins an epoch where that is due (true) or asked for.
  Status accept(bool& new_epoch);
  /// Both, the first one first: q becomes the point that the next step starts from.
  Status arrive(bool* new_epoch = nullptr);

  std::vector<double> q;
  double energy = 0.0;
  std::vector<double> gradient, rows, jacobian, hessian;

  /// out = ∇E + Jᵀλ.
  void lagrangian_gradient(Span<const double> multipliers, std::vector<double>& out) const;
  /// Largest |v_u|/scale_u, in N.
  double in_newtons(Span<const double> v) const noexcept;
  /// J·δ of one row.
  double row_rate(int row, Span<const double> delta) const noexcept;

  Problem& problem() const noexcept { return problem_; }

  /// For the patterns of the current epoch, which are analysed when they are new.
  kkt::KktSystem& system();
  /// It is analysed once more, with the present Jacobian, before it is next used: what was chosen far from here may fit
  /// no longer.
  void analyse_again() noexcept { analysed_ = false; }

 private:
  void fit_patterns();
  template <class Call>
  Status timed(Call&& call);

  Problem& problem_;
  SolverResult& count_;
  kkt::KktSystem system_;
  bool analysed_ = false;
};

}  // namespace bowstring::newton
