#include "core/model/start_shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/curve/arc_length.hpp"
#include "core/curve/spline_curve.hpp"
#include "core/lie/s2.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Resampled resample_smoothly(const SplineCurve& curve, const std::vector<double>& share) {
  const ArcLength arc = curve.arc_length();
  Resampled out;
  const int d = curve.dimension();
  out.points.resize(share.size() * at(d));
  for (std::size_t i = 0; i < share.size(); ++i) {
    curve.evaluate(arc.parameter_at(share[i] * arc.total()), 0, out.points.data() + i * at(d));
  }
  out.first_tangent = curve.tangent(arc.parameter_at(share.front() * arc.total()));
  out.last_tangent = curve.tangent(arc.parameter_at(share.back() * arc.total()));
  return out;
}

/// Three points carry no cubic spline.
Resampled resample_edges(const std::vector<double>& points, int d, const std::vector<double>& share) {
  const std::vector<double> arc = polyline_arc(points, d);
  Resampled out;
  out.points.resize(share.size() * at(d));
  for (int k = 0; k < d; ++k) {
    std::vector<double> coordinate;
    for (std::size_t i = at(k); i < points.size(); i += at(d)) coordinate.push_back(points[i]);
    for (std::size_t i = 0; i < share.size(); ++i) {
      out.points[i * at(d) + at(k)] = interpolate_linearly(arc, coordinate, share[i] * arc.back());
    }
  }
  return out;
}

bool is_held(const CurveView& view, int end) {
  const bool* held = view.end[end].position_held;
  return std::any_of(held, held + view.dimension, [](bool axis) { return axis; });
}

Vector3 edge_vector(const std::vector<double>& points, int d, int edge) {
  Vector3 out;
  for (int a = 0; a < d; ++a) out[a] = points[at((edge + 1) * d + a)] - points[at(edge * d + a)];
  return out;
}

void put_together(const std::vector<Vector3>& edges, bool from_last, int d, std::vector<double>& points) {
  const int count = static_cast<int>(edges.size());
  for (int k = 0; k < count; ++k) {
    const int i = from_last ? count - 1 - k : k;
    for (int a = 0; a < d; ++a) {
      double& here = points[at((from_last ? i : i + 1) * d + a)];
      here = points[at((from_last ? i + 1 : i) * d + a)] + (from_last ? -1.0 : 1.0) * edges[at(i)][a];
    }
  }
}

/// Turns the edges by α sin πu + β sin 2πu more, u the share of the length, so that they span what they did before they
/// were turned: Newton's method for (α, β) with damping. Edges keep their lengths and, together, their whole turns.
/// Leaves everything as it is where it finds no such turn.
void close_in_plane(const std::vector<double>& points, const std::vector<double>& share, std::vector<Vector3>& edges,
                    std::vector<double>& edge_turn) {
  double length = 0.0;
  Vector3 target;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    target += edge_vector(points, 2, static_cast<int>(i));
    length += norm(edges[i]);
  }
  const auto shape = [&](std::size_t i, int k) { return std::sin((k + 1) * M_PI * share[i]); };
  const auto turned = [&](std::size_t i, const double(&by)[2]) {
    return lie::exp(Vector3{{0.0, 0.0, by[0] * shape(i, 0) + by[1] * shape(i, 1)}}) * edges[i];
  };
  const auto miss = [&](const double(&by)[2]) {
    Vector3 sum = -target;
    for (std::size_t i = 0; i < edges.size(); ++i) sum += turned(i, by);
    return sum;
  };
  double by[2] = {0.0, 0.0};
  Vector3 gap = miss(by);
  for (int iteration = 0; iteration < 200 && norm(gap) > 1e-12 * length; ++iteration) {
    Vector3 column[2];
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Vector3 e = turned(i, by);
      for (int k = 0; k < 2; ++k) column[k] += shape(i, k) * Vector3{{-e[1], e[0], 0.0}};
    }
    const double determinant = column[0][0] * column[1][1] - column[0][1] * column[1][0];
    const double step[2] = {(gap[1] * column[1][0] - gap[0] * column[1][1]) / determinant,
                            (gap[0] * column[0][1] - gap[1] * column[0][0]) / determinant};
    bool better = false;
    for (double damping = std::min(1.0, 0.5 / std::hypot(step[0], step[1])); !better && damping > 1e-6;
         damping *= 0.5) {
      const double trial[2] = {by[0] + damping * step[0], by[1] + damping * step[1]};
      const Vector3 there = miss(trial);
      better = norm(there) < norm(gap);
      if (better) by[0] = trial[0], by[1] = trial[1], gap = there;
    }
    if (!better) break;
  }
  if (!(norm(gap) <= 1e-6 * length)) return;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vector3 e = turned(i, by);
    edge_turn[i] += by[0] * shape(i, 0) + by[1] * shape(i, 1);
    edges[i] = e;
  }
}

}  // namespace

Resampled resample(const std::vector<double>& points, int dimension, const std::vector<double>& share) {
  SplineFit fit;
  const Status status = fit_spline(chord_parameters(points, dimension), points, dimension, 3, 0.0, fit);
  Resampled out = status.ok() ? resample_smoothly(fit.curve, share) : resample_edges(points, dimension, share);
  if (share.front() == 0.0) std::copy_n(points.begin(), dimension, out.points.begin());
  if (share.back() == 1.0) std::copy_n(points.end() - dimension, dimension, out.points.end() - dimension);
  return out;
}

std::vector<double> cumulative_shares(const std::vector<double>& fraction, int edges) {
  std::vector<double> out{0.0};
  for (int i = 0; i < edges; ++i) out.push_back(out.back() + (fraction.empty() ? 1.0 : fraction[at(i)]));
  const double sum = out.back();
  for (double& share : out) share /= sum;
  out.back() = 1.0;
  return out;
}

Matrix3 end_axes(const double (&tangent)[3], int dimension) {
  if (dimension == 3) return lie::frame_from_tangent({{tangent[0], tangent[1], tangent[2]}}).matrix();
  return {{tangent[0], -tangent[1], 0.0, tangent[1], tangent[0], 0.0, 0.0, 0.0, 1.0}};
}

Ramp::Ramp(const CurveView& view, const std::vector<double>& arc)
    : begin_(view.end[0].edge_held ? arc[1] : arc.front()),
      end_(view.end[1].edge_held ? arc[arc.size() - 2] : arc.back()) {}

double Ramp::at(double arc) const noexcept {
  if (arc <= begin_) return 0.0;
  return arc >= end_ ? 1.0 : (arc - begin_) / (end_ - begin_);
}

void spread_turns(const Turn (&turn)[2], const CurveView& view, const std::vector<double>& arc,
                  std::vector<double>& points, std::vector<double>& edge_turn) {
  const int d = view.dimension, edges = view.nodes - 1;
  const Ramp ramp(view, arc);
  // A rotation about the tangent twists, whichever way it is written.
  const auto twist = [&](int end) {
    return turn[end].twist + dot(turn[end].rotation, Vector3::load(view.end[end].tangent));
  };
  std::vector<Vector3> turned(at(edges));
  std::vector<double> middle(at(edges));
  edge_turn.assign(at(edges), 0.0);
  for (int i = 0; i < edges; ++i) {
    const double share = ramp.at(0.5 * (arc[at(i)] + arc[at(i + 1)]));
    const Vector3 first = (1.0 - share) * turn[0].rotation, second = share * turn[1].rotation;
    middle[at(i)] = share;
    edge_turn[at(i)] = d == 2 ? first[2] + second[2] : (1.0 - share) * twist(0) + share * twist(1);
    turned[at(i)] = (lie::exp(second) * lie::exp(first)) * edge_vector(points, d, i);
  }
  const bool first_held = is_held(view, 0), last_held = is_held(view, 1);
  const std::vector<double> before = points;
  if (first_held && last_held && d == 2) {
    // Moves have stretched or shortened the edges; with their own lengths there is room to turn.
    for (int i = 0; i < edges; ++i) turned[at(i)] *= (arc[at(i + 1)] - arc[at(i)]) / norm(turned[at(i)]);
    close_in_plane(before, middle, turned, edge_turn);
  }
  put_together(turned, last_held && !first_held, d, points);
  if (!first_held || !last_held) return;
  for (int a = 0; a < d; ++a) {
    const double gap = before[at(edges * d + a)] - points[at(edges * d + a)];
    for (int i = 0; i <= edges; ++i) points[at(i * d + a)] += gap * ramp.at(arc[at(i)]);
    points[at(edges * d + a)] = before[at(edges * d + a)];
  }
}

}  // namespace bowstring
