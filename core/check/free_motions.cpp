#include "core/check/free_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check/unknowns.hpp"
#include "core/lie/so3.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

constexpr double same = 1e-7;  // of rates, relative: motions that differ by less are one

}  // namespace

Eigen::MatrixXd null_space(const Eigen::MatrixXd& matrix, double tolerance) {
  const Eigen::Index n = matrix.cols();
  if (matrix.rows() == 0 || n == 0) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix.transpose() * matrix);
  const double largest = std::sqrt(std::max(0.0, eigen.eigenvalues()[n - 1]));
  const double limit = tolerance * std::max(1.0, largest);
  Eigen::Index count = 0;
  while (count < n && eigen.eigenvalues()[count] <= limit * limit) ++count;
  return eigen.eigenvectors().leftCols(count);
}

std::vector<std::vector<int>> bodies(const Assembly& assembly) {
  const Scene& scene = assembly.scene();
  std::vector<int> root(scene.curves.size());
  std::iota(root.begin(), root.end(), 0);
  for (const ConstraintUse& use : scene.constraints) {
    for (int r = 0; r < use.rows.rows; ++r) {
      if (use.rows.lower[at(r)] != use.rows.upper[at(r)]) continue;
      for (int p = use.rows.place_begin[at(r)] + 1; p < use.rows.place_begin[at(r) + 1]; ++p) {
        const int from = root[at(use.rows.places[at(p)].curve)];
        const int to = root[at(use.rows.places[at(use.rows.place_begin[at(r)])].curve)];
        std::replace(root.begin(), root.end(), from, to);
      }
    }
  }
  std::vector<std::vector<int>> out;
  for (int leader = 0; leader < static_cast<int>(root.size()); ++leader) {
    std::vector<int> curves;
    for (int c = 0; c < static_cast<int>(root.size()); ++c) {
      if (root[at(c)] == leader) curves.push_back(c);
    }
    if (!curves.empty()) out.push_back(curves);
  }
  return out;
}

Body::Body(Assembly& assembly, const Mover& mover, const std::vector<double>& q, std::vector<int> curves)
    : assembly_(assembly), mover_(mover), q_(q), curves_(std::move(curves)) {
  const int d = assembly.scene().dimension;
  for (const int curve : curves_) centre_ += mover.centre(q, curve) / static_cast<double>(curves_.size());
  for (const int curve : curves_) {
    radius_ = std::max({radius_, mover.radius(q, curve), norm(mover.centre(q, curve) - centre_)});
    if (mover.spins(curve)) spinning_.push_back(curve);
  }
  for (int k = 0; k < d; ++k) turn_.push_back({}), shift_.push_back(Vector3::unit(k));
  for (int k = d == 2 ? 2 : 0; k < 3; ++k) turn_.push_back(Vector3::unit(k) / radius_), shift_.push_back({});
  std::vector<double> own;
  for (std::size_t k = 0; k < turn_.size(); ++k) {
    rate_.emplace_back(assembly.free_of_unknown().size(), 0.0);
    for (const int curve : curves_) {
      status_ = mover.rate(q, curve, {turn_[k], shift_[k], centre_}, own);
      if (!status_.ok()) return;
      for (std::size_t u = 0; u < own.size(); ++u) rate_.back()[u] += own[u];
    }
  }
  for (const int curve : spinning_) {
    rate_.push_back(mover.spin_rate(curve));
    for (double& number : rate_.back()) number /= radius_;
  }
}

std::vector<double> Body::rate(const Eigen::VectorXd& coefficients) const {
  std::vector<double> out(rate_.front().size(), 0.0);
  for (std::size_t k = 0; k < rate_.size(); ++k) {
    for (std::size_t u = 0; u < out.size(); ++u) out[u] += coefficients[static_cast<Eigen::Index>(k)] * rate_[k][u];
  }
  return out;
}

Vector3 Body::turn(const Eigen::VectorXd& coefficients) const {
  Vector3 out;
  for (std::size_t k = 0; k < turn_.size(); ++k) out += coefficients[static_cast<Eigen::Index>(k)] * turn_[k];
  return out;
}

Vector3 Body::shift(const Eigen::VectorXd& coefficients) const {
  Vector3 out;
  for (std::size_t k = 0; k < shift_.size(); ++k) out += coefficients[static_cast<Eigen::Index>(k)] * shift_[k];
  return out;
}

Status Body::moved(const Eigen::VectorXd& coefficients, double t, std::vector<double>& out) const {
  RigidMotion motion;
  motion.turn = t * turn(coefficients);
  motion.shift = lie::left_jacobian(motion.turn) * (t * shift(coefficients));  // what Exp of the screw translates
  motion.centre = centre_;
  out = q_;
  std::vector<double> next;
  for (const int curve : curves_) {
    if (Status status = mover_.move(out, curve, motion, next); !status.ok()) return status;
    out = next;
  }
  for (std::size_t k = 0; k < spinning_.size(); ++k) {
    const double angle = t * coefficients[static_cast<Eigen::Index>(turn_.size() + k)] / radius_;
    mover_.spin(spinning_[k], angle, out);
  }
  return {};
}

/// Per tangent number: 1 for mm, the curve's mean edge length for rad.
Eigen::VectorXd Body::metric() const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(assembly_.free_of_unknown().size()));
  for (const FieldGroup& group : field_groups(assembly_)) {
    const CurveView& view = assembly_.scene().curves[at(group.curve)]->view;
    for (int i = group.entry_begin; i < group.entry_end; ++i) {
      const FieldEntry& entry = assembly_.entries()[at(i)];
      if (entry.manifold == Manifold::vector || entry.manifold == Manifold::real) continue;
      for (int k = 0; k < tangent_count(entry.manifold, entry.dimension); ++k) {
        out[entry.unknown + k] = view.arc[view.nodes - 1] / (view.nodes - 1);
      }
    }
  }
  return out;
}

Eigen::MatrixXd Body::admissible(const std::vector<double>& jacobian) const {
  const auto& free = assembly_.free_of_unknown();
  const auto all = static_cast<Eigen::Index>(free.size());
  const Eigen::VectorXd scale = metric();
  Eigen::MatrixXd moves(all, candidates()), held(all + assembly_.rows(), candidates());
  for (int k = 0; k < candidates(); ++k) {
    const std::vector<double>& rate = rate_[at(k)];
    for (Eigen::Index u = 0; u < all; ++u) {
      moves(u, k) = scale[u] * rate[at(static_cast<int>(u))];
      held(u, k) = free[at(static_cast<int>(u))] < 0 ? moves(u, k) : 0.0;
    }
    const SymmetricProduct rows = row_product(assembly_.jacobian_pattern(), jacobian, free_part(assembly_, rate));
    for (int r = 0; r < assembly_.rows(); ++r) {
      const bool equality = assembly_.row_lower()[at(r)] == assembly_.row_upper()[at(r)];
      held(all + r, k) = equality ? rows.value[at(r)] : 0.0;
    }
  }
  const Eigen::MatrixXd still = null_space(moves, same);
  const Eigen::MatrixXd moving = null_space(still.transpose(), 0.5);
  return moving * null_space(held * moving, same);
}

}  // namespace bowstring::checking
