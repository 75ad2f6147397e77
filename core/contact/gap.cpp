#include "core/contact/gap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace bowstring::contact {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double singular_distance = 1e-9;  // mm; below it the plain distance counts as zero
constexpr double longest_step = 0.5;        // of a segment: a longer one could pass over a minimum
constexpr int max_steps = 64;               // per segment; bisection alone needs 52
constexpr int samples_per_segment = 4;      // of a global scan
constexpr double near_end = 0.5001;         // of a part of a chord: a largest gap that stood nearer leaves it there
constexpr double bend_that_matters = 0.25;  // of h: with less the middle of a chord stands for its largest gap
constexpr double least_near = 1e-2;         // mm, and
constexpr double near_wall = 0.1;           // of the clearance: a chord that is farther away is looked at less closely

double dot(const double a[3], const double b[3]) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline GapFormValue form_value(GapForm form, double r, double c) noexcept {
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

/// φ_σσ, from F's derivatives and those of r and c.
double second_derivative(const GapFormValue& f, double r1, double r2, double c1, double c2) noexcept {
  return f.rr * r1 * r1 + 2.0 * f.rc * r1 * c1 + f.cc * c1 * c1 + f.r * r2 + f.c * c2;
}

/// φ_σ and φ_σσ at one σ.
struct GapSlope {
  double slope = 0.0, second = 0.0;
  double r = 0.0, speed2 = 0.0;  // |x − q|² and |q'|²

  /// Whether a change of σ is so small that rounding of x − q hides it.
  bool hides(double change) const noexcept {
    // (1 + √a)² ≤ 2 (1 + a): most changes are larger beyond doubt, which takes no roots.
    if (change * change * speed2 > 33.0 * epsilon * epsilon * (speed2 + r)) return false;
    return change <= 4.0 * epsilon * (1.0 + (speed2 > 0.0 ? std::sqrt(r / speed2) : 0.0));
  }
};

/// The search for a minimum of φ along one segment; u is the segment's own coordinate.
template <int dimension>
class SegmentSearch {
 public:
  SegmentSearch(const Centerline& curve, int segment, const double* x, GapShape shape) noexcept
      : polynomial_(segment_polynomial(curve, segment, x)), shape_(shape) {}

  GapSlope slope(double u) const noexcept {
    // `q` is q − x, and so r_σ = 2 (q − x)·q'.
    GapSlope out;
    double along = 0.0, bent = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const Cubic q = coordinate(k, u);
      out.r += q.value * q.value;
      out.speed2 += q.slope * q.slope;
      along += q.value * q.slope;
      bent += q.value * q.second;
    }
    const Cubic radius = this->radius(u);
    const double r1 = 2.0 * along, r2 = 2.0 * (out.speed2 + bent);
    const GapFormValue f = form_value(shape_.form, out.r, radius.value - shape_.wire_radius);
    out.slope = f.r * r1 + f.c * radius.slope;
    out.second = second_derivative(f, r1, r2, radius.slope, radius.second);
    return out;
  }

  ClosestPoint point(CurveCoordinate at, Location location) const noexcept {
    double r = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double q = coordinate(k, at.u).value;
      r += q * q;
    }
    const double clearance = radius(at.u).value - shape_.wire_radius;
    return {at, location, form_value(shape_.form, r, clearance).value, std::sqrt(r), clearance};
  }

  /// Walks from u, where φ's slope is `here`, toward `limit` (direction ±1) down φ. True: u is the first minimum.
  /// False: φ falls all the way, and u is `limit`. Steps are Newton's where φ is convex, and at most half a segment.
  bool descend(double& u, GapSlope here, double limit, int direction) const noexcept {
    for (int i = 0; i < max_steps; ++i) {
      const double ahead = direction * here.slope;
      if (!(ahead < 0.0 || (ahead == 0.0 && here.second < 0.0))) return true;
      const double room = std::abs(limit - u);
      if (room == 0.0) return false;
      double step = here.second > 0.0 ? -ahead / here.second : longest_step;
      if (here.hides(step)) return true;
      step = std::min(step, longest_step);

      const double next = step < room ? u + direction * step : limit;
      const GapSlope there = slope(next);
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
    if (!(slope(low).slope < 0.0)) return low;
    const GapSlope last = slope(high);
    if (!(last.slope > 0.0)) return high;
    return between(low, high, last);
  }

 private:
  Cubic coordinate(int k, double u) const noexcept {
    const auto& p = polynomial_.position;
    return cubic(p[0][k], p[1][k], p[2][k], p[3][k], u);
  }
  Cubic radius(double u) const noexcept {
    return cubic(polynomial_.radius[0], polynomial_.radius[1], polynomial_.radius[2], polynomial_.radius[3], u);
  }

  /// The zero of φ_σ between `behind`, where φ falls toward `ahead`, and `ahead`, where it rises: Newton's
  /// steps, by bisection where they leave the bracket or do not shrink.
  double between(double behind, double ahead, GapSlope here) const noexcept {
    const double sign = ahead >= behind ? 1.0 : -1.0;
    double u = ahead;
    double previous = std::abs(ahead - behind);
    for (int i = 0; i < max_steps; ++i) {
      const double slope_here = sign * here.slope;
      if (slope_here == 0.0) return u;
      (slope_here < 0.0 ? behind : ahead) = u;
      double next = here.second > 0.0 ? u - here.slope / here.second : nan_value;
      const double low = std::min(behind, ahead), high = std::max(behind, ahead);
      const bool inside = next >= low && next <= high;
      if (inside && here.hides(std::abs(next - u))) return next;
      if (here.hides(high - low)) return u;
      if (!inside || std::abs(next - u) > 0.5 * previous) next = 0.5 * (low + high);
      previous = std::abs(next - u);
      u = next;
      here = slope(u);
    }
    return u;
  }

  SegmentPolynomial polynomial_;
  GapShape shape_;
};

/// Calls use(std::integral_constant<int, dimension>).
template <class Use>
auto with_dimension(int dimension, const Use& use) noexcept {
  return dimension == 2 ? use(std::integral_constant<int, 2>()) : use(std::integral_constant<int, 3>());
}

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

template <int dimension>
ClosestPoint closest_on_spline(const Centerline& curve, const double* x, GapShape shape, const Stretch& stretch,
                               double start) noexcept {
  CurveCoordinate at = stretch.clip(start);
  SegmentSearch<dimension> search(curve, at.segment, x, shape);
  GapSlope here = search.slope(at.u);
  const int direction = here.slope > 0.0 ? -1 : 1;
  for (;;) {
    const double limit = direction > 0 ? stretch.upper(at.segment) : stretch.lower(at.segment);
    if (search.descend(at.u, here, limit, direction)) return search.point(at, Location::interior);
    if (at.segment == (direction > 0 ? stretch.last : stretch.first)) break;
    at.segment += direction;
    at.u = direction > 0 ? 0.0 : 1.0;
    search = SegmentSearch<dimension>(curve, at.segment, x, shape);
    here = search.slope(at.u);
  }
  const bool end = at_curve_end(at, curve.nodes);
  return search.point(at, end ? Location::curve_end : Location::window_edge);
}

Location location_on_polyline(CurveCoordinate at, const Stretch& stretch, int nodes) noexcept {
  if (at_curve_end(at, nodes)) return Location::curve_end;
  const bool low = at.segment == stretch.first && at.u == stretch.lower(at.segment);
  const bool high = at.segment == stretch.last && at.u == stretch.upper(at.segment);
  if (low || high) return Location::window_edge;
  return at.u == 0.0 || at.u == 1.0 ? Location::vertex : Location::interior;
}

template <int dimension>
ClosestPoint closest_on_polyline(const Centerline& curve, const double* x, GapShape shape,
                                 const Stretch& stretch) noexcept {
  ClosestPoint best;
  for (int segment = stretch.first; segment <= stretch.last; ++segment) {
    const SegmentSearch<dimension> search(curve, segment, x, shape);
    const double u = search.convex_minimum(stretch.lower(segment), stretch.upper(segment));
    const ClosestPoint here = search.point({segment, u}, Location::interior);
    if (segment == stretch.first || !(here.gap >= best.gap)) best = here;
    if (std::isnan(best.gap)) return best;
  }
  best.location = location_on_polyline(best.at, stretch, curve.nodes);
  return best;
}

/// φ's derivatives in σ and t at a place, with d = x − q and its length's square r.
struct GapPartials {
  double d[3] = {}, slope[3] = {}, chord[3] = {};  // d, q' and ∂x/∂t
  GapFormValue f{};
  double r_sigma = 0.0, r_t = 0.0, c_sigma = 0.0, c_t = 0.0;
  double t = 0.0, sigma_sigma = 0.0, sigma_t = 0.0, t_t = 0.0;  // φ_t, φ_σσ, φ_σt, φ_tt
};

GapPartials gap_partials(const Centerline& curve, const WirePoint& point, GapForm form,
                         const ClosestPoint& closest) noexcept {
  double x[3] = {};
  point.position(curve.dimension, x);
  const GapShape shape = point.shape(form);
  const CurvePoint q = segment_polynomial(curve, closest.at.segment, x).at(closest.at.u);
  GapPartials p;
  for (int k = 0; k < 3; ++k) {
    p.d[k] = -q.position[k];
    p.slope[k] = q.slope[k];
    if (point.nodes == 2 && k < curve.dimension) p.chord[k] = point.points[curve.dimension + k] - point.points[k];
  }
  p.f = form_value(form, dot(p.d, p.d), q.radius - shape.wire_radius);
  p.r_sigma = -2.0 * dot(p.d, p.slope);
  p.c_sigma = q.radius_slope;
  const double r_sigma_sigma = 2.0 * (dot(p.slope, p.slope) + dot(q.position, q.second));
  p.sigma_sigma =
      second_derivative(p.f, 2.0 * dot(q.position, q.slope), r_sigma_sigma, q.radius_slope, q.radius_second);
  if (point.nodes == 1) return p;
  const GapFormValue& f = p.f;
  p.r_t = 2.0 * dot(p.d, p.chord);
  p.c_t = point.radius[0] - point.radius[1];
  p.t = f.r * p.r_t + f.c * p.c_t;
  p.sigma_t = f.rr * p.r_sigma * p.r_t + f.rc * (p.r_sigma * p.c_t + p.r_t * p.c_sigma) + f.cc * p.c_sigma * p.c_t -
              2.0 * f.r * dot(p.chord, p.slope);
  p.t_t = f.rr * p.r_t * p.r_t + 2.0 * f.rc * p.r_t * p.c_t + f.cc * p.c_t * p.c_t + 2.0 * f.r * dot(p.chord, p.chord);
  return p;
}

/// h_t and h_tt along a chord, σ following.
struct ChordDerivatives {
  double slope = 0.0, reduced_second = 0.0;
};
ChordDerivatives chord_derivatives(const Centerline& curve, const WirePoint& point, GapForm form,
                                   const ClosestPoint& closest) noexcept {
  const GapPartials p = gap_partials(curve, point, form, closest);
  const bool sigma_moves = closest.location == Location::interior && p.sigma_sigma > 0.0;
  return {p.t, sigma_moves ? p.t_t - p.sigma_t * p.sigma_t / p.sigma_sigma : p.t_t};
}

/// Where on [0, 1] the cubic with these values and slopes, both of one sign, runs the other way the most; outside of
/// ]0, 1[ where it runs one way.
double steepest_against(double value_0, double slope_0, double value_1, double slope_1) noexcept {
  const double rise = value_1 - value_0;
  const double linear = 3.0 * rise - 2.0 * slope_0 - slope_1, square = slope_0 + slope_1 - 2.0 * rise;
  if (square == 0.0) return -1.0;
  const double t = -linear / (3.0 * square);
  const double slope = slope_0 + t * (2.0 * linear + 3.0 * t * square);
  return slope * (slope_0 + slope_1) < 0.0 ? t : -1.0;
}

/// weight·(φ_zz − φ_zη φ_ηη⁻¹ φ_ηz), packed. With d = Σ_a w_a z_a it is, by blocks of nodes a and b,
///   φ_zz = w_a w_b (2 F_r I + 4 F_rr d dᵀ),   φ_zη = 2 w_a (F_rr r_η + F_rc c_η) d + 2 F_r (w_{a,η} d + w_a d_η).
template <int dim>
void write_hessian(const GapExpansion& e, double weight, double* out) noexcept {
  constexpr int most = (2 + max_stencil) * dim;
  const bool sigma_moves = e.sigma_sigma != 0.0, t_moves = e.t_t != 0.0;
  const int blocks = e.wire_nodes + e.nodes.count;
  double by_sigma[most], by_t[most], along[most];
  for (int a = 0; a < blocks; ++a) {
    const double w = e.weight[a];
    const double w_sigma = a < e.wire_nodes ? 0.0 : e.weight_sigma[a - e.wire_nodes];
    const double w_t = e.wire_nodes == 1 || a > 1 ? 0.0 : (a == 0 ? -1.0 : 1.0);
    for (int i = 0; i < dim; ++i) {
      const int k = a * dim + i;
      by_sigma[k] = (e.along_sigma * w + e.first * w_sigma) * e.d[i] - e.first * w * e.slope[i];
      by_t[k] = (e.along_t * w + e.first * w_t) * e.d[i] + e.first * w * e.chord[i];
      along[k] = w * e.d[i];
    }
  }
  if (sigma_moves && t_moves) {
    for (int k = 0; k < blocks * dim; ++k) by_t[k] -= by_sigma[k] * e.sigma_t / e.sigma_sigma;
  }

  const double from_sigma = sigma_moves ? weight / e.sigma_sigma : 0.0;
  const double from_t = t_moves ? weight / e.t_t : 0.0;
  for (int a = 0; a < blocks; ++a) {
    const double diagonal = weight * e.first * e.weight[a];
    for (int i = 0; i < dim; ++i) {
      const int row = a * dim + i;
      const double minus_sigma = -from_sigma * by_sigma[row];
      for (int column = 0; column <= row; ++column) out[column] = minus_sigma * by_sigma[column];
      if (t_moves) {
        const double minus_t = from_t * by_t[row];
        for (int column = 0; column <= row; ++column) out[column] -= minus_t * by_t[column];
      }
      if (e.second != 0.0) {
        const double second = weight * e.second * along[row];
        for (int column = 0; column <= row; ++column) out[column] += second * along[column];
      }
      for (int b = 0; b <= a; ++b) out[b * dim + i] += diagonal * e.weight[b];
      out += row + 1;
    }
  }
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

GapFormValue gap_form(GapForm form, double r, double c) noexcept { return form_value(form, r, c); }

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
  return with_dimension(curve.dimension, [&](auto dimension) {
    return curve.interpolation == Interpolation::spline ? closest_on_spline<dimension>(curve, x, shape, stretch, start)
                                                        : closest_on_polyline<dimension>(curve, x, shape, stretch);
  });
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
    const SegmentSearch<3> search(curve, segment, x, shape);  // a plane's third coordinate is 0
    const int samples = segment == curve.segments() - 1 ? samples_per_segment + 1 : samples_per_segment;
    for (int k = 0; k < samples; ++k) {
      const double here = search.point({segment, k * spacing}, Location::interior).gap;
      if (last < before && last <= here) refine(sigma);
      before = last;
      last = here;
      sigma = segment + k * spacing;
    }
  }
  if (last < before || !std::isfinite(best.gap)) refine(sigma);
  return best;
}

ClosestPoint gap_at(const Centerline& curve, const double* x, GapShape shape, CurveCoordinate at) noexcept {
  return SegmentSearch<3>(curve, at.segment, x, shape).point(at, Location::vertex);  // a plane's third coordinate is 0
}

void WirePoint::position(int dimension, double* x) const noexcept {
  for (int k = 0; k < dimension; ++k) {
    x[k] = nodes == 1 ? points[k] : (1.0 - t) * points[k] + t * points[dimension + k];
  }
}

GapShape WirePoint::shape(GapForm form) const noexcept {
  return {form, nodes == 1 ? radius[0] : (1.0 - t) * radius[0] + t * radius[1]};
}

ChordExtremum chord_extremum(const Centerline& curve, const WirePoint& chord, GapForm form, double sign, Window window,
                             double start, ChordPart part) noexcept {
  struct Sample {
    double t = 0.0, slope = 0.0, second = 0.0;  // of sign·h
    ClosestPoint closest;
  };
  const auto at = [&](double t, double from) {
    WirePoint point = chord;
    point.t = t;
    double x[3] = {};
    point.position(curve.dimension, x);
    Sample sample;
    sample.t = t;
    sample.closest = closest(curve, x, point.shape(form), window, from);
    const ChordDerivatives d = chord_derivatives(curve, point, form, sample.closest);
    sample.slope = sign * d.slope;
    sample.second = sign * d.reduced_second;
    return sample;
  };
  Sample low = at(part.low, start), high = at(part.high, start);
  const double bend = high.slope - low.slope;
  const double end_sigma[2] = {low.closest.at.sigma(), high.closest.at.sigma()};
  const auto answer = [&](const Sample& sample, bool interior) {
    const bool matters = std::fabs(bend) > bend_that_matters * std::fabs(sample.closest.gap);
    const double told = !matters ? 0.0 : (interior ? -std::fabs(bend) : std::max(bend, 0.0));
    return ChordExtremum{sample.t, interior, told, {end_sigma[0], end_sigma[1]}, sample.closest};
  };
  if (low.closest.location == Location::window_edge) return answer(low, false);
  if (high.closest.location == Location::window_edge) return answer(high, false);
  const auto height = [&](const Sample& sample) { return sign * sample.closest.gap; };
  const auto usable = [](const Sample& sample) { return sample.closest.location != Location::window_edge; };
  /// Narrows a stretch to one at whose ends h rises and falls, where there is such a one.
  const auto rises_and_falls = [&](Sample& first, Sample& last) {
    if (first.slope > 0.0 && last.slope < 0.0) return true;
    if (!(first.slope * last.slope > 0.0)) return false;
    const double length = last.t - first.t;
    const double t = steepest_against(height(first), length * first.slope, height(last), length * last.slope);
    if (!(t > 0.0 && t < 1.0)) return false;
    const Sample between = at(first.t + t * length, first.closest.at.sigma());
    if (!usable(between) || !(between.slope * first.slope < 0.0)) return false;
    (between.slope > 0.0 ? first : last) = between;
    return true;
  };
  if (!rises_and_falls(low, high)) {
    const Sample& end = height(low) >= height(high) ? low : high;
    const bool leaves_by_end = std::fabs(chord.t - end.t) < near_end * (part.high - part.low);
    const bool stands = chord.t > part.low && chord.t < part.high && !leaves_by_end;
    const auto without = [&] { return answer(stands ? at(chord.t, start) : end, false); };
    if (!(height(end) > -std::max(near_wall * end.closest.clearance, least_near))) return without();
    // A chord that is long for the wall's bends may leave the wall from both ends and come back between.
    Sample middle = at(part.middle(), low.closest.at.sigma()), first = low, last = high, other = middle;
    const bool before = usable(middle) && rises_and_falls(first, middle);
    const bool after = usable(other) && rises_and_falls(other, last);
    if (!before && !after) return without();
    const bool take_first = before && (!after || height(middle) + height(first) >= height(other) + height(last));
    low = take_first ? first : other;
    high = take_first ? middle : last;
  }

  // Newton's steps on the slope from the secant's, by bisection where they leave the bracket.
  const double secant = low.t + (high.t - low.t) * low.slope / (low.slope - high.slope);
  Sample here = at(secant, low.closest.at.sigma());
  for (int i = 0; i < max_steps; ++i) {
    if (here.closest.location == Location::window_edge || std::isnan(here.slope)) break;
    if (here.slope == 0.0) break;
    (here.slope > 0.0 ? low : high) = here;
    const double step = here.second < 0.0 ? -here.slope / here.second : nan_value;
    if (std::abs(step) <= 4.0 * epsilon || high.t - low.t <= 4.0 * epsilon) break;
    double next = here.t + step;
    if (!(next > low.t && next < high.t)) next = 0.5 * (low.t + high.t);
    here = at(next, here.closest.at.sigma());
  }
  return answer(here, true);
}

NodeRange gap_derivatives(const Centerline& curve, const double* x, GapShape shape, const ClosestPoint& closest,
                          double* gradient, double weight, double* hessian) noexcept {
  WirePoint point;
  point.points = x;
  point.radius[0] = shape.wire_radius;
  return gap_derivatives(curve, point, shape.form, closest, gradient, weight, hessian);
}

GapExpansion expand_gap(const Centerline& curve, const WirePoint& point, GapForm form,
                        const ClosestPoint& closest) noexcept {
  const GapPartials p = gap_partials(curve, point, form, closest);
  const Stencil nodes = stencil(curve.interpolation, closest.at, curve.nodes);
  GapExpansion e;
  e.dimension = curve.dimension;
  e.wire_nodes = point.nodes;
  e.nodes = nodes.nodes;
  std::copy_n(p.d, 3, e.d);
  std::copy_n(p.slope, 3, e.slope);
  e.first = 2.0 * p.f.r;
  e.second = 4.0 * p.f.rr;
  e.weight[0] = 1.0;
  if (point.nodes == 2) {
    e.weight[0] = 1.0 - point.t, e.weight[1] = point.t;
    std::copy_n(p.chord, 3, e.chord);
  }
  for (int k = 0; k < nodes.nodes.count; ++k) {
    e.weight[point.nodes + k] = -nodes.value[k];
    e.weight_sigma[k] = -nodes.slope[k];
  }
  // What moves is eliminated one after the other: first σ, then t from what that leaves.
  const bool sigma_moves = closest.location == Location::interior && p.sigma_sigma > 0.0;
  if (sigma_moves) {
    e.sigma_sigma = p.sigma_sigma;
    e.sigma_t = p.sigma_t;
  }
  if (point.extremal) e.t_t = sigma_moves ? p.t_t - p.sigma_t * p.sigma_t / p.sigma_sigma : p.t_t;
  e.along_sigma = 2.0 * (p.f.rr * p.r_sigma + p.f.rc * p.c_sigma);
  e.along_t = 2.0 * (p.f.rr * p.r_t + p.f.rc * p.c_t);
  return e;
}

void gap_gradient(const GapExpansion& e, double factor, double* out) noexcept {
  double along[3];
  for (int i = 0; i < 3; ++i) along[i] = factor * e.first * e.d[i];
  for (int a = 0; a < e.wire_nodes + e.nodes.count; ++a) {
    for (int i = 0; i < e.dimension; ++i) *out++ = e.weight[a] * along[i];
  }
}

void gap_hessian(const GapExpansion& expansion, double weight, double* out) noexcept {
  expansion.dimension == 2 ? write_hessian<2>(expansion, weight, out) : write_hessian<3>(expansion, weight, out);
}

NodeRange gap_derivatives(const Centerline& curve, const WirePoint& point, GapForm form, const ClosestPoint& closest,
                          double* gradient, double weight, double* hessian) noexcept {
  const GapExpansion expansion = expand_gap(curve, point, form, closest);
  if (gradient != nullptr) gap_gradient(expansion, 1.0, gradient);
  if (hessian != nullptr) gap_hessian(expansion, weight, hessian);
  return expansion.nodes;
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
