#include "shooting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bowstring::geodesics {
namespace {

using Block = Matrix<6, 6>;

/// Ad_{g⁻¹}: a body twist before g as the body twist behind it that does the same.
Block behind(const lie::Se3& g) { return lie::se3::adjoint(g.inverse()); }

/// Rows of a linear system in place, by Gauss's elimination with partial pivoting. False where it is singular.
bool solve_in_place(std::vector<double>& a, std::vector<double>& b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::fabs(a[i * n + k]) > std::fabs(a[pivot * n + k])) pivot = i;
    }
    if (!(std::fabs(a[pivot * n + k]) > 0.0)) return false;
    if (pivot != k) {
      for (std::size_t j = k; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
      std::swap(b[k], b[pivot]);
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      if (factor == 0.0) continue;
      for (std::size_t j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k * n + j] * b[j];
    b[k] /= a[k * n + k];
  }
  return true;
}

/// The singular value decomposition a = u diag(σ) vᵀ by one-sided Jacobi rotations.
struct Decomposition {
  Block scaled_u, v;  ///< columns of `scaled_u`: σ u
  Vector<6> sigma_squared;

  explicit Decomposition(const Block& a) : scaled_u(a), v(Block::identity()) {
    for (int sweep = 0; sweep < 30; ++sweep) {
      double largest = 0.0;
      for (int p = 0; p < 6; ++p) {
        for (int q = p + 1; q < 6; ++q) largest = std::max(largest, rotate(p, q));
      }
      if (largest < 1e-15) break;
    }
    for (int j = 0; j < 6; ++j) sigma_squared[j] = norm_squared(scaled_u.column(j));
  }

  /// The step of least length that answers `residual` in all directions but those of the smallest singular values, of
  /// which as many are left out as it takes to keep it shorter than `limit`.
  Vector<6> step(const Vector<6>& residual, double limit) const {
    std::array<int, 6> order{0, 1, 2, 3, 4, 5};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return sigma_squared[i] > sigma_squared[j]; });
    Vector<6> out;
    for (const int j : order) {
      if (!(sigma_squared[j] > 0.0)) break;
      const Vector<6> next = out + dot(scaled_u.column(j), residual) / sigma_squared[j] * v.column(j);
      if (norm(next) > limit && norm(out) > 0.0) break;
      out = next;
    }
    return out;
  }

 private:
  double rotate(int p, int q) {
    const Vector<6> up = scaled_u.column(p), uq = scaled_u.column(q);
    const double a = norm_squared(up), b = norm_squared(uq), g = dot(up, uq);
    if (!(std::fabs(g) > 0.0)) return 0.0;
    const double zeta = (b - a) / (2.0 * g);
    const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::sqrt(1.0 + zeta * zeta));
    const double cosine = 1.0 / std::sqrt(1.0 + t * t), sine = cosine * t;
    scaled_u.set_column(p, cosine * up - sine * uq);
    scaled_u.set_column(q, sine * up + cosine * uq);
    const Vector<6> vp = v.column(p), vq = v.column(q);
    v.set_column(p, cosine * vp - sine * vq);
    v.set_column(q, sine * vp + cosine * vq);
    return std::fabs(g) / std::sqrt(a * b);
  }
};

class Shooting {
 public:
  Shooting(const lie::Se3& target, const Weights& weights, std::size_t parts, double size)
      : target_(target), weights_(weights), parts_(parts), residual_(6 * parts) {
    const double unit = std::min(size, 1.0), lateral = std::max(unit, std::sqrt(weights.lateral_compliance));
    twist_unit_ = {{unit, unit, unit, unit, unit * lateral, unit * lateral}};
    covector_unit_ = {{unit, unit, unit, unit, unit / lateral, unit / lateral}};
    if (size > 1.0) covector_unit_ = size * covector_unit_;
  }

  /// Follows all parts; the scaled residual is in `residual`, its norm the answer.
  double evaluate(const std::vector<Covector>& start, Accuracy accuracy) {
    ends_.resize(parts_);
    const double duration = 1.0 / static_cast<double>(parts_);
    for (std::size_t i = 0; i < parts_; ++i) ends_[i] = follow_geodesic(start[i], duration, weights_, accuracy);
    lie::Se3 reached = ends_[0].pose;
    for (std::size_t i = 1; i < parts_; ++i) reached = reached * ends_[i].pose;
    const lie::se3::Twist miss = lie::se3::log(reached.inverse() * target_);
    for (int k = 0; k < 6; ++k) residual_[static_cast<std::size_t>(k)] = miss[k] / twist_unit_[k];
    for (std::size_t i = 0; i + 1 < parts_; ++i) {
      for (int k = 0; k < 6; ++k) {
        residual_[6 * (i + 1) + static_cast<std::size_t>(k)] =
            (ends_[i].covector[k] - start[i + 1][k]) / covector_unit_[k];
      }
    }
    double sum = 0.0;
    for (const double r : residual_) sum += r * r;
    return std::sqrt(sum);
  }

  /// The step of Newton's method at what was evaluated last; empty where the system is singular.
  std::vector<Covector> step() {
    const std::size_t n = 6 * parts_;
    matrix_.assign(n * n, 0.0);
    lie::Se3 rest;
    for (std::size_t i = parts_; i-- > 0;) {
      const Block by_start = behind(rest) * ends_[i].by_start;
      rest = ends_[i].pose * rest;
      put(by_start, 0, i, twist_unit_);
      if (i + 1 == parts_) continue;
      // start[i + 1] + δ[i + 1] = end[i] + A δ[i]
      put(-covector_by_start(ends_[i]), i + 1, i, covector_unit_);
      put(Block::identity(), i + 1, i + 1, covector_unit_);
    }
    solution_ = residual_;
    if (!solve_in_place(matrix_, solution_)) return {};
    std::vector<Covector> out(parts_);
    for (std::size_t i = 0; i < parts_; ++i) {
      for (int k = 0; k < 6; ++k) out[i][k] = covector_unit_[k] * solution_[6 * i + static_cast<std::size_t>(k)];
    }
    return out;
  }

  /// The same for one part whose system is nearly singular: shorter than `limit`, see Decomposition.
  std::vector<Covector> cautious_step(double limit) {
    Block a;
    Vector<6> r;
    const Block by_start = ends_[0].by_start;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) a(i, j) = by_start(i, j) * covector_unit_[j] / twist_unit_[i];
      r[i] = residual_[static_cast<std::size_t>(i)];
    }
    Vector<6> out = Decomposition(a).step(r, limit);
    for (int k = 0; k < 6; ++k) out[k] *= covector_unit_[k];
    return {out};
  }

  /// 2H of a geodesic that reaches the target, to second order in what is missing: dH = covector · motion of the end.
  double squared(const std::vector<Covector>& start) const {
    double change = 0.0;
    if (parts_ == 1) {
      for (int k = 0; k < 6; ++k) {
        change += ends_[0].covector[k] * twist_unit_[k] * residual_[static_cast<std::size_t>(k)];
      }
    }
    return squared_length(start[0], weights_) + 2.0 * change;
  }

  /// The largest entry of a step, in the units of covectors.
  double largest(const std::vector<Covector>& step) const {
    double out = 0.0;
    for (const Covector& part : step) {
      for (int k = 0; k < 6; ++k) out = std::max(out, std::fabs(part[k]) / covector_unit_[k]);
    }
    return out;
  }

 private:
  void put(const Block& block, std::size_t row, std::size_t column, const Vector<6>& row_unit) {
    const std::size_t n = 6 * parts_;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        matrix_[(6 * row + static_cast<std::size_t>(i)) * n + 6 * column + static_cast<std::size_t>(j)] =
            block(i, j) * covector_unit_[j] / row_unit[i];
      }
    }
  }

  lie::Se3 target_;
  Weights weights_;
  std::size_t parts_;
  Vector<6> twist_unit_, covector_unit_;
  std::vector<GeodesicEnd> ends_;
  std::vector<double> residual_, matrix_, solution_;
};

}  // namespace

Shot shoot(const lie::Se3& target, const std::vector<Covector>& guess, const Weights& weights, double size) {
  constexpr int most_iterations = 40;
  constexpr double longest_step = 1.0;
  constexpr double quadratic = 1e-7;  ///< one more step from here leaves what rounding does
  Shot shot;
  std::vector<Covector> start = guess, next = guess;
  Shooting shooting(target, weights, guess.size(), size);
  Accuracy accuracy = Accuracy::coarse;
  double residual = shooting.evaluate(start, accuracy);
  for (; shot.iterations < most_iterations; ++shot.iterations) {
    if (!std::isfinite(residual)) return shot;
    if (accuracy == Accuracy::coarse && residual < 1e-4) {
      accuracy = Accuracy::fine;
      residual = shooting.evaluate(start, accuracy);
    }
    std::vector<Covector> newton = shooting.step();
    double largest = newton.empty() ? HUGE_VAL : shooting.largest(newton);
    const bool small = accuracy == Accuracy::fine && residual < quadratic;
    if (guess.size() == 1 && !(largest < (small ? 1e-3 : longest_step))) {
      newton = shooting.cautious_step(small ? 1e-3 : longest_step);
      largest = shooting.largest(newton);
    }
    if (!std::isfinite(largest)) return shot;
    double share = std::min(1.0, longest_step / largest);
    const auto move = [&] {
      for (std::size_t i = 0; i < start.size(); ++i) next[i] = start[i] + share * newton[i];
    };
    move();
    if (small && largest < 1e-3) {
      shot.converged = true;
      shot.squared = guess.size() == 1 ? shooting.squared(start) : squared_length(next[0], weights);
      shot.parts = std::move(next);
      return shot;
    }
    double there = shooting.evaluate(next, accuracy);
    while (!(there < (1.0 - 0.1 * share) * residual)) {
      share *= 0.5;
      if (share < 1e-3) return shot;
      move();
      there = shooting.evaluate(next, accuracy);
    }
    std::swap(start, next);
    residual = there;
  }
  return shot;
}

}  // namespace bowstring::geodesics
