#include "writers/svg/tube.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double finest_turn = 6.0 * degree;  // invisible as a corner at the scale of a figure
constexpr int most_pieces = 8;
constexpr double least_length = 0.01;  // px, the last digit of a coordinate
constexpr double depth = 0.02;         // part of the radius by which a point counts as inside; above chord errors

Vector2 left_normal(const Vector2& from, const Vector2& to) {
  const Vector2 tangent = normalized(to - from);
  return {{-tangent[1], tangent[0]}};
}

/// Signed angle from a to b.
double turn(const Vector2& a, const Vector2& b) { return std::atan2(cross(a, b), dot(a, b)); }

Vector2 rotated(const Vector2& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}

Tube without_coincident_points(const Tube& tube) {
  Tube out;
  for (std::size_t i = 0; i < tube.points.size(); ++i) {
    if (!out.points.empty() && norm(tube.points[i] - out.points.back()) < least_length) continue;
    out.points.push_back(tube.points[i]);
    out.radius.push_back(tube.radius[i]);
  }
  return out;
}

/// Turning of the polygon at an inner point, 0 at the ends.
double turn_at(const Polyline& points, std::size_t i) {
  if (i == 0 || i + 1 >= points.size()) return 0.0;
  return std::abs(turn(points[i] - points[i - 1], points[i + 1] - points[i]));
}

/// Catmull-Rom segment from p1 to p2 at t in [0, 1].
Vector2 catmull_rom(const Vector2& p0, const Vector2& p1, const Vector2& p2, const Vector2& p3, double t) {
  const Vector2 m1 = 0.5 * (p2 - p0), m2 = 0.5 * (p3 - p1);
  const double t2 = t * t, t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * p1 + (t3 - 2.0 * t2 + t) * m1 + (3.0 * t2 - 2.0 * t3) * p2 + (t3 - t2) * m2;
}

/// Offsets of the two sides, with an arc around every corner; what an arc of the inner side adds lies inside.
Polyline side(const Tube& tube, double sign) {
  Polyline out;
  Vector2 previous;
  for (std::size_t i = 0; i + 1 < tube.points.size(); ++i) {
    const Vector2 normal = left_normal(tube.points[i], tube.points[i + 1]);
    if (i > 0) {
      const double angle = turn(previous, normal);
      const int steps = static_cast<int>(std::abs(angle) / finest_turn);
      for (int k = 1; k <= steps; ++k) {
        out.push_back(tube.points[i] + sign * tube.radius[i] * rotated(previous, angle * k / (steps + 1)));
      }
    }
    out.push_back(tube.points[i] + sign * tube.radius[i] * normal);
    out.push_back(tube.points[i + 1] + sign * tube.radius[i + 1] * normal);
    previous = normal;
  }
  return out;
}

/// Whether a disc of the tube covers the point. Those beyond the two open ends do not count.
bool inside(const Tube& tube, const Vector2& point) {
  const std::size_t edges = tube.points.size() - 1;
  for (std::size_t i = 0; i < edges; ++i) {
    const Vector2 edge = tube.points[i + 1] - tube.points[i];
    const double along = dot(point - tube.points[i], edge) / norm_squared(edge);
    if ((i == 0 && along < 0.0) || (i + 1 == edges && along > 1.0)) continue;
    const double t = std::clamp(along, 0.0, 1.0);
    const double radius = (1.0 - depth) * ((1.0 - t) * tube.radius[i] + t * tube.radius[i + 1]);
    if (norm_squared(point - (tube.points[i] + t * edge)) < radius * radius) return true;
  }
  return false;
}

/// The point between `outer` and `inner` where the outline enters the tube.
Vector2 entry(const Tube& tube, Vector2 outer, Vector2 inner) {
  for (int k = 0; k < 16; ++k) {
    const Vector2 middle = 0.5 * (outer + inner);
    (inside(tube, middle) ? inner : outer) = middle;
  }
  return outer;
}

void append_visible(const Tube& tube, const Polyline& line, std::vector<Polyline>& out) {
  bool was_inside = true;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_inside = inside(tube, line[i]);
    if (!is_inside && was_inside) out.push_back(i > 0 ? Polyline{entry(tube, line[i], line[i - 1])} : Polyline{});
    if (is_inside && !was_inside) out.back().push_back(entry(tube, line[i - 1], line[i]));
    if (!is_inside) out.back().push_back(line[i]);
    was_inside = is_inside;
  }
}

/// The sector on the outer side of a corner, which the two trapezoids beside it leave open.
Polyline corner(const Vector2& point, double radius, const Vector2& before, const Vector2& after) {
  const double angle = turn(before, after);
  const double sign = angle < 0.0 ? 1.0 : -1.0;
  const int steps = 1 + static_cast<int>(std::abs(angle) / finest_turn);
  Polyline out{point};
  for (int k = 0; k <= steps; ++k) out.push_back(point + sign * radius * rotated(before, angle * k / steps));
  if (angle < 0.0) std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

Tube refine(const Tube& given) {
  const Tube tube = without_coincident_points(given);
  const Polyline& p = tube.points;
  Tube out;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double bend = std::max(turn_at(p, i), turn_at(p, i + 1));
    const int pieces = std::clamp(static_cast<int>(std::ceil(bend / finest_turn)), 1, most_pieces);
    const Vector2& before = p[i > 0 ? i - 1 : 0];
    const Vector2& after = p[std::min(i + 2, p.size() - 1)];
    for (int k = 0; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      out.points.push_back(catmull_rom(before, p[i], p[i + 1], after, t));
      out.radius.push_back((1.0 - t) * tube.radius[i] + t * tube.radius[i + 1]);
    }
  }
  if (!p.empty()) {
    out.points.push_back(p.back());
    out.radius.push_back(tube.radius.back());
  }
  return without_coincident_points(out);
}

std::vector<Polyline> tube_area(const Tube& tube) {
  std::vector<Polyline> out;
  Vector2 previous;
  for (std::size_t i = 0; i + 1 < tube.points.size(); ++i) {
    const Vector2 &a = tube.points[i], &b = tube.points[i + 1];
    const Vector2 normal = left_normal(a, b);
    const double ra = tube.radius[i], rb = tube.radius[i + 1];
    if (i > 0 && std::abs(turn(previous, normal)) * ra > least_length) out.push_back(corner(a, ra, previous, normal));
    out.push_back({a + ra * normal, a - ra * normal, b - rb * normal, b + rb * normal});
    previous = normal;
  }
  return out;
}

std::vector<Polyline> tube_outline(const Tube& tube) {
  std::vector<Polyline> out;
  for (const double sign : {1.0, -1.0}) append_visible(tube, side(tube, sign), out);
  return out;
}

}  // namespace bowstring
