// Words for combinations of rigid motions.

#include <cmath>
#include <cstdio>

#include "core/check/free_motions.hpp"

namespace bowstring::checking {

namespace {

constexpr double same = 1e-6;

std::string number(double value, double scale) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", std::fabs(value) <= same * scale ? 0.0 : value);
  return text;
}

std::string numbers(const Vector3& v, int dimension, double scale) {
  std::string out = "(";
  for (int k = 0; k < dimension; ++k) out += (k > 0 ? ", " : "") + number(v[k], scale);
  return out + ")";
}

/// "x", or "(0.6, 0.8, 0)".
std::string axis_name(const Vector3& v, int dimension) {
  Vector3 unit = normalized(v);
  int longest = 0;
  for (int k = 1; k < dimension; ++k) longest = std::fabs(unit[k]) > std::fabs(unit[longest]) ? k : longest;
  if (unit[longest] < 0.0) unit = -unit;
  for (int k = 0; k < dimension; ++k) {
    if (std::fabs(unit[k] - 1.0) <= same) return std::string(1, "xyz"[k]);
  }
  return numbers(unit, dimension, 1.0);
}

Eigen::Vector3d eigen(const Vector3& v) { return {v[0], v[1], v[2]}; }
Vector3 vector(const Eigen::Vector3d& v) { return {{v[0], v[1], v[2]}}; }

std::string translations(const Body& body, const Eigen::MatrixXd& modes, int dimension) {
  if (modes.cols() == 0) return "";
  if (modes.cols() == dimension) return "translations along every axis";
  if (modes.cols() == 1) return "a translation along " + axis_name(body.shift(modes.col(0)), dimension);
  const Vector3 normal = cross(body.shift(modes.col(0)), body.shift(modes.col(1)));
  return "translations across " + axis_name(normal, dimension);
}

/// The point that all the rotations leave where it is: v = ω × (centre − p) for each; false where there is none.
bool common_point(const Body& body, const Eigen::MatrixXd& modes, Vector3& out) {
  Eigen::MatrixXd a(3 * modes.cols(), 3);
  Eigen::VectorXd b(3 * modes.cols());
  for (Eigen::Index k = 0; k < modes.cols(); ++k) {
    const Matrix3 h = hat(body.turn(modes.col(k)));
    const Eigen::Vector3d v = eigen(body.shift(modes.col(k)));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a(3 * k + i, j) = -body.radius() * h(i, j);
      b[3 * k + i] = body.radius() * v[i];
    }
  }
  const Eigen::Vector3d offset = a.completeOrthogonalDecomposition().solve(b);
  out = body.centre() + vector(offset);
  return (a * offset - b).norm() <= same * (body.radius() + b.norm());
}

std::string rotations(const Body& body, const Eigen::MatrixXd& modes, int dimension, bool translates) {
  if (modes.cols() == 0) return "";
  std::string out;
  if (dimension == 2) {
    out = "a rotation";
  } else if (modes.cols() == 1) {
    out = "a rotation about " + axis_name(body.turn(modes.col(0)), 3);
  } else if (modes.cols() == 2) {
    out = "rotations about every axis across " + axis_name(cross(body.turn(modes.col(0)), body.turn(modes.col(1))), 3);
  } else {
    out = "rotations about every axis";
  }
  Vector3 point;
  if (translates || !common_point(body, modes, point)) return out;
  return out + (dimension == 2 ? " about " : " through ") + numbers(point, dimension, body.radius()) + " mm";
}

}  // namespace

Eigen::MatrixXd translations_among(const Body& body, const Eigen::MatrixXd& motions) {
  Eigen::MatrixXd turns(3, motions.cols());
  for (Eigen::Index k = 0; k < motions.cols(); ++k) turns.col(k) = body.radius() * eigen(body.turn(motions.col(k)));
  return null_space(turns, same);
}

std::string describe_motions(const Body& body, const Eigen::MatrixXd& modes, int dimension) {
  const Eigen::MatrixXd shifting = translations_among(body, modes);
  const Eigen::MatrixXd turning = null_space(shifting.transpose(), 0.5);
  const std::string first = translations(body, modes * shifting, dimension);
  const std::string second = rotations(body, modes * turning, dimension, shifting.cols() > 0);
  return first + (first.empty() || second.empty() ? "" : " and ") + second;
}

}  // namespace bowstring::checking
