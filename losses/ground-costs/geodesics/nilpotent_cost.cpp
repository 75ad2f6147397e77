#include "nilpotent_cost.hpp"

#include <algorithm>
#include <cmath>

#include "nilpotent_distance.hpp"

namespace bowstring::geodesics {
namespace {

constexpr double pi = 3.14159265358979323846;

NilpotentOffset offset_of(const Vector3& omega, const Vector3& nu) noexcept {
  return {nu[0], {{omega[2], -omega[1]}}, {{nu[1], nu[2]}}};
}

/// J_l⁻¹(ω) x with c of J_r⁻¹.
Vector3 straightened(const Vector3& omega, double c, const Vector3& x) noexcept {
  const Vector3 turned = cross(omega, x);
  return x - 0.5 * turned + c * cross(omega, turned);
}

/// −J_l(ξ)⁻ᵀ g: the derivative by δ of f(Log(Exp(−δ) Exp ξ)) with ∂f/∂ξ = g. J_l = [J 0; Q J].
Vector<6> by_first_place(const Vector3& omega, const Vector3& nu, const Vector<6>& g) noexcept {
  const lie::se3::Twist twist = lie::se3::twist(omega, nu);
  const Matrix3 q = lie::se3::left_jacobian(twist).block<3, 3>(3, 0);
  const Matrix3 inverse = lie::left_jacobian_inverse(omega).transpose();
  const Vector3 linear = inverse * lie::se3::linear(g);
  const Vector3 angular = inverse * (lie::se3::angular(g) - q.transpose() * linear);
  return -lie::se3::twist(angular, linear);
}

}  // namespace

NilpotentCost nilpotent_cost(const lie::Se3& target, double roll_squared, bool with_gradient) noexcept {
  Vector3 omega = lie::log(target.rotation);
  const double angle_squared = norm_squared(omega);
  Vector3 nu = straightened(omega, lie::inverse_jacobian_coefficients(angle_squared).c, target.position);
  NilpotentSolution solution = nilpotent_distance(offset_of(omega, nu));
  double squared = solution.squared + roll_squared * omega[0] * omega[0];

  // The other branch turns by 2π − θ the other way and costs at least min(ρ, 1)²(2π − θ)².
  const double angle = std::sqrt(angle_squared), other_angle = 2.0 * pi - angle;
  if (angle > 1e-6 && std::min(1.0, roll_squared) * other_angle * other_angle < squared) {
    const Vector3 other = -other_angle / angle * omega;
    const double c = lie::inverse_jacobian_coefficients(other_angle * other_angle).c;
    const Vector3 other_nu = straightened(other, c, target.position);
    const double roll = roll_squared * other[0] * other[0];
    const NilpotentSolution there = nilpotent_distance(offset_of(other, other_nu), squared - roll);
    if (there.squared + roll < squared) {
      omega = other, nu = other_nu, solution = there;
      squared = there.squared + roll;
    }
  }
  NilpotentCost out{squared, {}};
  if (with_gradient) {
    const Vector<6> by_twist{{2.0 * roll_squared * omega[0], -solution.by_bend[1], solution.by_bend[0],
                              solution.by_forward, 2.0 * solution.dual[0], 2.0 * solution.dual[1]}};
    out.gradient = by_first_place(omega, nu, by_twist);
  }
  return out;
}

}  // namespace bowstring::geodesics
