#include "core/contact/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/connected.hpp"
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
struct Place {
  int segment = 0;
  double u = 0.0;
  double x[3] = {};
  double depth = 0.0, distance = 0.0;
  double gap = 0.0;          // squared form, ≥ depth
  double speed = 0.0;        // |q'|, mm per edge
  double along[3] = {};      // ∂σ/∂x
  bool stationary = false;   // the gap is least here, and σ moves with x
  bool approximate = false;  // σ to 1e-10 or better, instead of to rounding

  double sigma() const noexcept { return segment + u; }
};

/// φ in its squared form at a place, in terms of e = q − x: r = |e|².
struct Measured {
  double e[3] = {}, slope[3] = {};
  double r = 0.0, r1 = 0.0, r2 = 0.0, c = 0.0, c1 = 0.0, c2 = 0.0;
  double first = 0.0, second = 0.0;  // φ_σ, φ_σσ
};

/// Follows the place nearest to a point that moves.
template <int dim>
class Follower {
 public:
  explicit Follower(const Centerline& vessel) noexcept : vessel_(vessel), bounds_(tube_bounds(vessel)) {
    vessel_.interpolation = Interpolation::spline;
  }

  void begin(const double* x, double wire_radius, std::optional<double> start) noexcept {
    const GapShape shape{GapForm::squared, wire_radius};
    take(x, wire_radius,
         start ? closest(vessel_, x, shape, whole(vessel_), *start) : globally_closest(vessel_, x, shape));
  }

  /// Follows the wire to x, `step` mm from the point before.
  void move(const double* x, double wire_radius, double step) noexcept {
    if (glide(x, wire_radius, step)) return;
    const double reach = here_.speed > 0.0 ? slide_limit * step / here_.speed : vessel_.nodes;
    const double sigma = here_.sigma();
    take(x, wire_radius, closest(vessel_, x, {GapForm::squared, wire_radius}, {sigma - reach, sigma + reach}, sigma));
  }

  /// The same by a few steps of Newton's from where σ's derivative leads. False, and nothing has changed, where that
  /// is not sure to be the minimum that a search would descend to.
  bool glide(const double* x, double wire_radius, double step) noexcept {
    if (!here_.stationary) return false;
    int segment = here_.segment;
    double u = here_.u;
    for (int k = 0; k < dim; ++k) u += here_.along[k] * (x[k] - here_.x[k]);
    for (int i = 0; i < most_glides; ++i) {
      if (u < 0.0) {
        --segment, u += 1.0;
      } else if (u > 1.0) {
        ++segment, u -= 1.0;
      }
      if (!(u >= 0.0 && u <= 1.0 && segment >= 0 && segment < vessel_.segments())) return false;
      const Measured m = measure(segment, u, x, wire_radius);
      if (!(m.second > 0.0 && m.c > 0.0)) return false;
      const double more = -m.first / m.second;
      if (!(std::abs(more) <= longest_glide)) return false;
      u += more;
      if (std::abs(more) > glide_error) continue;
      const bool inside = (segment > 0 || u > 0.0) && (segment + 1 < vessel_.segments() || u < 1.0);
      const double moved = std::abs(segment + u - here_.sigma());
      if (!(inside && moved <= 1.0 && moved * here_.speed <= slide_limit * step)) return false;
      set(segment, u, x, m, more);
      return true;
    }
    return false;
  }

  /// Goes on from the lowest place that is connected to this one, where x is less deep there.
  void change_over(const double* x, double wire_radius) noexcept {
    const Place before = here_;
    const GapShape shape{GapForm::squared, wire_radius};
    const ClosestPoint from = gap_at(vessel_, x, shape, {before.segment, before.u});
    const ClosestPoint lowest = lowest_connected(vessel_, bounds_, x, shape, from);
    if (!(lowest.gap < from.gap)) return;
    take(x, wire_radius, lowest);
    if (!(here_.depth < before.depth)) here_ = before;
  }

  const Place& here() const noexcept { return here_; }
  void back_to(const Place& place) noexcept { here_ = place; }

  /// Depth, σ and distance to rounding where they have been approximated.
  void refine(Penetration& found, const double* x, double wire_radius) noexcept {
    const double sigma = found.vessel_coordinate;
    take(x, wire_radius,
         closest(vessel_, x, {GapForm::squared, wire_radius}, {sigma - longest_glide, sigma + longest_glide}, sigma));
    found.depth = here_.depth;
    found.vessel_coordinate = here_.sigma();
    found.distance = here_.distance;
  }

 private:
  static constexpr int most_glides = 4;
  static constexpr double longest_glide = 0.25;  // of a segment: farther from the guess there may be another minimum
  static constexpr double glide_error = 1e-5;    // of a segment, whose square Newton's step leaves

  void take(const double* x, double wire_radius, const ClosestPoint& found) noexcept {
    const Measured m = measure(found.at.segment, found.at.u, x, wire_radius);
    set(found.at.segment, found.at.u, x, m, 0.0);
    here_.stationary = found.location == Location::interior && m.second > 0.0 && m.c > 0.0;
    here_.approximate = false;
    here_.distance = found.distance;
    if (const double speed2 = here_.speed * here_.speed; found.location == Location::curve_end && speed2 > 0.0) {
      const double along = 0.5 * m.r1;
      here_.distance = std::sqrt(std::max(0.0, here_.distance * here_.distance - along * along / speed2));
    }
    here_.depth = here_.distance - found.clearance;
  }

  /// `more`: how far σ is from where it was measured.
  void set(int segment, double u, const double* x, const Measured& m, double more) noexcept {
    const double r = m.r + more * (m.r1 + 0.5 * more * m.r2), c = m.c + more * (m.c1 + 0.5 * more * m.c2);
    here_.segment = segment;
    here_.u = u;
    here_.distance = std::sqrt(std::max(0.0, r));
    here_.depth = here_.distance - c;
    here_.gap = (r - c * c) / (2.0 * c);
    double speed2 = 0.0;
    for (int k = 0; k < dim; ++k) {
      here_.x[k] = x[k];
      here_.along[k] = (m.slope[k] - m.e[k] * m.c1 / m.c) / (m.c * m.second);
      speed2 += m.slope[k] * m.slope[k];
    }
    here_.speed = std::sqrt(speed2);
    here_.stationary = here_.approximate = true;
  }

  Measured measure(int segment, double u, const double* x, double wire_radius) noexcept {
    const double* origin = vessel_.points + segment * dim;
    if (segment != polynomial_segment_) {
      polynomial_ = segment_polynomial(vessel_, segment, origin);
      polynomial_segment_ = segment;
    }
    Measured m;
    double speed2 = 0.0, bend = 0.0;
    for (int k = 0; k < dim; ++k) {
      const double a1 = polynomial_.position[1][k], a2 = polynomial_.position[2][k], a3 = polynomial_.position[3][k];
      m.e[k] = polynomial_.position[0][k] + u * (a1 + u * (a2 + u * a3)) - (x[k] - origin[k]);
      m.slope[k] = a1 + u * (2.0 * a2 + u * 3.0 * a3);
      m.r += m.e[k] * m.e[k];
      m.r1 += 2.0 * m.e[k] * m.slope[k];
      speed2 += m.slope[k] * m.slope[k];
      bend += m.e[k] * (2.0 * a2 + u * 6.0 * a3);
    }
    m.r2 = 2.0 * (speed2 + bend);
    const double* a = polynomial_.radius;
    m.c = a[0] + u * (a[1] + u * (a[2] + u * a[3])) - wire_radius;
    m.c1 = a[1] + u * (2.0 * a[2] + u * 3.0 * a[3]);
    m.c2 = 2.0 * a[2] + u * 6.0 * a[3];
    const double inverse = 1.0 / m.c, ratio = m.r * inverse * inverse, by_c = -0.5 * (1.0 + ratio);
    m.first = 0.5 * inverse * m.r1 + by_c * m.c1;
    m.second = inverse * (0.5 * m.r2 + m.c1 * (ratio * m.c1 - inverse * m.r1)) + by_c * m.c2;
    return m;
  }

  Centerline vessel_;
  TubeBounds bounds_;
  Place here_;
  SegmentPolynomial polynomial_;  // relative to the segment's first node
  int polynomial_segment_ = -1;
};

/// Samples at `parts` equal parts of every chord, and what is kept of them.
struct Sampling {
  int parts = 0;
  double allowance = std::numeric_limits<double>::infinity();
  bool any = false, left = false;
  Penetration deepest, exit;
  bool deepest_approximate = false, exit_approximate = false;

  /// Keeps the deepest sample, of equal ones the first; one that is not a number is kept for good.
  void visit(const Place& here, double arc, int segment, double t) noexcept {
    const bool deeper = !any || (!std::isnan(deepest.depth) && !(here.depth <= deepest.depth));
    const bool leaves = !left && !(here.depth <= allowance);
    if (!deeper && !leaves) return;
    const Penetration sample{here.depth, arc, segment, t, here.sigma(), here.distance};
    if (deeper) deepest = sample, deepest_approximate = here.approximate;
    if (leaves) exit = sample, exit_approximate = here.approximate;
    any = true;
    left = left || leaves;
  }
};

/// Follows a wire through one or two samplings at once.
template <int dim, int samplings>
class Walk {
 public:
  Walk(const Centerline& vessel, const WirePolyline& wire, Sampling* sampling) noexcept
      : wire_(wire), sampling_(sampling), follower_(vessel) {}

  void run(std::optional<double> start) noexcept {
    follower_.begin(wire_.points, radius_at(wire_, 0, 0.0), start);
    change_over(wire_.points, radius_at(wire_, 0, 0.0));
    for (int i = 0; i < samplings; ++i) sampling_[i].visit(follower_.here(), 0.0, 0, 0.0);
    bool quarters = true;
    for (int i = 0; i < samplings; ++i) quarters = quarters && sampling_[i].parts % 4 == 0;
    double arc = 0.0;
    for (int segment = 0; segment + 1 < wire_.nodes; ++segment) {
      const double length = chord_length(wire_, segment, dim);
      if (!pass(segment, arc, length, 0, 1, 1)) {
        for (int k = 0; k < 4 && quarters; ++k) {
          if (!pass(segment, arc, length, k, k + 1, 4)) visit(segment, arc, length, k, k + 1, 4);
        }
        if (!quarters) visit(segment, arc, length, 0, 1, 1);
      }
      arc += length;
    }
    for (int i = 0; i < samplings; ++i) {
      if (sampling_[i].deepest_approximate) refine(sampling_[i].deepest);
      if (sampling_[i].exit_approximate) refine(sampling_[i].exit);
    }
  }

 private:
  void point(int segment, double t, double* x) const noexcept {
    const double* p = wire_.points + segment * dim;
    for (int k = 0; k < dim; ++k) x[k] = (1.0 - t) * p[k] + t * p[dim + k];
  }

  /// A place that would be the deepest one, outside of the tube, is one only if no connected place is lower.
  void change_over(const double* x, double radius) noexcept {
    const double depth = follower_.here().depth;
    if (!(depth > 0.0)) return;
    for (int i = 0; i < samplings; ++i) {
      if (sampling_[i].any && !(depth > sampling_[i].deepest.depth)) continue;
      return follower_.change_over(x, radius);
    }
  }

  void refine(Penetration& found) noexcept {
    double x[3] = {};
    point(found.segment, found.t, x);
    follower_.refine(found, x, radius_at(wire_, found.segment, found.t));
  }

  /// Goes from t = first/parts to end/parts without a look at what is between, where that lies within the wall and
  /// less deep than what is known already. Inside, |∂φ/∂x| = √r/c ≤ 1 and |∂φ/∂c| ≤ 1, and the depth is ≤ φ.
  bool pass(int segment, double arc, double length, int first, int end, int parts) noexcept {
    const double from = static_cast<double>(first) / parts, to = static_cast<double>(end) / parts;
    const double step = length * (to - from);
    double limit = 0.0;
    for (int i = 0; i < samplings; ++i) {
      if (!(sampling_[i].deepest.depth >= limit)) limit = sampling_[i].deepest.depth;
    }
    const Place before = follower_.here();
    if (!(before.gap + 0.5 * step < limit)) return false;
    const double radius = radius_at(wire_, segment, to);
    double x[3] = {};
    point(segment, to, x);
    if (!follower_.glide(x, radius, step)) return false;
    const double change = step + std::abs(radius - radius_at(wire_, segment, from));
    if (!(0.5 * (before.gap + follower_.here().gap + change) < limit)) {
      follower_.back_to(before);
      return false;
    }
    for (int i = 0; i < samplings; ++i) sampling_[i].visit(follower_.here(), arc + to * length, segment, to);
    return true;
  }

  /// All samples from t = first/parts, exclusive, to end/parts.
  void visit(int segment, double arc, double length, int first, int end, int parts) noexcept {
    int next[samplings];
    for (int i = 0; i < samplings; ++i) next[i] = first * sampling_[i].parts / parts + 1;
    double before = static_cast<double>(first) / parts;
    const double last = static_cast<double>(end) / parts;
    while (before < last) {
      double t = last;
      for (int i = 0; i < samplings; ++i) t = std::min(t, static_cast<double>(next[i]) / sampling_[i].parts);
      double x[3] = {};
      point(segment, t, x);
      follower_.move(x, radius_at(wire_, segment, t), length * (t - before));
      change_over(x, radius_at(wire_, segment, t));
      for (int i = 0; i < samplings; ++i) {
        if (static_cast<double>(next[i]) / sampling_[i].parts > t) continue;
        sampling_[i].visit(follower_.here(), arc + t * length, segment, t);
        ++next[i];
      }
      before = t;
    }
  }

  const WirePolyline& wire_;
  Sampling* sampling_;
  Follower<dim> follower_;
};

template <int samplings>
void walk(const Centerline& vessel, const WirePolyline& wire, std::optional<double> start,
          Sampling (&sampling)[samplings]) noexcept {
  vessel.dimension == 2 ? Walk<2, samplings>(vessel, wire, sampling).run(start)
                        : Walk<3, samplings>(vessel, wire, sampling).run(start);
}

}  // namespace

Penetration deepest_penetration(const Centerline& vessel, const WirePolyline& wire, int samples_per_segment,
                                std::optional<double> start) noexcept {
  Sampling sampling[1];
  sampling[0].parts = samples_per_segment;
  walk(vessel, wire, start, sampling);
  return sampling[0].deepest;
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
  const double allowance = crossing_allowance(vessel, wire);
  Sampling sampling[1];
  sampling[0].parts = check_samples;
  sampling[0].allowance = allowance;
  walk(vessel, wire, start, sampling);
  return {sampling[0].deepest, sampling[0].exit, allowance};
}

WallCheck check_wall(const Centerline& vessel, const WirePolyline& wire, std::optional<double> start) noexcept {
  const double allowance = crossing_allowance(vessel, wire);
  Sampling sampling[2];
  sampling[0].parts = dense_samples;
  sampling[1].parts = check_samples;
  sampling[1].allowance = allowance;
  walk(vessel, wire, start, sampling);
  return {sampling[0].deepest, {sampling[1].deepest, sampling[1].exit, allowance}};
}

}  // namespace bowstring::contact
