#include "core/contact/gap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace bowstring::contact {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double singular_distance = 1e-9;  // mm; below it the plain distance counts as zero
constexpr double longest_step = 0.5;        // of a segment: a longer one could pass over a minimum
constexpr int max_steps = 64;               // per segment; bisection alone needs 52
constexpr int samples_per_segment = 4;      // of a global scan

double dot(const double a[3], const double b[3]) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// φ at one σ with its derivatives, in terms of d = x − q.
struct GapValue {
  double gap = 0.0, slope = 0.0, second = 0.0;  // φ, φ_σ, φ_σσ
  double distance = 0.0, clearance = 0.0;
  double resolution = 0.0;  // change of σ that rounding of d hides
};

GapValue gap_value(const CurvePoint& q, GapShape shape) noexcept {
  // `position` is q − x = −d, and so r_σ = 2 (q − x)·q'.
  const double r = dot(q.position, q.position);
  const double speed2 = dot(q.slope, q.slope);
  const double r1 = 2.0 * dot(q.position, q.slope);
  const double r2 = 2.0 * (speed2 + dot(q.position, q.second));
  const double c1 = q.radius_slope, c2 = q.radius_second;

  GapValue out;
  out.distance = std::sqrt(r);
  out.clearance = q.radius - shape.wire_radius;
  const GapFormValue f = gap_form(shape.form, r, out.clearance);
  out.gap = f.value;
  out.slope = f.r * r1 + f.c * c1;
  out.second = f.rr * r1 * r1 + 2.0 * f.rc * r1 * c1 + f.cc * c1 * c1 + f.r * r2 + f.c * c2;
  out.resolution = 4.0 * epsilon * (1.0 + (speed2 > 0.0 ? std::sqrt(r / speed2) : 0.0));
  return out;
}

/// The search for a minimum of φ along one segment; u is the segment's own coordinate.
class SegmentSearch {
 public:
  SegmentSearch(const Centerline& curve, int segment, const double* x, GapShape shape) noexcept
      : polynomial_(segment_polynomial(curve, segment, x)), shape_(shape) {}

  GapValue at(double u) const noexcept { return gap_value(polynomial_.at(u), shape_); }

  /// Walks from u toward `limit` (direction ±1) down φ. True: u is the first minimum. False: φ falls all the
  /// way, and u is `limit`. Steps are Newton's where φ is convex, and at most half a segment.
  bool descend(double& u, double limit, int direction) const noexcept {
    GapValue here = at(u);
    for (int i = 0; i < max_steps; ++i) {
      const double ahead = direction * here.slope;
      if (!(ahead < 0.0 || (ahead == 0.0 && here.second < 0.0))) return true;
      const double room = std::abs(limit - u);
      if (room == 0.0) return false;
      double step = here.second > 0.0 ? -ahead / here.second : longest_step;
      if (step <= here.resolution) return true;
      step = std::min(step, longest_step);

      const double next = step < room ? u + direction * step : limit;
      const GapValue there = at(next);
      if (direction * there.slope >= 0.0) {
        u = between(u, next, there);
        return true;
      }
      u = next;
      here = there;
    }
    return true;
  }

  /// The exact minimum of a φ that is convex on [low, high].
  double convex_minimum(double low, double high) const noexcept {
    if (!(at(low).slope < 0.0)) return low;
    const GapValue last = at(high);
    if (!(last.slope > 0.0)) return high;
    return between(low, high, last);
  }

 private:
  /// The zero of φ_σ between `behind`, where φ falls toward `ahead`, and `ahead`, where it rises: Newton's
  /// steps, by bisection where they leave the bracket or do not shrink.
  double between(double behind, double ahead, GapValue value_ahead) const noexcept {
    const double sign = ahead >= behind ? 1.0 : -1.0;
    double u = ahead;
    GapValue here = value_ahead;
    double previous = std::abs(ahead - behind);
    for (int i = 0; i < max_steps; ++i) {
      const double slope = sign * here.slope;
      if (slope == 0.0) return u;
      (slope < 0.0 ? behind : ahead) = u;
      double next = here.second > 0.0 ? u - here.slope / here.second : nan_value;
      const double low = std::min(behind, ahead), high = std::max(behind, ahead);
      const bool inside = next >= low && next <= high;
      if (inside && std::abs(next - u) <= here.resolution) return next;
      if (high - low <= here.resolution) return u;
      if (!inside || std::abs(next - u) > 0.5 * previous) next = 0.5 * (low + high);
      previous = std::abs(next - u);
      u = next;
      here = at(u);
    }
    return u;
  }

  SegmentPolynomial polynomial_;
  GapShape shape_;
};

/// The window in terms of the segments that it touches. A NaN bound is no bound.
struct Stretch {
  double low, high;
  int first, last;

  Stretch(Window window, int nodes) noexcept
      : low(window.low > 0.0 ? std::min(window.low, nodes - 1.0) : 0.0),
        high(window.high < nodes - 1.0 ? std::max(window.high, low) : nodes - 1.0),
        first(std::min(static_cast<int>(low), nodes - 2)),
        last(std::max(first, static_cast<int>(std::ceil(high)) - 1)) {}

  double lower(int segment) const noexcept { return std::clamp(low - segment, 0.0, 1.0); }
  double upper(int segment) const noexcept { return std::clamp(high - segment, 0.0, 1.0); }

  CurveCoordinate clip(double sigma) const noexcept {
    const double inside = sigma > low ? std::min(sigma, high) : low;
    const int segment = std::clamp(static_cast<int>(inside), first, last);
    return {segment, inside - segment};
  }
};

bool at_curve_end(CurveCoordinate at, int nodes) noexcept {
  return (at.segment == 0 && at.u == 0.0) || (at.segment == nodes - 2 && at.u == 1.0);
}

ClosestPoint closest_point(const SegmentSearch& search, CurveCoordinate at, Location location) noexcept {
  const GapValue value = search.at(at.u);
  return {at, location, value.gap, value.distance, value.clearance};
}

ClosestPoint closest_on_spline(const Centerline& curve, const double* x, GapShape shape, const Stretch& stretch,
                               double start) noexcept {
  CurveCoordinate at = stretch.clip(start);
  SegmentSearch search(curve, at.segment, x, shape);
  const int direction = search.at(at.u).slope > 0.0 ? -1 : 1;
  for (;;) {
    const double limit = direction > 0 ? stretch.upper(at.segment) : stretch.lower(at.segment);
    if (search.descend(at.u, limit, direction)) return closest_point(search, at, Location::interior);
    if (at.segment == (direction > 0 ? stretch.last : stretch.first)) break;
    at.segment += direction;
    at.u = direction > 0 ? 0.0 : 1.0;
    search = SegmentSearch(curve, at.segment, x, shape);
  }
  const bool end = at_curve_end(at, curve.nodes);
  return closest_point(search, at, end ? Location::curve_end : Location::window_edge);
}

Location location_on_polyline(CurveCoordinate at, const Stretch& stretch, int nodes) noexcept {
  if (at_curve_end(at, nodes)) return Location::curve_end;
  const bool low = at.segment == stretch.first && at.u == stretch.lower(at.segment);
  const bool high = at.segment == stretch.last && at.u == stretch.upper(at.segment);
  if (low || high) return Location::window_edge;
  return at.u == 0.0 || at.u == 1.0 ? Location::vertex : Location::interior;
}

ClosestPoint closest_on_polyline(const Centerline& curve, const double* x, GapShape shape,
                                 const Stretch& stretch) noexcept {
  ClosestPoint best;
  for (int segment = stretch.first; segment <= stretch.last; ++segment) {
    const SegmentSearch search(curve, segment, x, shape);
    const double u = search.convex_minimum(stretch.lower(segment), stretch.upper(segment));
    const ClosestPoint here = closest_point(search, {segment, u}, Location::interior);
    if (segment == stretch.first || !(here.gap >= best.gap)) best = here;
    if (std::isnan(best.gap)) return best;
  }
  best.location = location_on_polyline(best.at, stretch, curve.nodes);
  return best;
}

/// One monotone assignment of wire points to samples of a curve, by dynamic programming over the points.
class MonotoneBinding {
 public:
  MonotoneBinding(const Centerline& curve, const double* points, int count)
      : dimension_(curve.dimension), points_(points), count_(count) {
    const int samples = curve.segments() * samples_per_segment + 1;
    for (int k = 0; k < samples; ++k) {
      const CurvePoint q = evaluate(curve, coordinate(sigma(k), curve.nodes));
      samples_.insert(samples_.end(), q.position, q.position + dimension_);
    }
  }

  static double sigma(int sample) noexcept { return static_cast<double>(sample) / samples_per_segment; }

  /// Assigns non-decreasing samples to the points taken in order (or in reverse order); returns the sum of
  /// squares.
  double solve(bool reversed, std::vector<int>& sample_of) const {
    const std::size_t m = samples_.size() / static_cast<std::size_t>(dimension_);
    const std::size_t n = static_cast<std::size_t>(count_);
    // cost[k]: least sum so far with the last point at a sample ≤ k; choice: where that point is then.
    std::vector<double> cost(m, 0.0);
    std::vector<int> choice(n * m);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t point = reversed ? n - 1 - i : i;
      for (std::size_t k = 0; k < m; ++k) {
        const double here = cost[k] + squared_distance(point, k);
        const bool lower = k == 0 || here < cost[k - 1];
        choice[i * m + k] = lower ? static_cast<int>(k) : choice[i * m + k - 1];
        cost[k] = lower ? here : cost[k - 1];
      }
    }
    sample_of.resize(n);
    std::size_t last = m - 1;
    for (std::size_t i = n; i-- > 0;) {
      last = static_cast<std::size_t>(choice[i * m + last]);
      sample_of[reversed ? n - 1 - i : i] = static_cast<int>(last);
    }
    return cost[m - 1];
  }

 private:
  double squared_distance(std::size_t point, std::size_t sample) const noexcept {
    const std::size_t dimension = static_cast<std::size_t>(dimension_);
    double sum = 0.0;
    for (std::size_t a = 0; a < dimension; ++a) {
      const double difference = points_[point * dimension + a] - samples_[sample * dimension + a];
      sum += difference * difference;
    }
    return sum;
  }

  int dimension_;
  const double* points_;
  int count_;
  std::vector<double> samples_;
};

}  // namespace

GapFormValue gap_form(GapForm form, double r, double c) noexcept {
  if (form == GapForm::squared) {
    if (!(c > 0.0)) return {nan_value, nan_value, nan_value, nan_value, nan_value, nan_value};
    const double by_c = 1.0 / c;
    return {0.5 * (r * by_c - c),  0.5 * by_c, -0.5 * (r * by_c * by_c + 1.0), 0.0, -0.5 * by_c * by_c,
            r * by_c * by_c * by_c};
  }
  const double delta = form == GapForm::smooth_distance ? gap_smoothing : 0.0;
  const double s = std::sqrt(r + delta * delta);
  if (s < singular_distance) return {s - c, 0.0, -1.0, 0.0, 0.0, 0.0};
  return {s - delta - c, 0.5 / s, -1.0, -0.25 / (s * s * s), 0.0, 0.0};
}

Window whole(const Centerline& curve) noexcept { return {0.0, curve.nodes - 1.0}; }

Window window_around(double sigma, int neighbours, int nodes) noexcept {
  const int segment = coordinate(sigma, nodes).segment;
  return {static_cast<double>(std::max(0, segment - neighbours)),
          static_cast<double>(std::min(nodes - 1, segment + 1 + neighbours))};
}

NodeRange window_nodes(Interpolation interpolation, Window window, int nodes) noexcept {
  const Stretch stretch(window, nodes);
  const NodeRange first = segment_nodes(interpolation, stretch.first, nodes);
  const NodeRange last = segment_nodes(interpolation, stretch.last, nodes);
  return {first.first, last.first + last.count - first.first};
}

ClosestPoint closest(const Centerline& curve, const double* x, GapShape shape, Window window, double start) noexcept {
  const Stretch stretch(window, curve.nodes);
  return curve.interpolation == Interpolation::spline ? closest_on_spline(curve, x, shape, stretch, start)
                                                      : closest_on_polyline(curve, x, shape, stretch);
}

ClosestPoint globally_closest(const Centerline& curve, const double* x, GapShape shape) noexcept {
  const Window all = whole(curve);
  if (curve.interpolation == Interpolation::polyline) return closest(curve, x, shape, all, 0.0);

  constexpr double spacing = 1.0 / samples_per_segment;
  ClosestPoint best;
  best.gap = std::numeric_limits<double>::infinity();
  double before = best.gap, last = best.gap;
  double sigma = 0.0;
  const auto refine = [&](double start) {
    const ClosestPoint here = closest(curve, x, shape, all, start);
    if (!(here.gap >= best.gap)) best = here;
  };
  for (int segment = 0; segment < curve.segments(); ++segment) {
    const SegmentSearch search(curve, segment, x, shape);
    const int samples = segment == curve.segments() - 1 ? samples_per_segment + 1 : samples_per_segment;
    for (int k = 0; k < samples; ++k) {
      const double here = search.at(k * spacing).gap;
      if (last < before && last <= here) refine(sigma);
      before = last;
      last = here;
      sigma = segment + k * spacing;
    }
  }
  if (last < before || !std::isfinite(best.gap)) refine(sigma);
  return best;
}

NodeRange gap_derivatives(const Centerline& curve, const double* x, GapShape shape, const ClosestPoint& closest,
                          double* gradient, double weight, double* hessian) noexcept {
  const int dim = curve.dimension;
  const Stencil nodes = stencil(curve.interpolation, closest.at, curve.nodes);
  const CurvePoint q = segment_polynomial(curve, closest.at.segment, x).at(closest.at.u);
  const double d[3] = {-q.position[0], -q.position[1], -q.position[2]};
  const GapFormValue f = gap_form(shape.form, dot(d, d), q.radius - shape.wire_radius);

  // With z_0 = x and z_k the nodes, d = Σ_a w_a z_a: ∂d/∂z_a = w_a I, ∂²d/∂z_a∂σ = w'_a I.
  const int blocks = 1 + nodes.nodes.count;
  double w[1 + max_stencil] = {1.0}, w1[1 + max_stencil] = {0.0};
  for (int k = 0; k < nodes.nodes.count; ++k) {
    w[1 + k] = -nodes.value[k];
    w1[1 + k] = -nodes.slope[k];
  }

  if (gradient) {
    for (int a = 0; a < blocks; ++a) {
      for (int i = 0; i < dim; ++i) gradient[a * dim + i] = 2.0 * f.r * w[a] * d[i];
    }
  }
  if (!hessian) return nodes.nodes;

  // φ_zσ by blocks: 2 w_a (F_rr r_σ + F_rc c') d + 2 F_r (w'_a d − w_a q').
  const GapValue value = gap_value(q, shape);
  const bool eliminate = closest.location == Location::interior && value.second > 0.0;
  const double r1 = -2.0 * dot(d, q.slope);
  const double along_d = 2.0 * (f.rr * r1 + f.rc * q.radius_slope);
  double mixed[3 * (1 + max_stencil)] = {};
  if (eliminate) {
    for (int a = 0; a < blocks; ++a) {
      for (int i = 0; i < dim; ++i) {
        mixed[a * dim + i] = (along_d * w[a] + 2.0 * f.r * w1[a]) * d[i] - 2.0 * f.r * w[a] * q.slope[i];
      }
    }
  }

  const double elimination = eliminate ? weight / value.second : 0.0;
  double* out = hessian;
  for (int row = 0; row < blocks * dim; ++row) {
    const int a = row / dim, i = row % dim;
    for (int column = 0; column <= row; ++column) {
      const int b = column / dim, j = column % dim;
      const double block = (i == j ? 2.0 * f.r : 0.0) + 4.0 * f.rr * d[i] * d[j];
      *out++ = weight * w[a] * w[b] * block - elimination * mixed[row] * mixed[column];
    }
  }
  return nodes.nodes;
}

void bind_along(const Centerline& curve, const double* points, int count, double* sigma) {
  const MonotoneBinding binding(curve, points, count);
  std::vector<int> forward, backward;
  const double forward_sum = binding.solve(false, forward);
  const bool reversed = binding.solve(true, backward) < 0.5 * forward_sum;
  const std::vector<int>& sample_of = reversed ? backward : forward;

  // The nearest point within half a sample of the assigned one. Points that share a sample stay there: each
  // would move past its neighbour.
  constexpr double reach = 0.5 / samples_per_segment;
  const auto shared = [&](int i, int neighbour) {
    return neighbour >= 0 && neighbour < count &&
           sample_of[static_cast<std::size_t>(i)] == sample_of[static_cast<std::size_t>(neighbour)];
  };
  for (int i = 0; i < count; ++i) {
    sigma[i] = MonotoneBinding::sigma(sample_of[static_cast<std::size_t>(i)]);
    if (shared(i, i - 1) || shared(i, i + 1)) continue;
    const Window window{sigma[i] - reach, sigma[i] + reach};
    sigma[i] = closest(curve, points + i * curve.dimension, {GapForm::distance, 0.0}, window, sigma[i]).at.sigma();
  }
}

}  // namespace bowstring::contact
