#include "core/model/carried_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/curve/arc_length.hpp"
#include "core/curve/spline_curve.hpp"
#include "core/lie/s2.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double same_share = 1e-12;   // of a curve's material
constexpr double small_shift = 0.25;   // of an edge: nodes that are nearer stand for the same material
constexpr double merging_slope = 0.1;  // at which a tip that runs on comes to the centerline

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Vector3 point_at(const std::vector<double>& points, int d, int node) {
  Vector3 out;
  for (int k = 0; k < d; ++k) out[k] = points[at(node * d + k)];
  return out;
}

void append(const Vector3& point, int d, std::vector<double>& points) {
  for (int k = 0; k < d; ++k) points.push_back(point[k]);
}

Vector3 edge_tangent(const std::vector<double>& points, int d, int edge) {
  const Vector3 e = point_at(points, d, edge + 1) - point_at(points, d, edge);
  return e / norm(e);
}

/// The edges' frames whose means at inner nodes, and whose own at the ends, are these.
std::vector<lie::Rotation> edge_frames(const std::vector<double>& nodal) {
  std::vector<lie::Rotation> out{lie::Rotation::load(nodal.data())};
  for (std::size_t i = 1; i + 1 < nodal.size() / 4; ++i) {
    const lie::Rotation half = out.back().inverse() * lie::Rotation::load(nodal.data() + 4 * i);
    out.push_back((out.back() * half * half).normalized());
  }
  return out;
}

/// A curve of straight edges as a smooth one over its material.
class MaterialCurve {
 public:
  MaterialCurve(int dimension, std::vector<double> share, std::vector<double> points,
                std::vector<lie::Rotation> frames = {})
      : dimension_(dimension), share_(std::move(share)), points_(std::move(points)), frames_(std::move(frames)) {
    for (std::size_t i = 0; i + 1 < share_.size(); ++i) middle_.push_back(0.5 * (share_[i] + share_[i + 1]));
    std::vector<double> parameter = share_;
    scale_ = static_cast<double>(share_.size() - 1);  // a mean step of 1 keeps the fit's matrices well scaled
    for (double& t : parameter) t *= scale_;
    smooth_ = share_.size() >= 4 && fit_spline(parameter, points_, dimension_, 3, 0.0, fit_).ok();
  }
  explicit MaterialCurve(const RecordedCurve& recorded)
      : MaterialCurve(recorded.dimension, recorded.share, recorded.points, edge_frames(recorded.frames)) {}

  const std::vector<double>& share() const noexcept { return share_; }
  const std::vector<double>& points() const noexcept { return points_; }

  Vector3 point(double share) const {
    const std::size_t node = nearest_index(share_, share);
    if (std::fabs(share - share_[node]) <= same_share) return point_at(points_, dimension_, static_cast<int>(node));
    double out[3] = {0.0, 0.0, 0.0};
    if (smooth_) {
      fit_.curve.evaluate(std::clamp(share, 0.0, 1.0) * scale_, 0, out);
    } else {
      for (int k = 0; k < dimension_; ++k) {
        std::vector<double> coordinate;
        for (std::size_t i = at(k); i < points_.size(); i += at(dimension_)) coordinate.push_back(points_[i]);
        out[k] = interpolate_linearly(share_, coordinate, share);
      }
    }
    return Vector3::load(out);
  }

  lie::Rotation frame(double share) const {
    if (share <= middle_.front()) return frames_.front();
    if (share >= middle_.back()) return frames_.back();
    const auto above = std::upper_bound(middle_.begin(), middle_.end(), share);
    const auto i = static_cast<std::size_t>(above - middle_.begin()) - 1;
    const double t = (share - middle_[i]) / (middle_[i + 1] - middle_[i]);
    return frames_[i] * lie::exp(t * lie::log(frames_[i].inverse() * frames_[i + 1]));
  }

 private:
  int dimension_;
  std::vector<double> share_, middle_, points_;
  std::vector<lie::Rotation> frames_;  // of the edges, at their middles
  double scale_ = 1.0;
  bool smooth_ = false;
  SplineFit fit_;
};

/// The centerline of a vessel as a way that wires run on along.
class Way {
 public:
  Way(const Curve& vessel, const CarriedCurve& carried)
      : dimension_(vessel.view.dimension),
        curve_(dimension_, material_shares(vessel), carried.points, loaded(carried.orientation)),
        arc_(polyline_arc(carried.points, dimension_)) {}

  Vector3 point(double share) const { return curve_.point(share); }

  /// Where a curve that ends at `tip`, near this share of the way, comes to within these `lengths` of its own (mm,
  /// increasing), along the way for `sign` 1 and back for −1. Its offset from the way turns with the way and goes to 0.
  std::vector<Vector3> beyond(const Vector3& tip, double near, double sign, const std::vector<double>& lengths) const {
    const double begin = nearest_arc(tip, near);
    const Vector3 offset = frame_at(begin).inverse() * (tip - at_arc(begin));
    const double merged = norm(offset) / merging_slope;
    const auto place = [&](double way) {
      const double left = way < merged ? 1.0 - way / merged : 0.0;
      const double to = begin + sign * way;
      return at_arc(to) + left * left * (3.0 - 2.0 * left) * (frame_at(to) * offset);
    };
    // An offset curve is longer than its way on the outside of a bend: lengths are measured.
    const double step = arc_.back() / (4.0 * static_cast<double>(arc_.size() - 1));
    std::vector<double> way{0.0}, length{0.0};
    for (Vector3 last = place(0.0); length.back() < lengths.back();) {
      way.push_back(way.back() + step);
      const Vector3 next = place(way.back());
      length.push_back(length.back() + std::max(norm(next - last), 0.1 * step));
      last = next;
    }
    std::vector<Vector3> out;
    for (const double one : lengths) out.push_back(place(interpolate_linearly(length, way, one)));
    return out;
  }

 private:
  static std::vector<lie::Rotation> loaded(const std::vector<double>& quaternions) {
    std::vector<lie::Rotation> out;
    for (std::size_t i = 0; i < quaternions.size(); i += 4) out.push_back(lie::Rotation::load(quaternions.data() + i));
    return out;
  }

  lie::Rotation frame_at(double arc) const { return curve_.frame(interpolate_linearly(arc_, curve_.share(), arc)); }

  Vector3 at_arc(double arc) const {
    const int last = static_cast<int>(arc_.size()) - 1;
    if (arc < 0.0) return curve_.point(0.0) + arc * edge_tangent(curve_.points(), dimension_, 0);
    if (arc > arc_.back()) {
      return curve_.point(1.0) + (arc - arc_.back()) * edge_tangent(curve_.points(), dimension_, last - 1);
    }
    return curve_.point(interpolate_linearly(arc_, curve_.share(), arc));
  }

  /// Of the place nearest to `point`, downhill from the given share, so that no other limb is found.
  double nearest_arc(const Vector3& point, double near) const {
    const int last = static_cast<int>(arc_.size()) - 1;
    const auto distance = [&](int i) { return norm_squared(point_at(curve_.points(), dimension_, i) - point); };
    int node = static_cast<int>(nearest_index(curve_.share(), near));
    while (node < last && distance(node + 1) < distance(node)) ++node;
    while (node > 0 && distance(node - 1) < distance(node)) --node;
    double best = arc_[at(node)], least = distance(node);
    for (int edge = std::max(node - 1, 0); edge <= std::min(node, last - 1); ++edge) {
      const Vector3 a = point_at(curve_.points(), dimension_, edge),
                    t = edge_tangent(curve_.points(), dimension_, edge);
      const double along = std::clamp(dot(point - a, t), 0.0, arc_[at(edge + 1)] - arc_[at(edge)]);
      const double found = norm_squared(a + along * t - point);
      if (found < least) least = found, best = arc_[at(edge)] + along;
    }
    return best;
  }

  int dimension_;
  MaterialCurve curve_;
  std::vector<double> arc_;
};

/// Orientations of the edges: where `known` has one, that after the least turn to the edge, elsewhere carried on from
/// the neighbour by the least turn.
std::vector<double> orient_edges(const std::vector<double>& points, int d,
                                 const std::vector<std::optional<lie::Rotation>>& known) {
  const int edges = static_cast<int>(known.size());
  const auto first_known = std::find_if(known.begin(), known.end(), [](const auto& one) { return one.has_value(); });
  const int begin = first_known == known.end() ? 0 : static_cast<int>(first_known - known.begin());
  std::vector<lie::Rotation> frame(known.size());
  for (int i = begin; i < edges; ++i) {
    const Vector3 tangent = edge_tangent(points, d, i);
    if (!known[at(i)] && i == begin) {
      frame[at(i)] = lie::frame_from_tangent(tangent);
    } else {
      frame[at(i)] = lie::transport(known[at(i)] ? *known[at(i)] : frame[at(i - 1)], tangent);
    }
  }
  for (int i = begin - 1; i >= 0; --i) frame[at(i)] = lie::transport(frame[at(i + 1)], edge_tangent(points, d, i));
  std::vector<double> out(known.size() * 4);
  for (std::size_t i = 0; i < frame.size(); ++i) frame[i].store(out.data() + 4 * i);
  return out;
}

/// Whether edges between these points have directions.
bool has_edges(const std::vector<double>& points, int d) {
  for (int i = 0; at((i + 2) * d) <= points.size(); ++i) {
    if (!(norm_squared(point_at(points, d, i + 1) - point_at(points, d, i)) > 0.0)) return false;
  }
  return true;
}

bool same_nodes(const std::vector<double>& share, const RecordedCurve& recorded) {
  if (recorded.share.size() != share.size()) return false;
  for (std::size_t i = 1; i + 1 < share.size(); ++i) {
    const double edge = std::min(share[i] - share[i - 1], share[i + 1] - share[i]);
    if (std::fabs(share[i] - recorded.share[i]) > small_shift * edge) return false;
  }
  return true;
}

class Carrying {
 public:
  Carrying(const Scene& scene, const CarriedState& carried, std::vector<DocumentFlaw>& flaws)
      : scene_(scene), carried_(carried), state_(*carried.state), flaws_(flaws) {}

  CarriedCurves run() {
    out_.curves.resize(scene_.curves.size());
    for (const auto& curve : scene_.curves) carry(*curve, out_.curves[at(curve->view.index)]);
    for (const RecordedCurve& recorded : state_.curves) {
      if (recorded.kind != CurveKind::wire || scene_.find(recorded.name) != nullptr) continue;
      out_.warnings.push_back(carried_.name + " has a wire '" + recorded.name +
                              "', which this scene does not have: it is left out");
    }
    return std::move(out_);
  }

 private:
  void carry(const Curve& curve, CarriedCurve& out) {
    const RecordedCurve* recorded = state_.find(curve.name);
    const NamedNumbers* position = field(curve.name, "position");
    out.recorded = recorded != nullptr || any_field(curve.name);
    if (!out.recorded) return begin_along(curve, out);
    if (recorded == nullptr || !recorded->flaw.empty()) {
      // Its numbers may do, where they fit; there is no shape.
      out.flaw = recorded == nullptr ? "no entry in 'curves'" : recorded->flaw;
      const std::size_t expected = at(curve.view.nodes * curve.view.dimension);
      out.same_mesh = position == nullptr || position->values.size() == expected;
      if (position != nullptr && out.same_mesh) out.points = position->values;
      return;
    }
    const bool span = span_changed(curve, *recorded);
    out.same_mesh = !span && same_nodes(material_shares(curve), *recorded);
    if (recorded->nodes() != curve.view.nodes) {
      out.told = "from " + std::to_string(recorded->nodes()) + " nodes to " + std::to_string(curve.view.nodes);
    } else if (!out.same_mesh && !span) {
      out.told = "to another spacing of its nodes";
    }
    if (span) {
      out.told += (out.told.empty() ? "" : ", ") + std::string("from the span ") + number(recorded->along_begin) +
                  " … " + number(recorded->along_end) + " mm to " + number(curve.along_begin) + " … " +
                  number(curve.along_end) + " mm";
    }
    if (out.same_mesh) return take(*recorded, out);
    interpolate(curve, *recorded, span, out);
  }

  bool span_changed(const Curve& curve, const RecordedCurve& recorded) const {
    if (curve.along < 0 || scene_.curves[at(curve.along)]->name != recorded.along) return false;
    // The length of a vessel, which a span may end at, changes a little with its mesh.
    const double length = curve.along_end - curve.along_begin;
    const double slack = small_shift * length / std::min(curve.view.nodes - 1, recorded.nodes() - 1);
    return std::fabs(curve.along_begin - recorded.along_begin) > slack ||
           std::fabs(curve.along_end - recorded.along_end) > slack;
  }

  /// The recorded curve as it stands.
  static void take(const RecordedCurve& recorded, CarriedCurve& out) {
    out.share = recorded.share;
    out.points = recorded.points;
    if (!edges_of(recorded.dimension, out)) return;
    const std::vector<lie::Rotation> frames = edge_frames(recorded.frames);
    out.orientation = orient_edges(out.points, recorded.dimension, {frames.begin(), frames.end()});
  }

  void interpolate(const Curve& curve, const RecordedCurve& recorded, bool span, CarriedCurve& out) {
    const int d = curve.view.dimension;
    const MaterialCurve material(recorded);
    std::vector<double>& share = out.share;
    share = material_shares(curve);
    if (span) {
      for (double& s : share) {
        const double arc = curve.along_begin + s * (curve.along_end - curve.along_begin);
        s = (arc - recorded.along_begin) / (recorded.along_end - recorded.along_begin);
        for (const double end : {0.0, 1.0}) {
          if (std::fabs(s - end) <= same_share) s = end;
        }
      }
    }
    std::optional<Way> way;
    if (share.front() < 0.0 || share.back() > 1.0) {
      if (of(curve.along).orientation.empty()) {
        flaws_.push_back({carried_.name + " has '" + recorded.along + "' with " + of(curve.along).flaw,
                          "its shape, which '" + curve.name + "' runs on along",
                          "start from a result that this version wrote"});
        return;
      }
      way.emplace(*scene_.curves[at(curve.along)], of(curve.along));
    }
    const double vessel_length = way ? scene_.curves[at(curve.along)]->arc.back() : 1.0;
    const double span_length = recorded.along_end - recorded.along_begin;
    std::vector<double> before, after;  // lengths beyond the recorded ends
    for (const double s : share) {
      if (s < 0.0) before.insert(before.begin(), -s * span_length);
      if (s > 1.0) after.push_back((s - 1.0) * span_length);
    }
    if (!before.empty()) {
      std::vector<Vector3> points =
          way->beyond(material.point(0.0), recorded.along_begin / vessel_length, -1.0, before);
      std::reverse(points.begin(), points.end());
      for (const Vector3& point : points) append(point, d, out.points);
    }
    for (const double s : share) {
      if (s >= 0.0 && s <= 1.0) append(material.point(s), d, out.points);
    }
    if (!after.empty()) {
      for (const Vector3& point : way->beyond(material.point(1.0), recorded.along_end / vessel_length, 1.0, after)) {
        append(point, d, out.points);
      }
    }
    if (!edges_of(d, out)) return;
    std::vector<std::optional<lie::Rotation>> known(share.size() - 1);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (share[i] >= 0.0 && share[i + 1] <= 1.0) known[i] = material.frame(0.5 * (share[i] + share[i + 1]));
    }
    out.orientation = orient_edges(out.points, d, known);
  }

  /// A curve that was not there: along its vessel's recorded centerline, without twist from State 1's first frame.
  void begin_along(const Curve& curve, CarriedCurve& out) {
    const std::string begins = carried_.name + " has no wire '" + curve.name + "', which starts ";
    if (curve.along < 0 || of(curve.along).points.empty() || of(curve.along).orientation.empty()) {
      out_.warnings.push_back(begins + "where this composition has it");
      return;
    }
    const int d = curve.view.dimension;
    const Curve& vessel = *scene_.curves[at(curve.along)];
    out_.warnings.push_back(begins + "along '" + vessel.name + "' as it was recorded");
    const Way way(vessel, of(curve.along));
    for (const double s : material_shares(curve)) {
      const double arc = curve.along_begin + s * (curve.along_end - curve.along_begin);
      append(way.point(arc / vessel.arc.back()), d, out.points);
    }
    if (!edges_of(d, out)) return;
    std::vector<std::optional<lie::Rotation>> known(at(curve.view.nodes - 1));
    known.front() = lie::frame_from_tangent(edge_tangent(curve.reference, d, 0));
    out.orientation = orient_edges(out.points, d, known);
  }

  /// Whether there are orientations to be had.
  static bool edges_of(int d, CarriedCurve& out) {
    if (has_edges(out.points, d)) return true;
    out.flaw = "an edge of length zero";
    return false;
  }

  const CarriedCurve& of(int curve) const { return out_.curves[at(curve)]; }

  const NamedNumbers* field(const std::string& curve, const char* name) const {
    for (const NamedNumbers& numbers : state_.fields) {
      if (numbers.name == curve + "." + name) return &numbers;
    }
    return nullptr;
  }
  bool any_field(const std::string& curve) const {
    return std::any_of(state_.fields.begin(), state_.fields.end(), [&](const NamedNumbers& numbers) {
      return numbers.name.compare(0, curve.size() + 1, curve + ".") == 0;
    });
  }

  const Scene& scene_;
  const CarriedState& carried_;
  const RecordedState& state_;
  std::vector<DocumentFlaw>& flaws_;
  CarriedCurves out_;
};

}  // namespace

std::vector<double> material_shares(const Curve& curve) {
  const CurveView& view = curve.view;
  std::vector<double> out = curve.arc;
  for (int i = 0; view.extension == Extension::sliding && i + 1 < view.nodes; ++i) {
    const double share = curve.fraction[at(i)];
    out[at(i + 1)] = out[at(i)] + (share > 0.0 ? share * view.start_length : curve.edge_length[at(i)]);
  }
  for (double& share : out) share /= out.back();
  return out;
}

std::vector<double> interpolated_points(const RecordedCurve& recorded, const std::vector<double>& share) {
  if (same_nodes(share, recorded)) return recorded.points;
  const MaterialCurve material(recorded.dimension, recorded.share, recorded.points);
  std::vector<double> out;
  for (const double s : share) append(material.point(s), recorded.dimension, out);
  return out;
}

void compare_scenes(int dimension, const std::vector<NamedKind>& curves, const CarriedState& carried,
                    std::vector<DocumentFlaw>& flaws) {
  const std::string mend = "start from a result of the same scene";
  const RecordedState& state = *carried.state;
  const auto in = [](int d) { return d == 2 ? std::string("in the plane") : std::string("in space"); };
  const auto other = std::find_if(state.curves.begin(), state.curves.end(), [&](const RecordedCurve& one) {
    return one.dimension != 0 && one.dimension != dimension;
  });
  if (other != state.curves.end()) {
    flaws.push_back(
        {carried.name + " is " + in(other->dimension), "a state " + in(dimension) + ", as this scene is", mend});
  }
  const auto word = [](CurveKind kind) { return std::string(kind == CurveKind::wire ? "wire" : "vessel"); };
  std::string vessels;
  for (const auto& [name, kind] : curves) {
    if (kind == CurveKind::vessel) vessels += (vessels.empty() ? "" : ", ") + name;
  }
  const std::string expected = vessels.empty() ? "none, as in this scene" : "the vessels of this scene: " + vessels;
  for (const auto& [name, kind] : curves) {
    const RecordedCurve* recorded = state.find(name);
    if (recorded != nullptr && recorded->kind != kind) {
      flaws.push_back({carried.name + " has '" + name + "' as a " + word(recorded->kind),
                       "a " + word(kind) + ", as in this scene", mend});
    }
    const std::string prefix = name + ".";
    const bool has =
        recorded != nullptr || std::any_of(state.fields.begin(), state.fields.end(), [&](const NamedNumbers& numbers) {
          return numbers.name.compare(0, prefix.size(), prefix) == 0;
        });
    if (!has && kind == CurveKind::vessel) {
      flaws.push_back({carried.name + " has no vessel '" + name + "'", expected, mend});
    }
  }
  for (const RecordedCurve& recorded : state.curves) {
    const bool known =
        std::any_of(curves.begin(), curves.end(), [&](const NamedKind& one) { return one.first == recorded.name; });
    if (known || recorded.kind != CurveKind::vessel) continue;
    flaws.push_back(
        {carried.name + " has a vessel '" + recorded.name + "', which this scene does not have", expected, mend});
  }
}

CarriedCurves carried_curves(const Scene& scene, const CarriedState& carried, std::vector<DocumentFlaw>& flaws) {
  return Carrying(scene, carried, flaws).run();
}

}  // namespace bowstring
