#include "geodesic_distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "first_guesses.hpp"
#include "nilpotent_distance.hpp"
#include "shooting.hpp"

namespace bowstring::geodesics {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Length of the one-parameter path of a rotation, turns weighed by ρ about the first axis.
double turn_cost(const Vector3& turn, const Weights& weights) noexcept {
  return std::sqrt(weights.roll_squared * turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
}

/// Turn e₁ to ±x̂ without roll, drive, turn the rest.
double turn_drive_turn(const lie::Se3& target, const Weights& weights, double side) noexcept {
  const double drive = norm(target.position);
  if (drive == 0.0) return turn_cost(lie::log(target.rotation), weights);
  const Vector3 direction = side / drive * target.position;
  const double angle = std::atan2(std::hypot(direction[1], direction[2]), direction[0]);
  Vector3 axis{{0.0, -direction[2], direction[1]}};
  const double length = norm(axis);
  axis = length > 0.0 ? axis / length : Vector3::unit(1);
  const lie::Rotation rest = lie::exp(angle * axis).inverse() * target.rotation;
  return angle + drive + turn_cost(lie::log(rest), weights);
}

/// Lower bounds by the isoperimetric inequality, from the lateral part in the frame at the start; see README.md.
double lateral_bound(const lie::Se3& target) noexcept {
  const Vector3& x = target.position;
  const double lateral = std::hypot(x[1], x[2]);
  if (lateral == 0.0) return 0.0;
  const Vector3 tangent = target.rotation.first_axis();
  const double latitude = std::asin(std::clamp((x[1] * tangent[1] + x[2] * tangent[2]) / lateral, -1.0, 1.0));
  const double dido = std::sqrt(2.0 * pi * lateral) - std::fabs(latitude);

  const double mean_slope = std::fabs(latitude) > 1e-4 ? (1.0 - std::cos(latitude)) / latitude : 0.5 * latitude;
  double low = 0.0, high = std::min(2.0, std::sqrt(4.0 * pi * (lateral + std::fabs(x[0] * mean_slope))));
  for (int pass = 0; pass < 8; ++pass) {
    const double length = 0.5 * (low + high);
    const double excess = length * length * length / (3.0 * std::sqrt(3.0));
    const double area = std::fabs(lateral - x[0] * mean_slope) - excess * std::fabs(mean_slope);
    const double closing = std::hypot(std::fabs(x[0]) + excess, latitude);
    const bool possible = area <= 0.0 || length + closing >= std::sqrt(4.0 * pi * area);
    (possible ? high : low) = length;
  }
  return std::max(dido, low);
}

class Search {
 public:
  Search(const lie::Se3& target, const Weights& weights)
      : target_(target), weights_(weights), bounds_(distance_bounds(target, weights)) {}

  GeodesicDistance run() {
    const double c_squared = 1.0 - weights_.lateral_compliance;
    rate_ = std::sqrt(std::fabs(c_squared));
    if (c_squared > 0.01) look_far();
    if (!found_far_alone_) look_near();
    if (weights_.roll_squared > heavy_roll) from_lighter_roll();
    if (!settled()) try_remedies();
    if (!best_.found) best_.failure = "no geodesic was found that reaches it";
    if (best_.found) check();
    return best_;
  }

 private:
  /// The best so far is between the bounds, up to what rounding does.
  bool settled() const noexcept {
    if (!best_.found) return false;
    const double distance = std::sqrt(best_.squared);
    return distance >= bounds_.lower * (1.0 - tolerance) && distance <= bounds_.upper * (1.0 + tolerance);
  }
  void check() {
    if (settled()) return;
    best_.found = false;
    best_.failure = "the geodesic that was found has length " + std::to_string(std::sqrt(best_.squared)) +
                    ", which is not within its certified bounds " + std::to_string(bounds_.lower) + " and " +
                    std::to_string(bounds_.upper);
  }

  void keep(double squared, const std::vector<Covector>& parts) {
    if (!(squared > 0.0) || (best_.found && squared >= best_.squared)) return;
    if (squared < bounds_.lower * bounds_.lower * (1.0 - 2.0 * tolerance)) return;
    best_.found = true;
    best_.squared = squared;
    best_.start = parts[0];
    best_parts_ = parts;
  }
  Shot attempt(const std::vector<Covector>& guess, const Weights& weights, double size) {
    ++best_.shots;
    return shoot(target_, guess, weights, std::min(size, bounds_.upper));
  }
  bool attempt(const std::vector<Covector>& guess, double size) {
    const Shot shot = attempt(guess, weights_, size);
    if (shot.converged) keep(shot.squared, shot.parts);
    return shot.converged;
  }
  double best() const noexcept { return best_.found ? std::sqrt(best_.squared) : bounds_.upper; }

  int parts_of(double length) const noexcept {
    return std::clamp(static_cast<int>(std::ceil(length * rate_ / 4.0)), 1, most_parts);
  }

  /// A far field tells a length to within about this.
  double error_of_far_field(double length) const noexcept { return 60.0 * std::exp(-rate_ * length); }

  void look_far() {
    FarField fields[2] = {far_field(target_, weights_, false, 0), far_field(target_, weights_, true, 0)};
    const auto least = [&](const FarField& field) {
      const double length = std::sqrt(field.squared);
      return length - error_of_far_field(length);
    };
    int order[2] = {0, 1};
    if (fields[1].exists && (!fields[0].exists || fields[1].squared < fields[0].squared)) std::swap(order[0], order[1]);
    for (const int k : order) {
      const FarField& field = fields[k];
      if (!field.exists || least(field) > best()) continue;
      follow(field, k == 1);
      // A roll of nearly half a turn may go either way.
      if (std::fabs(field.roll) > 2.6) {
        const FarField other = far_field(target_, weights_, k == 1, field.roll > 0.0 ? -1 : 1);
        if (other.exists && least(other) < best()) follow(other, k == 1);
      }
      if (best_.found && field.length * rate_ > 6.5) found_far_alone_ = true;
    }
  }
  void follow(const FarField& field, bool backward) {
    if (field.length * rate_ > 37.0) {
      keep(field.squared, {field.start});
      return;
    }
    attempt(far_field_guess(target_, weights_, field, backward, parts_of(field.length)), std::sqrt(field.squared));
  }

  /// The target as an exponential with a roll behind it, dilated: bends and forward motion by ε, lateral motion by ε².
  struct Chart {
    lie::se3::Twist twist;
    double roll = 0.0;

    Chart dilated(double factor) const noexcept {
      Chart out{factor * twist, factor * roll};
      for (int k = 4; k < 6; ++k) out.twist[k] *= factor;
      return out;
    }
    /// The same with all but the lateral motion times `share`.
    Chart lateral_first(double share) const noexcept {
      Chart out{share * twist, share * roll};
      for (int k = 4; k < 6; ++k) out.twist[k] = twist[k];
      return out;
    }
    lie::Se3 target() const noexcept {
      lie::Se3 out = lie::se3::exp(twist);
      out.rotation = out.rotation * lie::about_first_axis(roll);
      return out;
    }
    /// With the whole roll where the first guesses look for it.
    lie::se3::Twist for_guess() const noexcept {
      lie::se3::Twist out = twist;
      out[0] += roll;
      return out;
    }
  };

  /// The charts in which the nilpotent approximation may start: log, its other branch near half a turn, and the roll
  /// behind all bends, where the geodesic has it, which turns it at a constant rate.
  std::vector<Chart> charts() const {
    const lie::se3::Twist twist = lie::se3::log(target_);
    std::vector<Chart> out{{twist}};
    const Vector3 turn = lie::se3::angular(twist);
    const double angle = norm(turn);
    if (angle > 2.0) {
      const Vector3 other = (angle - 2.0 * pi) / angle * turn;
      out.push_back({lie::se3::twist(other, lie::left_jacobian_inverse(other) * target_.position)});
    }
    const double roll = std::remainder(2.0 * std::atan2(target_.rotation.x, target_.rotation.w), 2.0 * pi);
    if (std::fabs(roll) > 0.02) {
      lie::Se3 unrolled = target_;
      unrolled.rotation = target_.rotation * lie::about_first_axis(-roll);
      out.push_back({lie::se3::log(unrolled), roll});
    }
    return out;
  }

  void look_near() {
    for (const Chart& chart : charts()) near_chart(chart);
    if (weights_.lateral_compliance == 0.0) return;
    // Of little use where lateral motion is dear: its path goes sideways all the same.
    const Covector along = one_parameter_covector(lie::se3::log(target_), weights_);
    if (std::sqrt(squared_length(along, weights_)) < 1.5 * best()) attempt({along}, bounds_.upper);
  }

  void near_chart(const Chart& chart) {
    const lie::se3::Twist twist = chart.for_guess();
    const NilpotentSolution solution = nilpotent_distance(nilpotent_offset(twist));
    const double size = std::sqrt(solution.squared + weights_.roll_squared * twist[0] * twist[0]);
    if (size > 1.3 * best() + 0.1) return;
    const Shot shot = attempt(std::vector<Covector>{nilpotent_covector(twist, solution, weights_)}, weights_, size);
    if (shot.converged) keep(shot.squared, shot.parts);
    const bool as_expected =
        shot.converged && std::fabs(std::sqrt(shot.squared) - size) < (size < 1.0 ? 0.1 : 0.05) * size;
    // Near |λ*| = 2π the phase is open as far as the offset other than lateral is smaller than what the approximation
    // leaves out.
    const bool open_phase = solution.distance_to_pole < std::min(0.15, 0.2 * size * size);
    if (open_phase) {
      for (int quarter = 0; quarter < 4; ++quarter) {
        attempt({nilpotent_covector(twist, solution, weights_, 0.5 * pi * quarter)}, size);
      }
    }
    if (size < 0.3) return;
    if (!as_expected) {
      const double first = std::min(0.7, 0.5 / size);
      const auto path = [&](double s) { return chart.dilated(first + (1.0 - first) * s); };
      const Chart begin = path(0.0);
      const NilpotentSolution at_first = nilpotent_distance(nilpotent_offset(begin.for_guess()));
      follow_path(path, nilpotent_covector(begin.for_guess(), at_first, weights_), size * first, size);
    }
    if (open_phase) {
      const Chart lateral = chart.lateral_first(0.0);
      const NilpotentSolution at_first = nilpotent_distance(nilpotent_offset(lateral.for_guess()));
      for (int half = 0; half < 2; ++half) {
        follow_path([&](double s) { return chart.lateral_first(s); },
                    nilpotent_covector(lateral.for_guess(), at_first, weights_, pi * half), size, size);
      }
    }
  }

  /// Continuation in the target, from a covector near to that of path(0), with steps that adapt.
  template <class Path>
  void follow_path(const Path& path, const Covector& guess, double first_size, double last_size) {
    ++best_.shots;
    Shot at = shoot(path(0.0).target(), {guess}, weights_, first_size);
    if (!at.converged) return;
    Covector now = at.parts[0], rate;
    double s = 0.0, step = 0.25;
    bool has_rate = false;
    while (s < 1.0) {
      step = std::min(step, 1.0 - s);
      const double next = s + step;
      const double size = first_size + (last_size - first_size) * next;
      ++best_.shots;
      at = shoot(path(next).target(), {has_rate ? now + step * rate : now}, weights_, size);
      if (!at.converged || norm(at.parts[0] - now) > 0.5 * norm(now)) {
        step *= 0.5;
        if (step < 0.02) return;
        continue;
      }
      rate = (at.parts[0] - now) / step;
      has_rate = true;
      now = at.parts[0];
      s = next;
      if (at.iterations < 5) step *= 1.5;
    }
    keep(at.squared, {now});
  }

  void try_remedies() {
    // Geodesics of other far fields: what the first look left out, and whole turns of roll either way.
    if (1.0 - weights_.lateral_compliance > 0.01) {
      for (const bool backward : {false, true}) {
        for (int turns = -1; turns <= 1; ++turns) {
          const FarField field = far_field(target_, weights_, backward, turns);
          if (field.exists) follow(field, backward);
        }
      }
    }
    if (!settled()) from_isotropic();
  }

  /// Continuation in ρ² from a roll that costs no more than a bend: where it costs more, geodesics roll by going round,
  /// of which the first guesses know nothing.
  void from_lighter_roll() {
    Search lighter(target_, {1.0, weights_.lateral_compliance});
    const GeodesicDistance first = lighter.run();
    best_.shots += first.shots;
    if (!first.found) return;
    std::vector<Covector> now = lighter.best_parts_;
    // The far field alone has no parts to go on from.
    if (parts_of(std::sqrt(first.squared)) > static_cast<int>(now.size()) && now.size() == 1 &&
        std::sqrt(first.squared) * rate_ > 37.0) {
      return;
    }
    const double log_roll = std::log(weights_.roll_squared);
    double s = 0.0, step = std::min(1.0, 0.4 / log_roll);
    while (s < 1.0) {
      step = std::min(step, 1.0 - s);
      const bool last = s + step >= 1.0;
      const double roll_squared = last ? weights_.roll_squared : std::exp((s + step) * log_roll);
      const Shot at = attempt(now, {roll_squared, weights_.lateral_compliance}, bounds_.upper);
      if (!at.converged) {
        step *= 0.5;
        if (step < 1e-2 / log_roll) return;
        continue;
      }
      now = at.parts;
      s += step;
      if (at.iterations < 5) step *= 1.5;
    }
    keep(squared_length(now[0], weights_), now);
  }

  /// Continuation in the weights, from the metric whose geodesics have closed forms.
  void from_isotropic() {
    const Vector3 turn = lie::log(target_.rotation);
    const int parts = parts_of(norm(target_.position));
    std::vector<Covector> now;
    for (int part = 0; part < parts; ++part) {
      const Vector3 force = lie::exp(-static_cast<double>(part) / parts * turn) * target_.position;
      now.push_back(lie::se3::twist(turn, force));
    }
    // κ = 0 is far away in the logarithm, and there is nothing to see below 1e-4.
    const double log_kappa = std::log(std::max(weights_.lateral_compliance, 1e-4));
    const double log_roll = std::log(weights_.roll_squared);
    double s = 0.0, step = 0.1;
    while (s < 1.0) {
      step = std::min(step, 1.0 - s);
      const bool last = s + step >= 1.0;
      const Weights between{std::exp((s + step) * log_roll), std::exp((s + step) * log_kappa)};
      const Shot at = attempt(now, last && weights_.lateral_compliance > 0.0 ? weights_ : between, bounds_.upper);
      if (!at.converged) {
        step *= 0.5;
        if (step < 1e-3) return;
        continue;
      }
      now = at.parts;
      s += step;
      step *= 1.5;
    }
    if (weights_.lateral_compliance > 0.0) {
      keep(squared_length(now[0], weights_), now);
    } else {
      attempt(now, bounds_.upper);
    }
  }

  static constexpr double tolerance = 1e-9;
  static constexpr double heavy_roll = 2.0;
  const lie::Se3 target_;
  const Weights weights_;
  const DistanceBounds bounds_;
  double rate_ = 1.0;
  bool found_far_alone_ = false;
  GeodesicDistance best_;
  std::vector<Covector> best_parts_;
};

/// The covector at the end of a geodesic from the identity: momenta in space are constant.
Covector covector_at(const lie::Se3& end, const Covector& start) noexcept {
  const lie::Rotation to_body = end.rotation.inverse();
  return lie::se3::twist(to_body * (moment(start) - cross(end.position, force(start))), to_body * force(start));
}

/// Of a target and its inverse, the one that is searched: both have one distance, and so they get one number.
bool searched_by_inverse(const lie::Se3& target) noexcept {
  const lie::se3::Twist twist = lie::se3::log(target);
  int largest = 0;
  for (int k = 1; k < 6; ++k) {
    if (std::fabs(twist[k]) > std::fabs(twist[largest])) largest = k;
  }
  return twist[largest] < 0.0;
}

}  // namespace

DistanceBounds distance_bounds(const lie::Se3& target, const Weights& weights) noexcept {
  DistanceBounds out;
  out.upper = std::min(turn_drive_turn(target, weights, 1.0), turn_drive_turn(target, weights, -1.0));
  const lie::Se3 inverse = target.inverse();
  out.upper = std::min({out.upper, turn_drive_turn(inverse, weights, 1.0), turn_drive_turn(inverse, weights, -1.0)});
  if (weights.lateral_compliance > 0.0) {
    const lie::se3::Twist twist = lie::se3::log(target);
    const double lateral = (twist[4] * twist[4] + twist[5] * twist[5]) / weights.lateral_compliance;
    const double turn = turn_cost(lie::se3::angular(twist), weights);
    out.upper = std::min(out.upper, std::sqrt(turn * turn + twist[3] * twist[3] + lateral));
  }
  out.lower = lower_bound(target, weights);
  return out;
}

double lower_bound(const lie::Se3& target, const Weights& weights) noexcept {
  const Vector3& x = target.position;
  const double turn = norm_squared(lie::log(target.rotation));
  const Vector3 difference = target.rotation.first_axis() - Vector3::unit(0);
  const double shift = weights.lateral_compliance > 1.0 ? 1.0 / weights.lateral_compliance : 1.0;
  const double plain = shift * norm_squared(x) + std::min(1.0, weights.roll_squared) * turn;
  if (weights.lateral_compliance > 0.0) return std::sqrt(plain);
  const double along = std::max(norm_squared(x + difference), norm_squared(x - difference));
  return std::max({std::sqrt(std::max(plain, along)), lateral_bound(target), lateral_bound(target.inverse())});
}

GeodesicDistance isotropic_distance(const lie::Se3& target) noexcept {
  GeodesicDistance out;
  const Vector3 turn = lie::log(target.rotation);
  out.found = true;
  out.squared = norm_squared(target.position) + norm_squared(turn);
  out.start = lie::se3::twist(turn, target.position);
  return out;
}

GeodesicDistance geodesic_distance(const lie::Se3& target, const Weights& weights) {
  if (weights.lateral_compliance == 1.0 && weights.roll_squared == 1.0) return isotropic_distance(target);
  if (norm_squared(target.position) == 0.0 && norm_squared(lie::log(target.rotation)) == 0.0) {
    GeodesicDistance none;
    none.found = true;
    return none;
  }
  if (!searched_by_inverse(target)) return Search(target, weights).run();
  GeodesicDistance out = Search(target.inverse(), weights).run();
  if (out.found) out.start = -covector_at(target.inverse(), out.start);
  return out;
}

}  // namespace bowstring::geodesics
