#include "tests/recheck/wall.hpp"

#include <algorithm>
#include <cmath>

namespace recheck {

namespace {

constexpr double smoothing = 1e-3;  // mm, δ of the smooth distance

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The four cubic B-spline basis functions of a segment, or their derivatives, at u ∈ [0, 1].
void cubic_basis(double u, int derivative, double (&out)[4]) {
  const double v = 1.0 - u;
  if (derivative == 0) {
    out[0] = v * v * v / 6.0;
    out[1] = (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0;
    out[2] = (4.0 - 6.0 * v * v + 3.0 * v * v * v) / 6.0;
    out[3] = u * u * u / 6.0;
  } else if (derivative == 1) {
    out[0] = -0.5 * v * v;
    out[1] = -2.0 * u + 1.5 * u * u;
    out[2] = 2.0 * v - 1.5 * v * v;
    out[3] = 0.5 * u * u;
  } else {
    out[0] = v;
    out[1] = 3.0 * u - 2.0;
    out[2] = 3.0 * v - 2.0;
    out[3] = u;
  }
}

/// Control points of `nodes`, with the reflected ones; of numbers or of points.
template <class Value>
std::vector<Value> controls(const std::vector<Value>& nodes) {
  std::vector<Value> b = nodes;
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    b[i] = nodes[i] - (1.0 / 6.0) * (nodes[i + 1] - 2.0 * nodes[i] + nodes[i - 1]);
  }
  const std::size_t last = b.size() - 1;
  std::vector<Value> out{2.0 * b[0] - b[1]};
  out.insert(out.end(), b.begin(), b.end());
  out.push_back(2.0 * b[last] - b[last - 1]);
  return out;
}

template <class Value>
Jet<Value> cubic_jet(const std::vector<Value>& control, int segment, double u) {
  Jet<Value> out;
  Value* parts[3] = {&out.value, &out.first, &out.second};
  for (int derivative = 0; derivative < 3; ++derivative) {
    double basis[4];
    cubic_basis(u, derivative, basis);
    for (int j = 0; j < 4; ++j) *parts[derivative] = *parts[derivative] + basis[j] * control[index(segment + j)];
  }
  return out;
}

template <class Value>
Jet<Value> straight_jet(const std::vector<Value>& nodes, int segment, double u) {
  const Value step = nodes[index(segment + 1)] - nodes[index(segment)];
  return {nodes[index(segment)] + u * step, step, Value{}};
}

}  // namespace

GapJet gap_of(GapForm form, double a, double c) {
  if (form == GapForm::squared) {
    return {0.5 * (a / c - c), 0.5 / c, -0.5 * (a / (c * c) + 1.0), 0.0, -0.5 / (c * c), a / (c * c * c)};
  }
  const double shift = form == GapForm::smooth_distance ? smoothing : 0.0;
  const double root = std::sqrt(a + shift * shift);
  return {root - shift - c, 0.5 / root, -1.0, -0.25 / (root * root * root), 0.0, 0.0};
}

Wall::Wall(const std::vector<Point>& nodes, const std::vector<double>& radius, bool spline, GapForm form, bool outside)
    : nodes_(nodes.size()), spline_(spline), form_(form), outside_(outside) {
  control_ = spline ? controls(nodes) : nodes;
  control_radius_ = spline ? controls(radius) : radius;
}

Jet<Point> Wall::center(int segment, double u) const {
  return spline_ ? cubic_jet(control_, segment, u) : straight_jet(control_, segment, u);
}

Jet<double> Wall::lumen(int segment, double u) const {
  return spline_ ? cubic_jet(control_radius_, segment, u) : straight_jet(control_radius_, segment, u);
}

double Wall::clearance(double lumen_radius, double wire_radius) const {
  return outside_ ? lumen_radius + wire_radius : lumen_radius - wire_radius;
}

void Wall::split(double sigma, int& segment, double& u) const {
  segment = std::clamp(static_cast<int>(std::floor(sigma)), 0, segments() - 1);
  u = std::clamp(sigma - segment, 0.0, 1.0);
}

/// The gap and its derivatives by σ at fixed x.
Wall::Local Wall::gap(const Point& x, double wire_radius, int segment, double u) const {
  const Jet<Point> q = center(segment, u);
  const Jet<double> r = lumen(segment, u);
  const Point d = q.value - x;
  const double a1 = 2.0 * dot(d, q.first), a2 = 2.0 * (dot(q.first, q.first) + dot(d, q.second));
  const GapJet f = gap_of(form_, dot(d, d), clearance(r.value, wire_radius));
  return {
      f.value, f.by_a * a1 + f.by_c * r.first,
      f.by_a * a2 + f.by_c * r.second + f.by_aa * a1 * a1 + 2.0 * f.by_ac * a1 * r.first + f.by_cc * r.first * r.first};
}

/// Newton's method within one segment, with steps that are halved until they go down, and bounded by its ends.
double Wall::minimise(const Point& x, double wire_radius, int segment, double u) const {
  Local now = gap(x, wire_radius, segment, u);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double wanted = now.second > 0.0 ? -now.first / now.second : (now.first > 0.0 ? -0.25 : 0.25);
    double step = std::clamp(u + std::clamp(wanted, -0.5, 0.5), 0.0, 1.0) - u;
    if (!(std::abs(step) > 1e-14)) break;
    Local trial = gap(x, wire_radius, segment, u + step);
    for (int half = 0; half < 30 && trial.value > now.value; ++half) {
      step *= 0.5;
      trial = gap(x, wire_radius, segment, u + step);
    }
    const bool down = trial.value < now.value || std::abs(trial.first) < std::abs(now.first);
    if (!down) break;
    u += step;
    now = trial;
  }
  return u;
}

WallPoint Wall::at(const Point& x, double wire_radius, double sigma) const {
  int segment = 0;
  double u = 0.0;
  split(sigma, segment, u);
  const Jet<Point> q = center(segment, u);
  const double c = clearance(lumen(segment, u).value, wire_radius);
  Point d = x - q.value;
  WallPoint out{segment + u, gap_of(form_, dot(d, d), c).value};
  const Point tangent = unit(q.first);
  const double ahead = dot(d, tangent);
  const bool beyond = (out.sigma <= 0.0 && ahead < 0.0) || (out.sigma >= segments() && ahead > 0.0);
  if (beyond) d = d - ahead * tangent;
  out.depth = norm(d) - c;
  return out;
}

WallPoint Wall::descend(const Point& x, double wire_radius, double start) const {
  int segment = 0;
  double u = 0.0;
  split(start, segment, u);
  for (int visited = 0; visited <= 2 * segments(); ++visited) {
    u = minimise(x, wire_radius, segment, u);
    // A sample that meets a node is a rounding away from it, and the next segment may go on downhill.
    constexpr double rounding = 1e-12;
    if (u >= 1.0 - rounding && segment + 1 < segments() && gap(x, wire_radius, segment + 1, 0.0).first < 0.0) {
      ++segment;
      u = 0.0;
    } else if (u <= rounding && segment > 0 && gap(x, wire_radius, segment - 1, 1.0).first > 0.0) {
      --segment;
      u = 1.0;
    } else {
      break;
    }
  }
  return at(x, wire_radius, segment + u);
}

WallPoint Wall::lowest(const Point& x, double wire_radius, double near, int window) const {
  int middle = 0;
  double u = 0.0;
  split(near, middle, u);
  const int first = window < 0 ? 0 : std::max(middle - window, 0);
  const int last = window < 0 ? segments() - 1 : std::min(middle + window, segments() - 1);
  WallPoint best = at(x, wire_radius, near);
  for (int segment = first; segment <= last; ++segment) {
    for (const double begin : {0.0, 0.5, 1.0}) {
      const WallPoint found = at(x, wire_radius, segment + minimise(x, wire_radius, segment, begin));
      if (found.gap < best.gap) best = found;
    }
  }
  return best;
}

/// Whether a ball as wide as any could meet the one at `from` if its center were at `to`.
bool Wall::within_reach(double wire_radius, double from, double to) const {
  int segment = 0;
  double u = 0.0;
  split(to, segment, u);
  const Point there = center(segment, u).value;
  split(from, segment, u);
  const double widest = *std::max_element(control_radius_.begin(), control_radius_.end());
  const double reach = clearance(lumen(segment, u).value, wire_radius) + clearance(widest, wire_radius);
  return norm(there - center(segment, u).value) <= reach;
}

/// Whether every point of the centerline between two places is in the ball of one of them, at ten points per segment.
bool Wall::one_limb(double wire_radius, double from, double to) const {
  int segment = 0;
  double u = 0.0;
  split(from, segment, u);
  const Point p = center(segment, u).value;
  const double p_radius = clearance(lumen(segment, u).value, wire_radius);
  split(to, segment, u);
  const Point q = center(segment, u).value;
  const double q_radius = clearance(lumen(segment, u).value, wire_radius);
  const int parts = 1 + static_cast<int>(10.0 * std::abs(to - from));
  for (int k = 0; k <= parts; ++k) {
    split(from + (to - from) * k / parts, segment, u);
    const Point between = center(segment, u).value;
    if (norm(between - p) > p_radius && norm(between - q) > q_radius) return false;
  }
  return norm(p - q) <= p_radius + q_radius;
}

WallPoint Wall::past_ridges(const Point& x, double wire_radius, const WallPoint& place) const {
  constexpr double equal = 1e-8;  // mm
  WallPoint now = place;
  for (bool moved = true; moved;) {
    moved = false;
    WallPoint best = now;
    for (const int direction : {1, -1}) {
      for (int k = 1;; ++k) {
        const double sigma = now.sigma + 0.25 * direction * k;
        // Balls that are not even near each other hold nothing together.
        if (sigma < 0.0 || sigma > segments() || !within_reach(wire_radius, now.sigma, sigma)) break;
        const WallPoint here = at(x, wire_radius, sigma), ahead = at(x, wire_radius, sigma + 0.25 * direction);
        if (here.gap > at(x, wire_radius, sigma - 0.25 * direction).gap || here.gap > ahead.gap) continue;
        const WallPoint found = descend(x, wire_radius, sigma);
        if (found.gap < best.gap - equal && one_limb(wire_radius, now.sigma, found.sigma)) best = found;
      }
    }
    if (best.gap < now.gap) now = best, moved = true;
  }
  return now;
}

double Wall::lumen_radius(double sigma) const {
  int segment = 0;
  double u = 0.0;
  split(sigma, segment, u);
  return lumen(segment, u).value;
}

std::vector<std::pair<int, double>> Wall::weights(double sigma) const {
  int segment = 0;
  double u = 0.0;
  split(sigma, segment, u);
  if (!spline_) return {{segment, 1.0 - u}, {segment + 1, u}};
  // q is linear in the nodes: the weight of a node is what q becomes when that node alone is 1.
  const int first = std::max(segment - 2, 0), last = std::min(segment + 3, segments());
  const int margin_first = std::max(first - 2, 0), margin_last = std::min(last + 2, segments());
  std::vector<std::pair<int, double>> out;
  for (int node = first; node <= last; ++node) {
    std::vector<double> one(index(margin_last - margin_first + 1), 0.0);
    one[index(node - margin_first)] = 1.0;
    out.emplace_back(node, cubic_jet(controls(one), segment - margin_first, u).value);
  }
  return out;
}

}  // namespace recheck
