#include "core/measure/curve_measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include "core/curve/arc_length.hpp"
#include "core/lie/s2.hpp"

namespace bowstring {
namespace {

constexpr std::pair<CurveWeights, const char*> weights_names[] = {
    {CurveWeights::uniform, "uniform"},
    {CurveWeights::arc_length, "arc-length"},
    {CurveWeights::lumen_section, "lumen-section"},
};

Vector3 point(const std::vector<double>& points, std::size_t i) { return Vector3::load(&points[3 * i]); }

Vector3 direction(const Vector3& v) {
  const double length = norm(v);
  return length > 0.0 ? v / length : Vector3();
}

/// Unit vectors; where both edges of a node have no length, or point against each other, that of the edge before it.
std::vector<Vector3> node_tangents(const std::vector<double>& points) {
  const std::size_t nodes = points.size() / 3;
  std::vector<Vector3> edge(nodes - 1), tangent(nodes);
  for (std::size_t i = 0; i + 1 < nodes; ++i) edge[i] = direction(point(points, i + 1) - point(points, i));
  // An edge without length takes its neighbour's direction.
  for (std::size_t i = 1; i < edge.size(); ++i) {
    if (norm_squared(edge[i]) == 0.0) edge[i] = edge[i - 1];
  }
  for (std::size_t i = edge.size(); i-- > 1;) {
    if (norm_squared(edge[i - 1]) == 0.0) edge[i - 1] = edge[i];
  }
  tangent.front() = edge.front();
  tangent.back() = edge.back();
  for (std::size_t i = 1; i + 1 < nodes; ++i) {
    tangent[i] = direction(edge[i - 1] + edge[i]);
    if (norm_squared(tangent[i]) == 0.0) tangent[i] = edge[i - 1];
  }
  return tangent;
}

std::vector<double> transported_frames(const std::vector<Vector3>& tangent) {
  std::vector<double> out(4 * tangent.size());
  lie::Rotation frame = lie::frame_from_tangent(tangent.front());
  for (std::size_t i = 0; i < tangent.size(); ++i) {
    if (i > 0) frame = lie::transport(frame, tangent[i]);
    frame.store(&out[4 * i]);
  }
  return out;
}

/// Places along a curve before they have weights.
struct Places {
  std::vector<double> position, arc, length, radius;
  std::vector<Vector3> tangent;
};

Places at_nodes(const NodalCurve& curve, const std::vector<double>& arc) {
  const std::size_t nodes = curve.nodes();
  Places out{curve.points, arc, std::vector<double>(nodes, 0.0), curve.radius, node_tangents(curve.points)};
  for (std::size_t i = 0; i + 1 < nodes; ++i) {
    const double half = 0.5 * (arc[i + 1] - arc[i]);
    out.length[i] += half;
    out.length[i + 1] += half;
  }
  return out;
}

Places resampled(const NodalCurve& curve, const std::vector<double>& arc, int count) {
  const std::vector<Vector3> tangent = node_tangents(curve.points);
  const double share = arc.back() / count;
  Places out;
  std::size_t edge = 0;
  for (int k = 0; k < count; ++k) {
    const double s = (k + 0.5) * share;
    while (edge + 2 < arc.size() && arc[edge + 1] < s) ++edge;
    const double length = arc[edge + 1] - arc[edge], t = length > 0.0 ? (s - arc[edge]) / length : 0.0;
    const auto between = [t](const auto& a, const auto& b) { return (1.0 - t) * a + t * b; };
    double place[3];
    between(point(curve.points, edge), point(curve.points, edge + 1)).store(place);
    out.position.insert(out.position.end(), place, place + 3);
    Vector3 along = direction(between(tangent[edge], tangent[edge + 1]));
    if (norm_squared(along) == 0.0) along = tangent[edge];
    out.tangent.push_back(along);
    if (!curve.radius.empty()) out.radius.push_back(between(curve.radius[edge], curve.radius[edge + 1]));
    out.arc.push_back(s);
    out.length.push_back(share);
  }
  return out;
}

std::vector<double> weights_of(const Places& places, const CurveSampling& sampling) {
  std::vector<double> out(places.arc.size(), 1.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (sampling.weights != CurveWeights::uniform) out[i] = places.length[i];
    if (sampling.weights == CurveWeights::lumen_section) out[i] *= places.radius[i] * places.radius[i];
    double factor = 1.0;
    for (const MeasureStation& station : sampling.stations) {
      const double away = (places.arc[i] - station.at) / station.spread;
      factor += station.weight * std::exp(-0.5 * away * away);
    }
    out[i] *= factor;
    sum += out[i];
  }
  for (double& weight : out) weight /= sum;
  return out;
}

Status flawed(const std::string& text) { return Status::failure(Code::invalid_input, text); }

Status check(const NodalCurve& curve, const CurveSampling& sampling) {
  if (curve.nodes() < 2) {
    return flawed("a curve of " + std::to_string(curve.nodes()) + " nodes; expected at least two");
  }
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if (!std::isfinite(curve.points[i])) {
      return flawed("node " + std::to_string(i / 3) + " of the curve is not finite; expected three numbers in mm");
    }
  }
  if (sampling.weights != CurveWeights::lumen_section) return {};
  if (curve.radius.size() != curve.nodes()) {
    return flawed(
        "weights 'lumen-section' of a curve whose radius is not known; expected a radius at every node; "
        "give it, or choose the weights 'arc-length'");
  }
  for (std::size_t i = 0; i < curve.radius.size(); ++i) {
    if (curve.radius[i] > 0.0 && std::isfinite(curve.radius[i])) continue;
    return flawed("weights 'lumen-section' of a curve without a radius above 0 at node " + std::to_string(i) +
                  "; give it one, or choose the weights 'arc-length'");
  }
  return {};
}

}  // namespace

const char* curve_weights_name(CurveWeights weights) noexcept {
  for (const auto& [value, name] : weights_names) {
    if (value == weights) return name;
  }
  return "";
}

bool read_curve_weights(const char* name, CurveWeights& out) noexcept {
  for (const auto& [value, known] : weights_names) {
    if (std::strcmp(known, name) != 0) continue;
    out = value;
    return true;
  }
  return false;
}

NodalCurve nodal_curve(const std::vector<double>& points, int dimension, std::vector<double> radius) {
  NodalCurve out;
  out.radius = std::move(radius);
  if (dimension == 3) {
    out.points = points;
    return out;
  }
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    out.points.insert(out.points.end(), {points[i], points[i + 1], 0.0});
  }
  return out;
}

std::vector<double> node_frames(const NodalCurve& curve) { return transported_frames(node_tangents(curve.points)); }

Status measure_of_curve(const NodalCurve& curve, const CurveSampling& sampling, CurveMeasure& out) {
  if (Status status = check(curve, sampling); !status.ok()) return status;
  const std::vector<double> arc = polyline_arc(curve.points, 3);
  if (!std::isfinite(arc.back())) return flawed("a curve of more than the largest number of mm; expected a length");
  if (!(arc.back() > 0.0)) return flawed("a curve without length: its nodes are one point; expected nodes apart");
  Places places = sampling.points > 0 ? resampled(curve, arc, sampling.points) : at_nodes(curve, arc);
  out.measure.weight = weights_of(places, sampling);
  for (const double weight : out.measure.weight) {
    if (!std::isfinite(weight))
      return flawed("weights beyond the largest number; expected radii and stations below it");
  }
  out.measure.orientation = transported_frames(places.tangent);
  out.measure.position = std::move(places.position);
  out.arc = std::move(places.arc);
  return {};
}

}  // namespace bowstring
