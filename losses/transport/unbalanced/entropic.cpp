#include "losses/transport/unbalanced/entropic.hpp"

#include <algorithm>
#include <cmath>

#include "losses/transport/unbalanced/divergence.hpp"

namespace bowstring::unbalanced {
namespace {

constexpr double wanted = 1e-28, good = 1e-14;  // the gap is a square of what is off in the duals
constexpr double cooling = 0.25;                // from one ε to the next
constexpr int most_iterations = 200;

class Entropic {
 public:
  explicit Entropic(const Problem& problem)
      : a_(problem.a),
        b_(problem.b),
        rho_(problem.weight),
        epsilon_(problem.epsilon),
        cost_(problem.cost),
        u_(Vector::Zero(problem.a.size())),
        v_(Vector::Zero(problem.b.size())) {}

  Iterate run() {
    const double wanted_epsilon = epsilon_;
    for (epsilon_ = std::max(wanted_epsilon, cost_.min(rho_).mean()); epsilon_ > wanted_epsilon;
         epsilon_ = std::max(wanted_epsilon, cooling * epsilon_)) {
      approach();
    }
    return finish();
  }

 private:
  /// Near enough to the solution of this ε for the next one to start from.
  void approach() {
    scale_both();
    for (int k = 0; k < most_iterations && newton() > 0.5; ++k) scale_both();
  }

  Iterate finish() {
    const double mass = a_.sum() + b_.sum(), scale = cost_scale(cost_, rho_) * mass;
    Iterate best;
    double least = HUGE_VAL;
    bool near = false;
    for (int k = 0, since_best = 0; k < most_iterations && since_best < (least <= good * rho_ * mass ? 2 : 30); ++k) {
      if (!near) scale_both();
      near = newton() < 0.5;
      const double gap = measure();
      since_best = gap < 0.9 * least ? 0 : since_best + 1;
      if (gap < least) {
        least = gap;
        best = {u_, v_, plan_, 0, 0};
      }
      if (least <= wanted * scale) break;
    }
    require_gap("scaling", least / (rho_ * mass));
    best.iterations = iterations_;
    best.memory_bytes = static_cast<std::size_t>(5 * plan_.size()) * sizeof(double) + system_.memory_bytes();
    return best;
  }

  /// −ρε/(ρ + ε) log Σ weight e^{exponent}.
  double scaled(const Eigen::Ref<const Vector>& exponent, const Vector& weight) const {
    const double most = exponent.maxCoeff();
    if (std::isinf(most)) return far * rho_;  // every pair is forbidden
    const double log = most + std::log((weight * (exponent - most).exp()).sum());
    return std::min(-rho_ * epsilon_ / (rho_ + epsilon_) * log, far * rho_);
  }

  void scale_both() {
    for (Eigen::Index i = 0; i < u_.size(); ++i) {
      u_[i] = scaled((v_ - cost_.row(i).transpose()) / epsilon_, b_);
    }
    for (Eigen::Index j = 0; j < v_.size(); ++j) v_[j] = scaled((u_ - cost_.col(j)) / epsilon_, a_);
  }

  Matrix plan_of(const Vector& u, const Vector& v) const {
    Matrix out = (((-cost_).colwise() + u).rowwise() + v.transpose()) / epsilon_;
    return (out.exp().colwise() * a_).rowwise() * b_.transpose();
  }

  double measure() {
    plan_ = plan_of(u_, v_);
    return rho_ * (divergence(plan_.rowwise().sum(), a_ * (-u_ / rho_).exp()) +
                   divergence(plan_.colwise().sum().transpose(), b_ * (-v_ / rho_).exp()));
  }

  /// The dual but for constants, negated: a convex function.
  double loss(const Vector& u, const Vector& v) const {
    return rho_ * ((a_ * (-u / rho_).exp()).sum() + (b_ * (-v / rho_).exp()).sum()) + epsilon_ * plan_of(u, v).sum();
  }

  /// One step; how much it would have changed the exponents of the plan's entries that matter, and of the sums.
  double newton() {
    ++iterations_;
    plan_ = plan_of(u_, v_);
    const Vector of_a = a_ * (-u_ / rho_).exp(), of_b = b_ * (-v_ / rho_).exp();
    const Vector right_a = of_a - plan_.rowwise().sum(), right_b = of_b - plan_.colwise().sum().transpose();
    system_.factor(plan_ / epsilon_, of_a / rho_, of_b / rho_);
    Vector u, v;
    system_.solve(right_a, right_b, u, v);
    const Matrix change = (u.replicate(1, v.size()).rowwise() + v.transpose()).abs() / epsilon_;
    const double in_plan = std::sqrt((plan_ * change.square()).sum() / plan_.sum());
    const double in_sums = std::max(u.abs().maxCoeff(), v.abs().maxCoeff()) / rho_;
    const double slope = (right_a * u).sum() + (right_b * v).sum(), before = loss(u_, v_);
    double length = 1.0;
    for (int halving = 0; halving < 40; ++halving, length *= 0.5) {
      const double after = loss(u_ + length * u, v_ + length * v);
      if (after <= before - 1e-4 * length * slope + 1e-14 * std::fabs(before)) break;
    }
    u_ = (u_ + length * u).min(far * rho_);
    v_ = (v_ + length * v).min(far * rho_);
    return length < 1.0 ? std::max(1.0, in_plan) : std::max(in_plan, in_sums);
  }

  Vector a_, b_;
  double rho_, epsilon_;
  Matrix cost_;
  Vector u_, v_;
  Matrix plan_;
  long iterations_ = 0;
  DominantSystem system_;
};

}  // namespace

Iterate solve_by_scaling(const Problem& problem) { return Entropic(problem).run(); }

}  // namespace bowstring::unbalanced
