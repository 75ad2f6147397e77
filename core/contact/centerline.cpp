#include "core/contact/centerline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring::contact {
namespace {

/// Adds `weights` (value, slope, second) of control point `control` to the nodes that it is made of.
struct ControlScatter {
  Stencil& stencil;
  int nodes;

  void node(int index, double factor, const double weights[3]) const noexcept {
    const int k = index - stencil.nodes.first;
    stencil.value[k] += factor * weights[0];
    stencil.slope[k] += factor * weights[1];
    stencil.second[k] += factor * weights[2];
  }

  void inside(int control, double factor, const double weights[3]) const noexcept {
    if (control == 0 || control == nodes - 1) {
      node(control, factor, weights);
      return;
    }
    node(control - 1, -factor / 6.0, weights);
    node(control, factor * 4.0 / 3.0, weights);
    node(control + 1, -factor / 6.0, weights);
  }

  void control(int index, const double weights[3]) const noexcept {
    if (index >= 0 && index < nodes) {
      inside(index, 1.0, weights);
      return;
    }
    const int end = index < 0 ? 0 : nodes - 1;
    inside(end, 2.0, weights);
    inside(2 * end - index, -1.0, weights);
  }
};

/// Values b_{j−1} … b_{j+2} of one coordinate (or of the radius), nodes `stride` apart, relative to `origin`.
struct ControlValues {
  const double* values;
  int stride;
  int nodes;
  double origin;

  double node(int i) const noexcept { return values[i * stride] - origin; }

  double inside(int i) const noexcept {
    if (i == 0 || i == nodes - 1) return node(i);
    return node(i) - (node(i + 1) - 2.0 * node(i) + node(i - 1)) / 6.0;
  }

  double control(int i) const noexcept {
    if (i < 0) return 2.0 * inside(0) - inside(-i);
    if (i >= nodes) return 2.0 * inside(nodes - 1) - inside(2 * (nodes - 1) - i);
    return inside(i);
  }
};

void cubic_basis(double b0, double b1, double b2, double b3, double out[4]) noexcept {
  out[0] = (b0 + 4.0 * b1 + b2) / 6.0;
  out[1] = (b2 - b0) / 2.0;
  out[2] = (b0 - 2.0 * b1 + b2) / 2.0;
  out[3] = ((b3 - b0) + 3.0 * (b1 - b2)) / 6.0;
}

/// Of a segment whose six nodes are all there: what `ControlValues` answers away from the ends, without a choice.
void inner_basis(const ControlValues& from, int segment, double out[4]) noexcept {
  const auto control = [](double before, double here, double after) {
    return here - (after - 2.0 * here + before) / 6.0;
  };
  const double n0 = from.node(segment - 2), n1 = from.node(segment - 1), n2 = from.node(segment);
  const double n3 = from.node(segment + 1), n4 = from.node(segment + 2), n5 = from.node(segment + 3);
  cubic_basis(control(n0, n1, n2), control(n1, n2, n3), control(n2, n3, n4), control(n3, n4, n5), out);
}

void power_basis(Interpolation interpolation, const ControlValues& from, int segment, double out[4]) noexcept {
  if (interpolation == Interpolation::polyline) {
    out[0] = from.node(segment);
    out[1] = from.node(segment + 1) - out[0];
    out[2] = out[3] = 0.0;
    return;
  }
  if (segment >= 2 && segment + 3 < from.nodes) return inner_basis(from, segment, out);
  cubic_basis(from.control(segment - 1), from.control(segment), from.control(segment + 1), from.control(segment + 2),
              out);
}

double squared_length(const double a[3]) noexcept { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

}  // namespace

CurvePoint SegmentPolynomial::at(double u) const noexcept {
  CurvePoint point;
  for (int k = 0; k < 3; ++k) {
    const Cubic q = cubic(position[0][k], position[1][k], position[2][k], position[3][k], u);
    point.position[k] = q.value;
    point.slope[k] = q.slope;
    point.second[k] = q.second;
  }
  const Cubic r = cubic(radius[0], radius[1], radius[2], radius[3], u);
  point.radius = r.value;
  point.radius_slope = r.slope;
  point.radius_second = r.second;
  return point;
}

CurveCoordinate coordinate(double sigma, int nodes) noexcept {
  if (!(sigma > 0.0)) return {0, 0.0};
  if (sigma >= nodes - 1) return {nodes - 2, 1.0};
  const int segment = static_cast<int>(sigma);
  return {segment, sigma - segment};
}

NodeRange segment_nodes(Interpolation interpolation, int segment, int nodes) noexcept {
  if (interpolation == Interpolation::polyline) return {segment, 2};
  const int first = std::max(0, segment - 2);
  const int last = std::min(nodes - 1, segment + 3);
  return {first, last - first + 1};
}

Stencil stencil(Interpolation interpolation, CurveCoordinate at, int nodes) noexcept {
  Stencil out;
  out.nodes = segment_nodes(interpolation, at.segment, nodes);
  const double u = at.u;
  if (interpolation == Interpolation::polyline) {
    out.value[0] = 1.0 - u;
    out.value[1] = u;
    out.slope[0] = -1.0;
    out.slope[1] = 1.0;
    return out;
  }
  // The four cubic B-splines of a uniform knot sequence that are nonzero on the segment.
  const double v = 1.0 - u;
  const double basis[4][3] = {
      {v * v * v / 6.0, -v * v / 2.0, v},
      {(4.0 + u * u * (3.0 * u - 6.0)) / 6.0, u * (1.5 * u - 2.0), 3.0 * u - 2.0},
      {(4.0 + v * v * (3.0 * v - 6.0)) / 6.0, -v * (1.5 * v - 2.0), 3.0 * v - 2.0},
      {u * u * u / 6.0, u * u / 2.0, u},
  };
  const ControlScatter scatter{out, nodes};
  for (int m = 0; m < 4; ++m) scatter.control(at.segment - 1 + m, basis[m]);
  return out;
}

SegmentPolynomial segment_polynomial(const Centerline& curve, int segment, const double* origin) noexcept {
  SegmentPolynomial out;
  double basis[4];
  for (int k = 0; k < curve.dimension; ++k) {
    const ControlValues values{curve.points + k, curve.dimension, curve.nodes, origin ? origin[k] : 0.0};
    power_basis(curve.interpolation, values, segment, basis);
    for (int m = 0; m < 4; ++m) out.position[m][k] = basis[m];
  }
  power_basis(curve.interpolation, {curve.radius, 1, curve.nodes, 0.0}, segment, out.radius);
  return out;
}

CurvePoint evaluate(const Centerline& curve, CurveCoordinate at) noexcept {
  return segment_polynomial(curve, at.segment, nullptr).at(at.u);
}

double nodal_curvature(const double* points, int dimension, int node) noexcept {
  double before[3] = {}, after[3] = {}, chord[3] = {};
  double dot = 0.0;
  for (int k = 0; k < dimension; ++k) {
    const double* p = points + node * dimension + k;
    before[k] = p[0] - p[-dimension];
    after[k] = p[dimension] - p[0];
    chord[k] = before[k] + after[k];
    dot += before[k] * after[k];
  }
  const double a = std::sqrt(squared_length(before)), b = std::sqrt(squared_length(after));
  if (a == 0.0 || b == 0.0) return std::numeric_limits<double>::infinity();

  const double cross[3] = {before[1] * after[2] - before[2] * after[1], before[2] * after[0] - before[0] * after[2],
                           before[0] * after[1] - before[1] * after[0]};
  const double c = std::sqrt(squared_length(chord));
  const double circle = c > 0.0 ? 2.0 * std::sqrt(squared_length(cross)) / (a * b * c) : 0.0;
  if (dot >= 0.0) return circle;
  const double half_turn_sine = std::sqrt(0.5 * (1.0 - dot / (a * b)));
  return std::max(circle, 4.0 * half_turn_sine / (a + b));
}

NodeMaximum largest_curvature(const double* points, int dimension, int nodes) noexcept {
  NodeMaximum largest;
  for (int i = 1; i + 1 < nodes; ++i) {
    const double curvature = nodal_curvature(points, dimension, i);
    if (largest.node < 0 || curvature > largest.value) largest = {curvature, i};
  }
  return largest;
}

NodeMaximum tube_folds(const Centerline& tube) noexcept {
  NodeMaximum largest;
  for (int i = 1; i + 1 < tube.nodes; ++i) {
    const double ratio = tube.radius[i] * nodal_curvature(tube.points, tube.dimension, i);
    if (largest.node < 0 || ratio > largest.value) largest = {ratio, i};
  }
  return largest;
}

}  // namespace bowstring::contact
