#pragma once

#include <memory>
#include <vector>

#include "core/kkt/kkt_system.hpp"
#include "solvers/newton/inertia_correction.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"
#include "solvers/newton/sides.hpp"

namespace bowstring::newton {

/// Brings rows together where a line search on the whole problem finds no way: Newton's method, with exact second
/// derivatives, on
///   Φ(q) = E + Σ c²/(2 f) + Σ max(0, g)²/(2 e) − ν Σ log(room of bounded unknowns),
/// c the equality rows, g the sides of the others, e and f (mm/N) falling by decades, f to far below e (R. Fletcher,
/// Practical Methods of Optimization, 12.1). The energy is the metric in which the least-squares step is short: curves
/// stay smooth. Where rows can hold together, what is left of them falls with e. Where they cannot, it stays, and a
/// stationary point of the violation with no direction of negative curvature is the end.
class Restoration {
 public:
  Restoration(Point& point, Progress& progress);

  /// From point.q, which is accepted and expanded, until Σ violations ≤ goal: the claim is `optimal` then. Otherwise
  /// `infeasible`, with the rows that fail; `stalled`; `failed`. `multipliers`: m, those that Φ gives, at the end; none
  /// where the claim is `infeasible`.
  Ending run(double goal, std::vector<double>& multipliers);

 private:
  void read_bounds(const std::vector<double>& q, std::vector<double>& room) const;
  double value(double energy, const std::vector<double>& rows, const std::vector<double>& room) const;
  double summed(const std::vector<double>& rows) const;
  void find_forces();
  void find_gradient();
  /// What of a unit of violation its own gradient leaves: 0 at a stationary point of the violation.
  double pull_of_violation();
  bool direction();
  bool leftmost_direction();
  bool search(double longest, bool along_curvature);
  void tighten();
  double longest_step() const;
  Status take();

  Point& point_;
  Progress& progress_;
  Problem& problem_;
  std::unique_ptr<Problem> relaxed_;  // its equality rows are soft ones
  kkt::KktSystem system_;
  InertiaCorrection inertia_;
  std::vector<Side> sides_, bounds_;
  std::vector<int> equalities_;
  double softness_ = 1.0, equality_softness_ = 1.0;
  double largest_force_ = 0.0;
  std::vector<double> force_, gradient_, room_;
  std::vector<double> soft_, right_a_, right_b_, delta_, lambda_;
  std::vector<double> trial_q_, trial_rows_, trial_room_;
  double trial_energy_ = 0.0;
  Status trial_failure_;
};

}  // namespace bowstring::newton
