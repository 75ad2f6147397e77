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

void spread_turns(const Turn (&turn)[2], const CurveView& view, const std::vector<double>& arc,
                  std::vector<double>& points, std::vector<double>& edge_turn) {
  const int d = view.dimension, last = view.nodes - 1;
  const auto held = [&](int end) {
    return std::any_of(view.end[end].position_held, view.end[end].position_held + d, [](bool axis) { return axis; });
  };
  // A rotation about the tangent twists, whichever way it is written.
  const auto twist = [&](int end) {
    return turn[end].twist + dot(turn[end].rotation, Vector3::load(view.end[end].tangent));
  };
  const bool from_last = held(1) && !held(0);
  std::vector<double> turned = points;
  edge_turn.assign(at(last), 0.0);
  for (int k = 0; k < last; ++k) {
    const int i = from_last ? last - 1 - k : k;
    const double share = 0.5 * (arc[at(i)] + arc[at(i + 1)]) / arc.back();
    const Vector3 first = (1.0 - share) * turn[0].rotation, second = share * turn[1].rotation;
    edge_turn[at(i)] = d == 2 ? first[2] + second[2] : (1.0 - share) * twist(0) + share * twist(1);
    Vector3 edge;
    for (int a = 0; a < d; ++a) edge[a] = points[at((i + 1) * d + a)] - points[at(i * d + a)];
    edge = (lie::exp(second) * lie::exp(first)) * edge;
    for (int a = 0; a < d; ++a) {
      if (from_last) {
        turned[at(i * d + a)] = turned[at((i + 1) * d + a)] - edge[a];
      } else {
        turned[at((i + 1) * d + a)] = turned[at(i * d + a)] + edge[a];
      }
    }
  }
  if (held(0) && held(1)) {
    for (int a = 0; a < d; ++a) {
      const double gap = points[at(last * d + a)] - turned[at(last * d + a)];
      for (int i = 0; i <= last; ++i) turned[at(i * d + a)] += gap * arc[at(i)] / arc.back();
      turned[at(last * d + a)] = points[at(last * d + a)];
    }
  }
  points = turned;
}

}  // namespace bowstring
