#include "core/contact/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/gap.hpp"

namespace bowstring::contact {
namespace {

constexpr int dense_samples = 16;
constexpr int check_samples = 20;
constexpr double slide_limit = 10.0;  // how far σ may move per step of the wire, as lengths

double chord_length(const WirePolyline& wire, int segment, int dimension) noexcept {
  double sum = 0.0;
  for (int k = 0; k < dimension; ++k) {
    const double* p = wire.points + segment * dimension + k;
    sum += (p[dimension] - p[0]) * (p[dimension] - p[0]);
  }
  return std::sqrt(sum);
}

double radius_at(const WirePolyline& wire, int segment, double t) noexcept {
  return wire.radius ? (1.0 - t) * wire.radius[segment] + t * wire.radius[segment + 1] : 0.0;
}

/// One point of the wire and the place on the vessel that it is measured from.
class Follower {
 public:
  explicit Follower(const Centerline& vessel) noexcept : vessel_(vessel) {
    vessel_.interpolation = Interpolation::spline;
  }

  void begin(const double* x, double wire_radius, std::optional<double> start) noexcept {
    const GapShape shape{GapForm::squared, wire_radius};
    closest_ = start ? closest(vessel_, x, shape, whole(vessel_), *start) : globally_closest(vessel_, x, shape);
    measure(x);
  }

  /// Follows the wire to x, `step` mm from the point before.
  void move(const double* x, double wire_radius, double step) noexcept {
    const double reach = speed_ > 0.0 ? slide_limit * step / speed_ : vessel_.nodes;
    const double sigma = closest_.at.sigma();
    closest_ = closest(vessel_, x, {GapForm::squared, wire_radius}, {sigma - reach, sigma + reach}, sigma);
    measure(x);
  }

  double depth() const noexcept { return distance_ - closest_.clearance; }
  double distance() const noexcept { return distance_; }
  double sigma() const noexcept { return closest_.at.sigma(); }

 private:
  void measure(const double* x) noexcept {
    const CurvePoint q = segment_polynomial(vessel_, closest_.at.segment, x).at(closest_.at.u);
    double speed2 = 0.0, along = 0.0;
    for (int k = 0; k < 3; ++k) {
      speed2 += q.slope[k] * q.slope[k];
      along += q.slope[k] * q.position[k];
    }
    speed_ = std::sqrt(speed2);
    distance_ = closest_.distance;
    if (closest_.location == Location::curve_end && speed2 > 0.0) {
      distance_ = std::sqrt(std::max(0.0, distance_ * distance_ - along * along / speed2));
    }
  }

  Centerline vessel_;
  ClosestPoint closest_;
  double speed_ = 0.0;     // |q'|, mm per edge
  double distance_ = 0.0;  // from the centerline, beyond an end from its straight continuation
};

/// Calls `visit` with every sample along the wire.
template <class Visit>
void follow(const Centerline& vessel, const WirePolyline& wire, int samples_per_segment, std::optional<double> start,
            Visit&& visit) noexcept {
  const int dim = vessel.dimension;
  Follower follower(vessel);
  follower.begin(wire.points, radius_at(wire, 0, 0.0), start);
  visit(Penetration{follower.depth(), 0.0, 0, 0.0, follower.sigma(), follower.distance()});
  double arc = 0.0;
  for (int segment = 0; segment + 1 < wire.nodes; ++segment) {
    const double length = chord_length(wire, segment, dim);
    const double* p = wire.points + segment * dim;
    for (int k = 1; k <= samples_per_segment; ++k) {
      const double t = static_cast<double>(k) / samples_per_segment;
      double x[3] = {};
      for (int i = 0; i < dim; ++i) x[i] = (1.0 - t) * p[i] + t * p[dim + i];
      follower.move(x, radius_at(wire, segment, t), length / samples_per_segment);
      visit(Penetration{follower.depth(), arc + t * length, segment, t, follower.sigma(), follower.distance()});
    }
    arc += length;
  }
}

/// Keeps the deepest sample; one that is not a number is kept for good.
void keep_deeper(Penetration& deepest, const Penetration& sample, bool first) noexcept {
  if (first || (!std::isnan(deepest.depth) && !(sample.depth <= deepest.depth))) deepest = sample;
}

}  // namespace

Penetration deepest_penetration(const Centerline& vessel, const WirePolyline& wire, int samples_per_segment,
                                std::optional<double> start) noexcept {
  Penetration deepest;
  bool first = true;
  follow(vessel, wire, samples_per_segment, start, [&](const Penetration& sample) {
    keep_deeper(deepest, sample, first);
    first = false;
  });
  return deepest;
}

Penetration max_penetration_dense(const Centerline& vessel, const WirePolyline& wire,
                                  std::optional<double> start) noexcept {
  return deepest_penetration(vessel, wire, dense_samples, start);
}

double crossing_allowance(const Centerline& vessel, const WirePolyline& wire) noexcept {
  double longest = 0.0;
  for (int i = 0; i + 1 < wire.nodes; ++i) {
    longest = std::max(longest, chord_length(wire, i, vessel.dimension));
  }
  const double lumen = *std::min_element(vessel.radius, vessel.radius + vessel.nodes);
  const double widest = wire.radius ? *std::max_element(wire.radius, wire.radius + wire.nodes) : 0.0;
  const double clearance = std::max(0.0, lumen - widest);
  const double curvature = largest_curvature(vessel.points, vessel.dimension, vessel.nodes).value;
  return std::min(curvature * longest * longest / 4.0, clearance) + clearance / 20.0;
}

CrossingCheck check_crossing(const Centerline& vessel, const WirePolyline& wire, std::optional<double> start) noexcept {
  CrossingCheck check;
  check.allowance = crossing_allowance(vessel, wire);
  bool first = true;
  follow(vessel, wire, check_samples, start, [&](const Penetration& sample) {
    const bool within = sample.depth <= check.allowance;
    if (!within && !check.crossed()) check.exit = sample;
    keep_deeper(check.deepest, sample, first);
    first = false;
  });
  return check;
}

}  // namespace bowstring::contact
