#include "core/contact/connected.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring::contact {
namespace {

constexpr int samples_per_segment = 2;  // minima of a tube that nodes describe are farther apart than a segment
constexpr int most_jumps = 8;

struct Ball {
  double center[3] = {};
  double radius = 0.0;

  double distance(const Ball& other) const noexcept {
    return std::hypot(other.center[0] - center[0], other.center[1] - center[1], other.center[2] - center[2]);
  }
  bool holds_center(const Ball& other) const noexcept { return distance(other) <= radius; }
};

class Search {
 public:
  Search(const Centerline& curve, const TubeBounds& bounds, const double* x, GapShape shape) noexcept
      : curve_(curve), x_(x), shape_(shape), widest_(bounds.widest - shape.wire_radius), fastest_(bounds.fastest) {}

  /// The lowest minimum connected to `from` in one step.
  ClosestPoint step(const ClosestPoint& from) const noexcept {
    ClosestPoint best = from;
    for (const int direction : {1, -1}) look(from, direction, best);
    return best;
  }

 private:
  static double sigma(int sample) noexcept { return static_cast<double>(sample) / samples_per_segment; }

  Ball ball(CurveCoordinate at) const noexcept {
    const CurvePoint q = evaluate(curve_, at);
    return {{q.position[0], q.position[1], q.position[2]}, q.radius - shape_.wire_radius};
  }
  Ball ball(int sample) const noexcept { return ball(coordinate(sigma(sample), curve_.nodes)); }

  double depth(const Ball& at) const noexcept {
    double r = 0.0;
    for (int k = 0; k < curve_.dimension; ++k) r += (x_[k] - at.center[k]) * (x_[k] - at.center[k]);
    return std::sqrt(r) - at.radius;
  }
  double gap(double depth, double c) const noexcept {
    return gap_form(shape_.form, (depth + c) * (depth + c), c).value;
  }

  /// A depth |x − q| − c below which every place is whose gap is less than `gap`. Of the squared form it is
  /// √(c² + 2c·gap) − c, which grows with c where `gap` is negative, and is at most `gap` otherwise.
  double depth_of(double gap) const noexcept {
    if (shape_.form == GapForm::squared && gap < 0.0 && widest_ > 0.0) {
      return std::sqrt(std::max(0.0, widest_ * (widest_ + 2.0 * gap))) - widest_;
    }
    return gap + (shape_.form == GapForm::smooth_distance ? gap_smoothing : 0.0);
  }

  void look(const ClosestPoint& from, int direction, ClosestPoint& best) const noexcept {
    const Ball here = ball(from.at);
    const double place = from.at.sigma() * samples_per_segment, sought = depth_of(from.gap);
    const int end = direction > 0 ? curve_.segments() * samples_per_segment : 0;
    int sample = static_cast<int>(direction > 0 ? std::floor(place) + 1.0 : std::ceil(place) - 1.0), previous = sample;
    double before = -std::numeric_limits<double>::infinity(), last = from.gap;
    while (direction * (end - sample) >= 0) {
      const Ball there = ball(sample);
      if (!(here.distance(there) <= here.radius + widest_)) return;
      const double deep = depth(there), height = gap(deep, there.radius);
      if (last < before && last <= height) consider(from, here, previous, best);
      before = last;
      last = height;
      previous = sample;
      // So far nothing can be as deep as what is sought.
      const double room = (deep - sought) / fastest_ * samples_per_segment;
      sample += direction * (room > 1.0 ? static_cast<int>(std::min<double>(room, curve_.nodes)) : 1);
    }
    if (last < before) consider(from, here, previous, best);
  }

  void consider(const ClosestPoint& from, const Ball& here, int sample, ClosestPoint& best) const noexcept {
    const ClosestPoint found = closest(curve_, x_, shape_, whole(curve_), sigma(sample));
    if (found.gap < best.gap - equal_gaps && connected(here, from.at.sigma(), found)) best = found;
  }

  bool connected(const Ball& here, double from, const ClosestPoint& found) const noexcept {
    const Ball there = ball(found.at);
    const double to = found.at.sigma(), low = std::min(from, to), high = std::max(from, to);
    const int last = static_cast<int>(std::floor(high * samples_per_segment));
    for (int k = static_cast<int>(std::ceil(low * samples_per_segment)); k <= last; ++k) {
      const Ball between = ball(k);
      if (!here.holds_center(between) && !there.holds_center(between)) return false;
    }
    return here.distance(there) <= here.radius + there.radius;
  }

  const Centerline& curve_;
  const double* x_;
  GapShape shape_;
  double widest_, fastest_;
};

/// The largest step from one control point of a spline to the next, of numbers or of points with `dimension` numbers.
double largest_control_step(const double* nodes, int dimension, int count) noexcept {
  const auto step = [&](int i, int k) {
    return i < 0 || i + 1 >= count ? 0.0 : nodes[(i + 1) * dimension + k] - nodes[i * dimension + k];
  };
  double largest = 0.0;
  for (int i = 0; i + 1 < count; ++i) {
    double squared = 0.0;
    for (int k = 0; k < dimension; ++k) {
      // b_i = p_i − (p_{i+1} − 2p_i + p_{i−1})/6, and b_i = p_i at the ends.
      const double before = i > 0 ? step(i, k) - step(i - 1, k) : 0.0;
      const double after = i + 2 < count ? step(i + 1, k) - step(i, k) : 0.0;
      const double control = step(i, k) - (after - before) / 6.0;
      squared += control * control;
    }
    largest = std::max(largest, squared);
  }
  return std::sqrt(largest);
}

}  // namespace

TubeBounds tube_bounds(const Centerline& curve) noexcept {
  // q' and R' are means of the steps between control points.
  return {*std::max_element(curve.radius, curve.radius + curve.nodes),
          largest_control_step(curve.points, curve.dimension, curve.nodes) +
              largest_control_step(curve.radius, 1, curve.nodes)};
}

ClosestPoint lowest_connected(const Centerline& curve, const TubeBounds& bounds, const double* x, GapShape shape,
                              const ClosestPoint& from) noexcept {
  if (curve.interpolation != Interpolation::spline) return from;
  const Search search(curve, bounds, x, shape);
  ClosestPoint place = from;
  for (int i = 0; i < most_jumps; ++i) {
    const ClosestPoint found = search.step(place);
    if (!(found.gap < place.gap)) break;
    place = found;
  }
  return place;
}

}  // namespace bowstring::contact
