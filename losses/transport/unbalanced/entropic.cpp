#include "losses/transport/unbalanced/entropic.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "losses/transport/unbalanced/divergence.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::unbalanced {
namespace {

constexpr double wanted = 1e-15, tolerable = 1e-9;
constexpr int scalings_first = 20, most_iterations = 500;

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
    const double scale = rho_ * (a_.sum() + b_.sum());
    Iterate best;
    double least = HUGE_VAL;
    int since_best = 0;
    for (long k = 0; k < most_iterations && since_best < 20; ++k) {
      if (k < scalings_first || damped_) scale_both();
      if (k >= scalings_first) newton();
      const double gap = measure();
      since_best = gap < 0.9 * least ? 0 : since_best + 1;
      if (gap < least) {
        least = gap;
        best = {u_, v_, plan_, k + 1, 0};
      }
      if (least <= wanted * scale) break;
    }
    if (!(least <= tolerable * scale)) {
      throw StatusError(Code::failed, "scaling ended with a duality gap of " + std::to_string(least / scale) +
                                          " of the marginal weight times the masses; expected 1e-9");
    }
    best.memory_bytes = static_cast<std::size_t>(4 * plan_.size()) * sizeof(double) + system_.memory_bytes();
    return best;
  }

 private:
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

  void newton() {
    plan_ = plan_of(u_, v_);
    const Vector of_a = a_ * (-u_ / rho_).exp(), of_b = b_ * (-v_ / rho_).exp();
    system_.factor(plan_ / epsilon_, of_a / rho_, of_b / rho_);
    Vector u, v;
    system_.solve(of_a - plan_.rowwise().sum(), of_b - plan_.colwise().sum().transpose(), u, v);
    // What stands in the exponents moves by two at most.
    const double in_plan = ((u.replicate(1, v.size())).rowwise() + v.transpose()).abs().maxCoeff() / epsilon_;
    const double in_sums = std::max(u.abs().maxCoeff(), v.abs().maxCoeff()) / rho_;
    const double length = std::min(1.0, 2.0 / std::max({in_plan, in_sums, 1.0}));
    damped_ = length < 1.0;
    u_ += length * u;
    v_ += length * v;
  }

  Vector a_, b_;
  double rho_, epsilon_;
  Matrix cost_;
  Vector u_, v_;
  Matrix plan_;
  bool damped_ = false;
  DominantSystem system_;
};

}  // namespace

Iterate solve_by_scaling(const Problem& problem) { return Entropic(problem).run(); }

}  // namespace bowstring::unbalanced
