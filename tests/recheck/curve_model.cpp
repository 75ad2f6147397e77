#include "tests/recheck/curve_model.hpp"

#include <algorithm>
#include <cmath>

namespace recheck {

namespace {

constexpr double smallest_edge_share = 0.2;  // MODEL: ℓ ≥ 0.2 ℓ⁰ bounds an edge whose length is an unknown

Vector<Variable> lift(const Point& p) { return {p.x, p.y, p.z}; }
Frame<Variable> lift(const Frame<double>& f) { return {lift(f.x), lift(f.y), lift(f.z)}; }
Side<Variable> lift(const Side<double>& s) { return {s.has_angle, s.angle, lift(s.tangent), lift(s.frame)}; }

Side<double> angle_side(double angle) {
  Side<double> out;
  out.has_angle = true;
  out.angle = angle;
  out.tangent = {std::cos(angle), std::sin(angle), 0.0};
  return out;
}

Side<double> frame_side(const Frame<double>& frame) {
  Side<double> out;
  out.tangent = frame.x;
  out.frame = frame;
  return out;
}

Frame<double> transported(const Frame<double>& frame, const Point& tangent) {
  return {tangent, least_turn(frame.x, tangent, frame.y), least_turn(frame.x, tangent, frame.z)};
}

/// State 1's orientation with this tangent, next to a known one.
Side<double> next_to(const Side<double>& known, const Point& tangent, bool plane) {
  if (!plane) return frame_side(transported(known.frame, tangent));
  return angle_side(known.angle + std::atan2(cross(known.tangent, tangent).z, dot(known.tangent, tangent)));
}

/// The first edge's orientation in State 1: its angle, or the least turn of the global axes.
Side<double> first_side(const Point& tangent, bool plane) {
  if (plane) return angle_side(std::atan2(tangent.y, tangent.x));
  const Frame<double> global{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const Frame<double> half_turn{{-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0}};
  return frame_side(tangent.x > -1.0 ? transported(global, tangent) : half_turn);
}

/// v turned by a rotation vector (O. Rodrigues).
Point turned(const Point& rotation, const Point& v) {
  const double angle = norm(rotation);
  if (angle == 0.0) return v;
  const Point axis = (1.0 / angle) * rotation;
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1.0 - std::cos(angle)) * dot(axis, v)) * axis;
}

double largest(const Point& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

double component(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// A maximum that keeps what is not a number.
double worse(double a, double b) { return !(b <= a) ? b : a; }

}  // namespace

CurveModel::CurveModel(const Curve& curve, std::vector<Unknown>& unknowns) : curve_(&curve) {
  arc_.push_back(0.0);
  for (int i = 0; i < curve.edges(); ++i) {
    arc_.push_back(arc_.back() + norm(curve.state1[index(i + 1)] - curve.state1[index(i)]));
  }
  find_reference_orientations();
  add_stations();
  add_positions(unknowns);
  add_orientations(unknowns);
  add_lengths(unknowns);
}

void CurveModel::add_positions(std::vector<Unknown>& unknowns) {
  position_slot_ = static_cast<int>(unknowns.size());
  for (int i = 0; i < curve_->nodes; ++i) {
    for (int k = 0; k < curve_->dimension; ++k) {
      unknowns.push_back({"node " + std::to_string(i) + " of '" + curve_->name + "'", !curve_->position_held(i, k)});
    }
  }
}

void CurveModel::add_orientations(std::vector<Unknown>& unknowns) {
  const int own = curve_->orientation == Orientation::angle ? 1 : curve_->orientation == Orientation::direction ? 2 : 3;
  const int of_nodes = curve_->orientation == Orientation::frame ? 1 : 0;
  rotations_ = curve_->edge_frames ? own : of_nodes;
  orientation_slot_ = static_cast<int>(unknowns.size());
  for (int i = 0; i < curve_->edges() * rotations_; ++i) {
    const int edge = i / rotations_;
    unknowns.push_back({"edge " + std::to_string(edge) + " of '" + curve_->name + "' (rotation)",
                        !curve_->edge_held(edge), mean_length_near(edge)});
  }
}

void CurveModel::add_lengths(std::vector<Unknown>& unknowns) {
  edge_length_slot_ = static_cast<int>(unknowns.size());
  for (int i = 0; i < static_cast<int>(curve_->edge_length.size()); ++i) {
    unknowns.push_back({"length of edge " + std::to_string(i) + " of '" + curve_->name + "'", !curve_->edge_held(i),
                        1.0, curve_->edge_length[index(i)], smallest_edge_share * reference_length(i)});
  }
  length_slot_ = static_cast<int>(unknowns.size());
  if (!curve_->length) return;
  unknowns.push_back(
      {"length of '" + curve_->name + "'", !curve_->rigid, 1.0, *curve_->length, 0.5 * end_distance() - held_length()});
}

void CurveModel::find_reference_orientations() {
  const bool plane = curve_->dimension == 2;
  for (int i = 0; i < curve_->edges(); ++i) {
    const Point tangent = unit(curve_->reference[index(i + 1)] - curve_->reference[index(i)]);
    reference_.push_back(i == 0 ? first_side(tangent, plane) : next_to(reference_.back(), tangent, plane));
  }
  for (int e = 0; e < 2; ++e) {
    if (curve_->held_tangent(e) < 0) continue;
    const Side<double>& end_edge = reference_[index(e == 0 ? 0 : curve_->edges() - 1)];
    const Point& tangent = curve_->later_rest ? curve_->rest_tangent[e] : curve_->end[e].tangent;
    reference_.push_back(next_to(end_edge, tangent, plane));
  }
}

/// One station per interior node, and half of one between a held tangent and its edge.
void CurveModel::add_stations() {
  const int last = curve_->edges() - 1;
  if (curve_->held_tangent(0) >= 0) {
    const double length = reference_length(0);
    stations_.push_back({curve_->edges() + curve_->held_tangent(0), 0, 0.5 * length, 0.25 * length});
  }
  for (int i = 1; i <= last; ++i) {
    stations_.push_back({i - 1, i, 0.5 * (reference_length(i - 1) + reference_length(i)), arc_[index(i)]});
  }
  if (curve_->held_tangent(1) >= 0) {
    const double length = reference_length(last);
    stations_.push_back({last, curve_->edges() + curve_->held_tangent(1), 0.5 * length, arc_.back() - 0.25 * length});
  }
}

double CurveModel::reference_length(int edge) const {
  if (!curve_->later_rest) return arc_[index(edge + 1)] - arc_[index(edge)];
  return norm(curve_->reference[index(edge + 1)] - curve_->reference[index(edge)]);
}

double CurveModel::held_length() const {
  double sum = 0.0;
  for (int i = 0; i < curve_->edges(); ++i) sum += curve_->edge_held(i) ? reference_length(i) : 0.0;
  return sum;
}

double CurveModel::end_distance() const {
  const Point first = curve_->state1.front() + curve_->end[0].move;
  return norm(curve_->state1.back() + curve_->end[1].move - first);
}

double CurveModel::current_length(int edge) const {
  return norm(curve_->position[index(edge + 1)] - curve_->position[index(edge)]);
}

double CurveModel::mean_length_near(int edge) const {
  const int begin = std::max(edge - 1, 0), end = std::min(edge + 1, curve_->edges() - 1);
  double sum = 0.0;
  for (int i = begin; i <= end; ++i) sum += current_length(i);
  return sum / (end - begin + 1);
}

Vector<Variable> CurveModel::node(Tape& tape, int node) const {
  const Point& p = curve_->position[index(node)];
  const int slot = position_slot_ + node * curve_->dimension;
  return {tape.input(p.x, slot), tape.input(p.y, slot + 1), curve_->dimension == 3 ? tape.input(p.z, slot + 2) : p.z};
}

Vector<Variable> CurveModel::edge_vector(Tape& tape, int edge) const { return node(tape, edge + 1) - node(tape, edge); }

/// An orientation that is an unknown: R Exp(δ) at δ = 0, where R (1 + [δ]×) has the same value and first derivative.
Side<Variable> CurveModel::own_side(Tape& tape, int edge) const {
  const int slot = orientation_slot(edge);
  Side<Variable> out;
  if (curve_->orientation == Orientation::angle) {
    using std::cos, std::sin;
    out.has_angle = true;
    out.angle = tape.input(curve_->angle[index(edge)], slot);
    out.tangent = {cos(out.angle), sin(out.angle), 0.0};
    return out;
  }
  const bool turns = curve_->orientation == Orientation::frame;
  const Variable d1 = turns ? tape.input(0.0, slot) : Variable(0.0);
  const Variable d2 = tape.input(0.0, slot + (turns ? 1 : 0)), d3 = tape.input(0.0, slot + (turns ? 2 : 1));
  const Frame<double>& r = curve_->frame[index(edge)];
  out.frame = {lift(r.x) + d3 * r.y - d2 * r.z, lift(r.y) + d1 * r.z - d3 * r.x, lift(r.z) + d2 * r.x - d1 * r.y};
  out.tangent = out.frame.x;
  return out;
}

/// An orientation that follows from the nodes: R = P(a → t) F Exp(φ e₁), F State 1's frame and a its tangent.
Side<Variable> CurveModel::node_side(Tape& tape, int edge) const {
  Side<Variable> out;
  out.tangent = unit(edge_vector(tape, edge));
  if (curve_->orientation != Orientation::frame) return out;
  const Frame<double>& f = reference_[index(edge)].frame;
  const Vector<Variable> y = least_turn(f.x, out.tangent, f.y), z = least_turn(f.x, out.tangent, f.z);
  const Variable angle = tape.input(curve_->angle[index(edge)], orientation_slot(edge));
  const Variable c = cos(angle), s = sin(angle);
  out.frame = {out.tangent, c * y + s * z, c * z - s * y};
  return out;
}

Side<double> CurveModel::held_side(int held) const {
  return curve_->dimension == 2 ? angle_side(curve_->held_angle.at(index(held)))
                                : frame_side(curve_->held_frame.at(index(held)));
}

Side<Variable> CurveModel::side(Tape& tape, int orientation) const {
  if (orientation >= curve_->edges()) return lift(held_side(orientation - curve_->edges()));
  return curve_->edge_frames ? own_side(tape, orientation) : node_side(tape, orientation);
}

Side<double> CurveModel::reference_side(int orientation) const { return reference_[index(orientation)]; }

Variable CurveModel::free_length(Tape& tape) const { return tape.input(*curve_->length, length_slot_); }

Variable CurveModel::edge_length(Tape& tape, int edge) const {
  if (!curve_->edge_length.empty()) return tape.input(curve_->edge_length[index(edge)], edge_length_slot_ + edge);
  if (curve_->extension == Extension::stretching) return norm(edge_vector(tape, edge));
  if (curve_->length && !curve_->edge_held(edge)) return curve_->share[index(edge)] * free_length(tape);
  return reference_length(edge);
}

Variable CurveModel::station_length(Tape& tape, const Station& station) const {
  Variable sum = 0.0;
  for (const int edge : {station.earlier, station.later}) {
    if (edge < curve_->edges()) sum = sum + 0.5 * edge_length(tape, edge);
  }
  return sum;
}

Side<double> CurveModel::expected_held(int e) const {
  const End& end = curve_->end[e];
  Side<double> out = reference_[index(curve_->edges() + curve_->held_tangent(e))];
  if (curve_->dimension == 2) return angle_side(out.angle + end.turn.z);
  const Frame<double> f = out.frame;
  const double c = std::cos(end.twist), s = std::sin(end.twist);
  const Point y = c * f.y + s * f.z, z = c * f.z - s * f.y;
  return frame_side({turned(end.turn, f.x), turned(end.turn, y), turned(end.turn, z)});
}

double CurveModel::held_error() const {
  double error = 0.0;
  for (int i = 0; i < curve_->nodes; ++i) {
    Point moved = curve_->rigid ? curve_->reference[index(i)] : curve_->state1[index(i)];
    if (i <= 1 && curve_->position_held(i, 0) + curve_->position_held(i, 1) + curve_->position_held(i, 2) > 0) {
      moved = moved + curve_->end[0].move;
    } else if (i >= curve_->nodes - 2) {
      moved = moved + curve_->end[1].move;
    }
    for (int k = 0; k < curve_->dimension; ++k) {
      if (!curve_->position_held(i, k)) continue;
      error = worse(error, std::abs(component(curve_->position[index(i)] - moved, k)));
    }
  }
  for (int e = 0; e < 2; ++e) {
    const int held = curve_->held_tangent(e);
    if (held < 0) continue;
    const Side<double> found = held_side(held);
    if (curve_->later_rest) {
      // Frames are counted anew from that state, and so are whole turns: what is left is the direction.
      error = worse(error, largest(found.tangent - turned(curve_->end[e].turn, curve_->end[e].tangent)));
      continue;
    }
    const Side<double> expected = expected_held(e);
    if (curve_->dimension == 2) {
      error = worse(error, std::abs(found.angle - expected.angle));
    } else {
      error = worse(error, largest(found.tangent - expected.tangent));
      if (curve_->orientation == Orientation::frame) error = worse(error, largest(found.frame.y - expected.frame.y));
    }
  }
  return error;
}

}  // namespace recheck
