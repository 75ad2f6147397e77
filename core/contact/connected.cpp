#include "core/contact/connected.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring::contact {
namespace {

constexpr int samples_per_segment = 4;
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
  Search(const Centerline& curve, const double* x, GapShape shape) noexcept : curve_(curve), x_(x), shape_(shape) {
    widest_ = *std::max_element(curve.radius, curve.radius + curve.nodes) - shape.wire_radius;
  }

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

  double gap(const Ball& at) const noexcept {
    double r = 0.0;
    for (int k = 0; k < curve_.dimension; ++k) r += (x_[k] - at.center[k]) * (x_[k] - at.center[k]);
    return gap_form(shape_.form, r, at.radius).value;
  }

  void look(const ClosestPoint& from, int direction, ClosestPoint& best) const noexcept {
    const Ball here = ball(from.at);
    const double place = from.at.sigma() * samples_per_segment;
    const int end = direction > 0 ? curve_.segments() * samples_per_segment : 0;
    int sample = static_cast<int>(direction > 0 ? std::floor(place) + 1.0 : std::ceil(place) - 1.0);
    double before = -std::numeric_limits<double>::infinity(), last = from.gap;
    for (; direction * (end - sample) >= 0; sample += direction) {
      const Ball there = ball(sample);
      if (!(here.distance(there) <= here.radius + widest_)) return;
      const double height = gap(there);
      if (last < before && last <= height) consider(from, here, sample - direction, best);
      before = last;
      last = height;
    }
    if (last < before) consider(from, here, end, best);
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
  double widest_ = 0.0;
};

}  // namespace

ClosestPoint lowest_connected(const Centerline& curve, const double* x, GapShape shape,
                              const ClosestPoint& from) noexcept {
  if (curve.interpolation != Interpolation::spline) return from;
  const Search search(curve, x, shape);
  ClosestPoint place = from;
  for (int i = 0; i < most_jumps; ++i) {
    const ClosestPoint found = search.step(place);
    if (!(found.gap < place.gap)) break;
    place = found;
  }
  return place;
}

}  // namespace bowstring::contact
