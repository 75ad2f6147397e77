#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "core/check/motion.hpp"

namespace bowstring::checking {

/// Sets of curves that equality rows tie together.
std::vector<std::vector<int>> bodies(const Assembly& assembly);

/// Curves that move as one body, and the candidates for motions that nothing resists: translations, rotations about the
/// centre, turns of each curve's frames about its tangent. A candidate moves the farthest point, or a point as far from
/// a tangent, by 1 mm per unit.
class Body {
 public:
  Body(Assembly& assembly, const Mover& mover, const std::vector<double>& q, std::vector<int> curves);

  const std::vector<int>& curves() const noexcept { return curves_; }
  /// Why the candidates could not be had.
  const Status& status() const noexcept { return status_; }
  int candidates() const noexcept { return static_cast<int>(rate_.size()); }
  double radius() const noexcept { return radius_; }
  const Vector3& centre() const noexcept { return centre_; }

  /// Rates of all tangent numbers under a combination of candidates.
  std::vector<double> rate(const Eigen::VectorXd& coefficients) const;
  /// The state after the exact motion: a screw, and turns about tangents.
  Status moved(const Eigen::VectorXd& coefficients, double t, std::vector<double>& out) const;
  /// ω (rad per unit) and v (mm per unit) of a combination: x' = ω × (x − centre) + v.
  Vector3 turn(const Eigen::VectorXd& coefficients) const;
  Vector3 shift(const Eigen::VectorXd& coefficients) const;

  /// Orthonormal combinations under which nothing that is held moves and no equality row changes, without those that
  /// move nothing. Columns.
  Eigen::MatrixXd admissible(const std::vector<double>& jacobian) const;

 private:
  Eigen::VectorXd metric() const;

  Assembly& assembly_;
  const Mover& mover_;
  const std::vector<double>& q_;
  std::vector<int> curves_, spinning_;
  std::vector<Vector3> turn_, shift_;  // per rigid candidate
  std::vector<std::vector<double>> rate_;
  Vector3 centre_;
  double radius_ = 1.0;
  Status status_;
};

/// Columns: an orthonormal basis of the vectors that a matrix takes to less than `tolerance` times its largest singular
/// value, or times 1 where that is less.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& matrix, double tolerance);

/// Combinations of columns of `motions` (of the body's candidates) that turn nothing. Columns.
Eigen::MatrixXd translations_among(const Body& body, const Eigen::MatrixXd& motions);

/// "translations along every axis and rotations about every axis", "a rotation about z through (0, 0, 0) mm". Columns
/// of `modes` are combinations of the body's candidates that move nodes.
std::string describe_motions(const Body& body, const Eigen::MatrixXd& modes, int dimension);

}  // namespace bowstring::checking
