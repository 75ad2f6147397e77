#pragma once

#include <vector>

#include "core/kkt/kkt_system.hpp"
#include "core/procedure/parameter_family.hpp"

namespace bowstring {

/// An equilibrium at one value of a family, and where the path of equilibria goes on from there.
struct PathState {
  double share = 0.0;  ///< t
  std::vector<double> q, multipliers;
  std::vector<double> motion;           ///< per free unknown: d/da
  std::vector<double> multiplier_rate;  ///< per row: d/da
  double share_rate = 0.0;              ///< dt/da
  int negative_directions = 0;          ///< of the Hessian of the Lagrangian with every active row held
  int iterations = 0;                   ///< that it took
};

/// Follows a path of equilibria through its folds: pseudo-arclength continuation (H. B. Keller, *Numerical solution of
/// bifurcation and nonlinear eigenvalue problems*, 1977) of the first-order conditions
///   ∇E(q; t) + Jᵀλ = 0,  r(q; t) = its bound on equality rows and on active inequality rows,  λ = 0 on the others,
/// with the active set of a semismooth Newton method: row i is active where λ_i + ρ (r_i − bound) > 0 (M. Hintermüller,
/// K. Ito, K. Kunisch 2003). Arclength a is da² = |dp|² / (n L²) + dt²: root-mean-square motion of the nodes over a
/// twentieth of the longest curve, and the share t of the way; no dimension.
///
/// Nothing here descends: minima and saddles are found alike. Rows count as exact, whatever the enforcement.
class PathFollower {
 public:
  explicit PathFollower(ParameterFamily& family) : family_(family) {}

  /// An equilibrium at `state.share`, from its q and multipliers, and the path's direction there; that of `before`, or
  /// with rising share.
  Status settle(PathState& state, const PathState* before = nullptr);

  /// The same without the direction, which a family of one member does not have.
  Status settle_without_direction(PathState& state);

  /// The equilibrium an arclength of `step` on. Fails where Newton's method does not converge in a few iterations, or
  /// where the path turns so much that another branch may have been met: the step has to be shorter then.
  Status advance(const PathState& from, double step, PathState& out);

  /// Brings the family to that value, with what its ends hold there, and binds rows at q.
  Status place(double share, std::vector<double>& q);

  /// Root-mean-square distance of the nodes of two states over a twentieth of the longest curve.
  double distance(const std::vector<double>& a, const std::vector<double>& b) const;

 private:
  /// What Newton's method adds to the first-order conditions: a · (q − q₀) + b (t − t₀) = step.
  struct Closing {
    const PathState* from = nullptr;  ///< null: t stays
    double step = 0.0;
  };

  Status evaluate(const PathState& state);
  /// Marks active rows, and lets the others carry nothing.
  void choose_active(PathState& state);
  void lagrangian_gradient(const std::vector<double>& multipliers, std::vector<double>& out) const;
  Status factor(const PathState& state);
  /// d/dt of the first-order conditions at a fixed state.
  Status rates(const PathState& state);
  Status correct(PathState& state, const Closing& closing);
  Status find_direction(PathState& state, const PathState* before);
  void measure_nodes();
  double along(const std::vector<double>& motion, const std::vector<double>& other) const;
  double along_displacement(const std::vector<double>& motion, const std::vector<double>& from,
                            const std::vector<double>& to) const;
  Assembly& assembly() noexcept { return *family_.session().assembly; }
  const Assembly& assembly() const noexcept { return *family_.session().assembly; }

  ParameterFamily& family_;
  struct Node {
    int unknown, coordinate;
  };
  std::vector<Node> nodes_;  // free coordinates of positions
  double weight_ = 1.0;      // 1 / (n L²)
  const Session* measured_ = nullptr;
  kkt::KktSystem system_;
  std::vector<double> gradient_, jacobian_, rows_, hessian_, softness_;
  std::vector<char> held_;
  std::vector<double> gradient_rate_, row_rate_;
};

}  // namespace bowstring
