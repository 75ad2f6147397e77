#include "first_guesses.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring::geodesics {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A unit vector across `axis`, in the direction of `v` where that has one.
Vector3 across(const Vector3& v, const Vector3& axis) noexcept {
  Vector3 out = v - dot(v, axis) * axis;
  double length = norm(out);
  if (length < 1e-9) {
    const int smallest = std::fabs(axis[0]) < 0.6 ? 0 : 1;
    out = Vector3::unit(smallest) - axis[smallest] * axis;
    length = norm(out);
  }
  return out / length;
}

/// The rotation about the unit vector `axis`.
lie::Rotation about(const Vector3& axis, double angle) noexcept { return lie::exp(angle * axis); }

/// One turn of the far field: `tangent` at its outer end.
struct Turn {
  double behind, twist;  ///< along p̂; of frames about p̂
  Vector3 sideways;
  double angle;     ///< between `tangent` and p̂
  Vector3 outward;  ///< unit, across p̂, toward `tangent`
};

Turn turn_of(const Vector3& tangent, const Vector3& direction, double charge, double c, bool first) noexcept {
  Turn out;
  const double u = std::clamp(dot(tangent, direction), -1.0, 1.0), span = std::max(1.0 + u, 1e-12);
  const double ratio = std::clamp(charge / (c * span), -1.0, 1.0), middle = std::clamp(0.5 * charge / c, -1.0, 1.0);
  const double s = c * span * std::sqrt(1.0 - ratio * ratio);
  out.behind = 2.0 * c * std::sqrt(1.0 - middle * middle) - s;
  const Vector3 sideways = tangent - u * direction;
  const double sign = first ? 1.0 : -1.0;
  out.sideways = (s * sideways + sign * charge * cross(direction, tangent)) / span;
  out.twist = std::asin(ratio) - std::asin(middle);
  out.outward = across(tangent, direction);
  out.angle = std::atan2(norm(sideways), u);
  return out;
}

}  // namespace

NilpotentOffset nilpotent_offset(const lie::se3::Twist& twist) noexcept {
  return {twist[3], {{twist[2], -twist[1]}}, {{twist[4], twist[5]}}};
}

namespace {

/// ψ by its part along λ* and the rest, and the covector that (a₀, b₀) gives.
struct DualAxes {
  double mu, along;
  Vector2 n, rest;

  DualAxes(const NilpotentOffset& offset, const NilpotentSolution& solution) noexcept : mu(norm(solution.dual)) {
    n = mu > 0.0 ? solution.dual / mu : Vector2{{1.0, 0.0}};
    along = dot(offset.bend, n);
    rest = offset.bend - along * n;
  }
  Covector covector(double a, double b, double roll_moment, const Vector2& dual) const noexcept {
    const Vector2 q = b * n + rest;
    return {{roll_moment, -q[1], q[0], a, dual[0], dual[1]}};
  }
};

}  // namespace

Covector nilpotent_covector(const lie::se3::Twist& twist, const NilpotentSolution& solution,
                            const Weights& weights) noexcept {
  const NilpotentOffset offset = nilpotent_offset(twist);
  const DualAxes axes(offset, solution);
  const double half = 0.5 * axes.mu;
  if (solution.distance_to_pole < 1e-4) {
    // k is large and what it multiplies small; the squared distance knows their product.
    return nilpotent_covector(twist, solution, weights, std::atan2(axes.along, offset.forward) + half);
  }
  const double k = half > 0.0 ? half / std::sin(half) : 1.0;
  return axes.covector(k * (offset.forward * std::cos(half) - axes.along * std::sin(half)),
                       k * (offset.forward * std::sin(half) + axes.along * std::cos(half)),
                       weights.roll_squared * twist[0], solution.dual);
}

Covector nilpotent_covector(const lie::se3::Twist& twist, const NilpotentSolution& solution, const Weights& weights,
                            double phase) noexcept {
  const DualAxes axes(nilpotent_offset(twist), solution);
  const double amplitude = std::sqrt(std::max(0.0, solution.squared - norm_squared(axes.rest)));
  return axes.covector(amplitude * std::cos(phase), amplitude * std::sin(phase), weights.roll_squared * twist[0],
                       solution.dual);
}

Covector one_parameter_covector(const lie::se3::Twist& twist, const Weights& weights) noexcept {
  const double lateral = 1.0 / weights.lateral_compliance;
  return {{weights.roll_squared * twist[0], twist[1], twist[2], twist[3], lateral * twist[4], lateral * twist[5]}};
}

FarField far_field(const lie::Se3& target, const Weights& weights, bool backward, int turns) noexcept {
  FarField field;
  const double c_squared = 1.0 - weights.lateral_compliance;
  if (!(c_squared > 0.01)) return field;
  const double c = std::sqrt(c_squared), side = backward ? -1.0 : 1.0;
  const Vector3 first = side * Vector3::unit(0), last = side * target.rotation.first_axis();
  Vector3 drive = target.position - c * (first + last);
  double charge = 0.0;
  constexpr int most_passes = 60;
  for (int pass = 0; pass < most_passes; ++pass) {
    const double drive_length = norm(drive);
    if (!(drive_length > 1e-6)) return field;
    const Vector3 direction = drive / drive_length;
    const Turn in = turn_of(first, direction, charge, c, true), out = turn_of(last, direction, charge, c, false);
    const Vector3 next = target.position - in.sideways - out.sideways;
    const double length = dot(next, direction) + in.behind + out.behind;
    if (!(length > 0.0)) return field;
    const lie::Rotation turn_in = about(direction, in.twist) * about(cross(in.outward, direction), in.angle);
    const lie::Rotation turn_out = about(cross(direction, out.outward), out.angle) * about(direction, out.twist);
    const lie::Rotation left = (turn_out * turn_in).inverse() * target.rotation;
    double roll = 2.0 * std::atan2(left.x, left.w);
    roll = std::remainder(roll, 2.0 * pi) + 2.0 * pi * turns;
    const double next_charge = side * weights.roll_squared * roll / length;
    const double change = norm(next - drive) + std::fabs(next_charge - charge) * drive_length;
    // `next` is p̂ times the length of the straight part, and what is across it the error of p̂.
    const double limit = 0.8 * c;
    drive = next;
    charge = std::clamp(next_charge, -limit, limit);
    field.direction = direction;
    field.length = length;
    field.charge = charge;
    field.roll = roll;
    if (change < 1e-15 * (1.0 + drive_length)) break;
  }
  field.exists = true;
  field.squared = field.length * field.length + field.roll * field.roll * weights.roll_squared;
  field.start = far_field_guess(target, weights, field, backward, 1)[0];
  return field;
}

std::vector<Covector> far_field_guess(const lie::Se3& target, const Weights& weights, const FarField& field,
                                      bool backward, int parts) {
  const double c = std::sqrt(1.0 - weights.lateral_compliance), side = backward ? -1.0 : 1.0;
  const Vector3& direction = field.direction;
  const double length = field.length, moment_roll = weights.roll_squared * field.roll;
  const Turn in = turn_of(side * Vector3::unit(0), direction, field.charge, c, true);
  const Turn out = turn_of(side * target.rotation.first_axis(), direction, field.charge, c, false);
  std::vector<Covector> guess;
  for (int part = 0; part < parts; ++part) {
    const double time = static_cast<double>(part) / parts;
    const bool first_half = 2 * part <= parts;
    const Turn& turn = first_half ? in : out;
    const double past = length * c * (first_half ? time : 1.0 - time);
    const double angle = 2.0 * std::atan(std::tan(0.5 * std::min(turn.angle, pi - 1e-6)) * std::exp(-past));
    // Frames turn about outward × p̂ on the way in, about p̂ × outward on the way out.
    const Vector3 axis = cross(turn.outward, direction);
    const lie::Rotation frame = first_half ? about(axis, turn.angle - angle) * lie::about_first_axis(field.roll * time)
                                           : about(axis, turn.angle - angle) * target.rotation *
                                                 lie::about_first_axis(-field.roll * (1.0 - time));
    const Vector3 tangent = std::cos(angle) * direction + std::sin(angle) * turn.outward;
    const double span = 1.0 + std::cos(angle), s_squared = c * c * span * span - field.charge * field.charge;
    const double s = std::sqrt(std::max(0.0, s_squared));
    const double sense = first_half ? 1.0 : -1.0;
    const Vector3 rate =
        (sense * s * (direction - std::cos(angle) * tangent) + field.charge * cross(direction, tangent)) / span;
    const Vector3 angular = moment_roll * side * tangent + length * cross(tangent, rate);
    const lie::Rotation to_body = frame.inverse();
    guess.push_back(lie::se3::twist(to_body * angular, length * (to_body * direction)));
  }
  return guess;
}

}  // namespace bowstring::geodesics
