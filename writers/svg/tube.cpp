#include "writers/svg/tube.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double finest_turn = 6.0 * degree;  // invisible as a corner at the scale of a figure
constexpr int most_pieces = 8;
constexpr double least_length = 0.01;  // px, the last digit of a coordinate
constexpr double most_growth = 0.95;   // of the radius per length of an edge
constexpr double depth = 0.02;         // part of the radius by which a point counts as inside; above chord errors

/// One edge of a tube. Two discs have common tangents where neither covers the other; `growth` is the sine of their
/// angle with the edge, kept below 1.
struct Edge {
  Vector2 start, along, left;  ///< unit tangent and its left normal
  double length, start_radius, end_radius, growth, cosine;

  Edge(const Tube& tube, std::size_t i)
      : start(tube.points[i]), start_radius(tube.radius[i]), end_radius(tube.radius[i + 1]) {
    const Vector2 step = tube.points[i + 1] - start;
    length = norm(step);
    along = (1.0 / length) * step;
    left = {{-along[1], along[0]}};
    growth = std::clamp((end_radius - start_radius) / length, -most_growth, most_growth);
    cosine = std::sqrt(1.0 - growth * growth);
  }

  /// Unit normal of the tangent on the left (sign 1) or on the right (sign −1).
  Vector2 normal(double sign) const { return sign * cosine * left - growth * along; }
  Vector2 end() const { return start + length * along; }
};

std::vector<Edge> edges_of(const Tube& tube) {
  std::vector<Edge> out;
  for (std::size_t i = 0; i + 1 < tube.points.size(); ++i) out.emplace_back(tube, i);
  return out;
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

Polyline arc(const Vector2& center, double radius, const Vector2& from, double angle) {
  Polyline out;
  const int steps = 1 + static_cast<int>(std::abs(angle) / finest_turn);
  for (int k = 0; k <= steps; ++k) out.push_back(center + radius * rotated(from, angle * k / steps));
  return out;
}

/// What joins the tangents of two edges on one side of their common disc: the point where they cross when that is near
/// or the corner too slight to be seen; else an arc, which lies inside the tube where it is on the inner side.
Polyline joint(const Edge& before, const Edge& after, double sign) {
  const Vector2 normal = before.normal(sign);
  const double angle = turn(normal, after.normal(sign)), radius = after.start_radius;
  const bool inner = sign * angle > 0.0;
  const double room = 0.5 * std::min(before.length, after.length);
  if (inner ? radius * std::tan(0.5 * std::abs(angle)) <= room : std::abs(angle) < finest_turn) {
    return {after.start + radius / std::cos(0.5 * angle) * rotated(normal, 0.5 * angle)};
  }
  return arc(after.start, radius, normal, angle);
}

/// The envelope of the tube's discs on one side. It doubles back only where the tube bends more sharply than its
/// radius, and so inside the tube.
Polyline side(const std::vector<Edge>& edges, double sign) {
  const Edge &first = edges.front(), &last = edges.back();
  Polyline out{first.start + first.start_radius * first.normal(sign)};
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Polyline part = joint(edges[i - 1], edges[i], sign);
    out.insert(out.end(), part.begin(), part.end());
  }
  out.push_back(last.end() + last.end_radius * last.normal(sign));
  return out;
}

/// Whether a disc of the tube covers the point. Those beyond the two open ends do not count.
bool inside(const std::vector<Edge>& edges, const Vector2& point) {
  for (const Edge& edge : edges) {
    const double along = dot(point - edge.start, edge.along), across = std::abs(dot(point - edge.start, edge.left));
    if ((&edge == &edges.front() && along < 0.0) || (&edge == &edges.back() && along > edge.length)) continue;
    // The disc that covers most, as its radius changes along the edge.
    const double at = std::clamp(along + across * edge.growth / edge.cosine, 0.0, edge.length);
    const double part = at / edge.length;
    const double radius = (1.0 - depth) * ((1.0 - part) * edge.start_radius + part * edge.end_radius);
    if ((along - at) * (along - at) + across * across < radius * radius) return true;
  }
  return false;
}

/// The point between `outer` and `inner` where the outline enters the tube.
Vector2 entry(const std::vector<Edge>& tube, Vector2 outer, Vector2 inner) {
  for (int k = 0; k < 16; ++k) {
    const Vector2 middle = 0.5 * (outer + inner);
    (inside(tube, middle) ? inner : outer) = middle;
  }
  return outer;
}

void append_visible(const std::vector<Edge>& tube, const Polyline& line, std::vector<Polyline>& out) {
  bool was_inside = true;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_inside = inside(tube, line[i]);
    if (!is_inside && was_inside) out.push_back(i > 0 ? Polyline{entry(tube, line[i], line[i - 1])} : Polyline{});
    if (is_inside && !was_inside) out.back().push_back(entry(tube, line[i - 1], line[i]));
    if (!is_inside) out.back().push_back(line[i]);
    was_inside = is_inside;
  }
}

/// The sector between two edges on one side of their common disc; empty where they overlap there.
Polyline sector(const Edge& before, const Edge& after, double sign) {
  const double angle = turn(before.normal(sign), after.normal(sign));
  if (-sign * angle * after.start_radius <= least_length) return {};
  Polyline out = arc(after.start, after.start_radius, before.normal(sign), angle);
  if (sign > 0.0) std::reverse(out.begin(), out.end());
  out.push_back(after.start);
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
  const std::vector<Edge> edges = edges_of(tube);
  std::vector<Polyline> out;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    Polyline piece{edge.start + edge.start_radius * edge.normal(1.0)};
    if (i > 0) piece.push_back(edge.start);
    piece.push_back(edge.start + edge.start_radius * edge.normal(-1.0));
    piece.push_back(edge.end() + edge.end_radius * edge.normal(-1.0));
    if (i + 1 < edges.size()) piece.push_back(edge.end());
    piece.push_back(edge.end() + edge.end_radius * edge.normal(1.0));
    out.push_back(piece);
    if (i == 0) continue;
    for (const double sign : {1.0, -1.0}) {
      if (const Polyline part = sector(edges[i - 1], edge, sign); !part.empty()) out.push_back(part);
    }
  }
  return out;
}

std::vector<Polyline> tube_outline(const Tube& tube) {
  const std::vector<Edge> edges = edges_of(tube);
  std::vector<Polyline> out;
  if (edges.empty()) return out;
  for (const double sign : {1.0, -1.0}) append_visible(edges, side(edges, sign), out);
  return out;
}

}  // namespace bowstring
