#include "losses/transport/unbalanced/interior_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "losses/transport/unbalanced/divergence.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::unbalanced {
namespace {

constexpr double wanted = 1e-18, good = 1e-14;
constexpr int most_iterations = 300;

struct Step {
  Vector u, v;
  Matrix slack, plan;
};

/// The longest step, up to one, that leaves x + step dx ≥ 0.
double longest(const Matrix& x, const Matrix& dx) { return 1.0 / std::max(1.0, (-dx / x).maxCoeff()); }

double logarithmic_mean(double x, double y) {
  const double t = (y - x) / x;
  return std::fabs(t) < 1e-4 ? x * (1.0 + 0.5 * t) : (y - x) / std::log(y / x);
}

class InteriorPoint {
 public:
  explicit InteriorPoint(const Problem& problem)
      : a_(problem.a), b_(problem.b), rho_(problem.weight), cost_(problem.cost.min(far * problem.weight)) {}

  Iterate run() {
    start();
    const double scale = cost_scale(cost_, rho_) * (a_.sum() + b_.sum());
    Iterate best;
    double least = HUGE_VAL;
    int since_best = 0;
    for (long k = 0; k < most_iterations && since_best < (least <= good * scale ? 2 : 8); ++k) {
      measure();
      if (!std::isfinite(gap_)) break;
      since_best = gap_ < 0.9 * least ? 0 : since_best + 1;
      if (gap_ < least) {
        least = gap_;
        best = {u_, v_, plan_, k, 0};
      }
      if (least <= wanted * scale) break;
      advance();
    }
    require_gap("the interior-point method", least / scale);
    best.memory_bytes = static_cast<std::size_t>(12 * plan_.size()) * sizeof(double) + system_.memory_bytes();
    return best;
  }

 private:
  /// All products γ s alike, as many masses on either side, and the plan's.
  void start() {
    u_ = 0.5 * cost_.rowwise().minCoeff();
    v_ = 0.5 * cost_.colwise().minCoeff().transpose();
    // The sums of a e^{−u/ρ} without over- or underflow.
    const double low_u = u_.minCoeff(), low_v = v_.minCoeff();
    const double log_a = std::log((a_ * (-(u_ - low_u) / rho_).exp()).sum()) - low_u / rho_;
    const double log_b = std::log((b_ * (-(v_ - low_v) / rho_).exp()).sum()) - low_v / rho_;
    const double shift = 0.5 * rho_ * (log_a - log_b), mean = cost_.mean();
    const double inside = 0.5 * (mean > 0.0 ? std::min(rho_, mean) : rho_);
    u_ += shift - inside;
    v_ -= shift + inside;
    slack_ = ((-cost_).colwise() + u_).rowwise() + v_.transpose();
    slack_ = -slack_;
    plan_ = slack_.inverse();
    plan_ *= (a_ * (-u_ / rho_).exp()).sum() / plan_.sum();
  }

  void measure() {
    of_a_ = a_ * (-u_ / rho_).exp();
    of_b_ = b_ * (-v_ / rho_).exp();
    sum_a_ = plan_.rowwise().sum();
    sum_b_ = plan_.colwise().sum().transpose();
    penalty_gap_ = rho_ * (divergence(sum_a_, of_a_) + divergence(sum_b_, of_b_));
    product_ = (plan_ * slack_).sum();
    gap_ = product_ + penalty_gap_;
  }

  /// Newton's step towards γ s = target.
  Step step(const Matrix& target) {
    const Matrix centred = target / slack_;
    Step out;
    system_.solve(of_a_ - centred.rowwise().sum(), of_b_ - centred.colwise().sum().transpose(), out.u, out.v);
    out.slack = (-out.u).replicate(1, slack_.cols()).rowwise() - out.v.transpose();
    out.plan = centred - plan_ - plan_ / slack_ * out.slack;
    return out;
  }

  /// The slope of a e^{−u/ρ} between where it is and where it is the plan's sum: their logarithmic mean over ρ. The
  /// derivative alone would send a u whose exponential has all but vanished beyond all bounds.
  Vector excess(const Vector& of, const Vector& sum) const {
    return of.binaryExpr(sum, [](double x, double y) { return logarithmic_mean(x, y); }) / rho_;
  }

  /// Up to one, so that no a e^{−u/ρ} grows beyond e³ times what it and the plan's sum are.
  double trust(const Step& step) const {
    const double most_a = (-step.u / (rho_ * (3.0 + (sum_a_ / of_a_).max(1.0).log()))).maxCoeff();
    const double most_b = (-step.v / (rho_ * (3.0 + (sum_b_ / of_b_).max(1.0).log()))).maxCoeff();
    return 1.0 / std::max({1.0, most_a, most_b});
  }

  void advance() {
    const double count = static_cast<double>(plan_.size()), mean = product_ / count;
    system_.factor(plan_ / slack_, excess(of_a_, sum_a_), excess(of_b_, sum_b_));
    const Step predictor = step(Matrix::Zero(plan_.rows(), plan_.cols()));
    const double length =
        std::min({longest(slack_, predictor.slack), longest(plan_, predictor.plan), trust(predictor)});
    const double ahead = ((plan_ + length * predictor.plan) * (slack_ + length * predictor.slack)).sum() / product_;
    const double centring = std::max(ahead * ahead * ahead, 0.5 * (1.0 - length) * (1.0 - length) * (1.0 - length));
    // Products that run ahead of the marginals leave the plan without room to correct these.
    const double target = std::max(centring * mean, std::min(mean, 0.1 * penalty_gap_ / count));
    const Step both =
        step((target - length * length * predictor.slack * predictor.plan).max(0.1 * target).min(10.0 * target));
    const double reach = std::min(longest(slack_, both.slack), longest(plan_, both.plan));
    const double stride = std::min(reach < 1.0 ? 0.99 * reach : 1.0, trust(both));
    u_ += stride * both.u;
    v_ += stride * both.v;
    slack_ += stride * both.slack;
    plan_ += stride * both.plan;
  }

  Vector a_, b_;
  double rho_;
  Matrix cost_;
  Vector u_, v_;
  Matrix slack_, plan_;   // a slack by its own steps, which keeps its digits when it is small beside costs
  Vector sum_a_, sum_b_;  // of the plan
  Vector of_a_, of_b_;    // a e^{−u/ρ}, b e^{−v/ρ}
  double gap_ = 0.0, product_ = 0.0, penalty_gap_ = 0.0;
  DominantSystem system_;
};

}  // namespace

double cost_scale(const Matrix& cost, double weight) {
  const double largest = cost.min(far * weight).abs().maxCoeff();
  return largest > 0.0 ? std::min(weight, largest) : weight;
}

void require_gap(const char* method, double gap) {
  constexpr double tolerable = 1e-9;
  if (gap <= tolerable) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s ended with a duality gap of %.3g of what the masses may cost; expected %g",
                method, gap, tolerable);
  throw StatusError(Code::failed, text);
}

Iterate solve_by_interior_point(const Problem& problem) { return InteriorPoint(problem).run(); }

}  // namespace bowstring::unbalanced
