#include "tests/recheck/rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/recheck/energies.hpp"

namespace recheck {

namespace {

constexpr double tie = 1e-7;  // mm: two places of the wall are equally near
constexpr int window = 2;     // vessel segments on each side of a row's place
constexpr double on_node = 1e-12;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

const std::vector<double>& multipliers(const RowWork& work, const std::string& group, std::size_t rows) {
  static const std::vector<double> none;
  const auto found = work.result->multipliers.find(group);
  const std::vector<double>& out = found == work.result->multipliers.end() ? none : found->second;
  if (out.size() == rows) return out;
  throw std::runtime_error("state.multipliers has " + std::to_string(out.size()) + " numbers for '" + group +
                           "'; expected " + std::to_string(rows));
}

void add_equality(const Variable& row, double multiplier, const std::string& place, RowWork& work) {
  work.tape.add_gradient(row, multiplier, work.gradient);
  work.findings.violation.see(std::abs(row.value), place);
}

/// Edges with closure rows.
std::vector<int> closed_edges(const CurveModel& model) {
  std::vector<int> out;
  const Curve& curve = model.curve();
  if (!curve.edge_frames && !curve.wire) return out;
  for (int i = 0; i < curve.edges(); ++i) {
    if (!curve.edge_held(i)) out.push_back(i);
  }
  return out;
}

double radius_along(const Curve& wire, int edge, double t) {
  if (wire.radius.empty()) return 0.0;
  return (1.0 - t) * wire.radius[at(edge)] + t * wire.radius[at(edge + 1)];
}

Point chord_point(const Curve& wire, int edge, double t) {
  return (1.0 - t) * wire.position[at(edge)] + t * wire.position[at(edge + 1)];
}

double sigma_of_arc(const CurveModel& vessel, double arc) {
  const std::vector<double>& s = vessel.arc();
  const auto next = std::upper_bound(s.begin() + 1, s.end() - 1, arc);
  const auto i = static_cast<std::size_t>(next - s.begin()) - 1;
  return static_cast<double>(i) + std::clamp((arc - s[i]) / (s[i + 1] - s[i]), 0.0, 1.0);
}

/// Where the wire's first node starts: at its span's arc length where it starts along this vessel, else anywhere.
WallPoint first_place(const CurveModel& wire, const CurveModel& vessel, const Wall& wall) {
  const Json& table = wire.curve().description;
  const double radius = radius_along(wire.curve(), 0, 0.0);
  const Point& x = wire.curve().position.front();
  if (table.contains("geometry") || table.value("vessel", "") != vessel.curve().name)
    return wall.lowest(x, radius, 0.0, -1);
  const double begin = table.contains("span") ? number_of(table["span"].at(0)) : 0.0;
  return wall.lowest(x, radius, sigma_of_arc(vessel, begin), window);
}

/// κh²/4, at most c, + c/20: κ the vessel's largest curvature at a node, h the wire's longest chord, c the least
/// clearance.
double allowance(const CurveModel& wire, const CurveModel& vessel) {
  double curvature = 0.0, chord = 0.0;
  const Curve& v = vessel.curve();
  for (int i = 1; i < v.edges(); ++i) {
    const Point a = v.position[at(i)] - v.position[at(i - 1)], b = v.position[at(i + 1)] - v.position[at(i)];
    const double angle = std::sqrt(squared_angle(unit(a), unit(b)));
    curvature = std::max(curvature, angle / (0.5 * (norm(a) + norm(b))));
  }
  for (int i = 0; i < wire.curve().edges(); ++i) chord = std::max(chord, wire.current_length(i));
  const double clearance = *std::min_element(v.radius.begin(), v.radius.end()) -
                           *std::max_element(wire.curve().radius.begin(), wire.curve().radius.end());
  return std::min(0.25 * curvature * chord * chord, clearance) + clearance / 20.0;
}

struct ContactPlan {
  std::string name, type;
  const CurveModel *wire = nullptr, *vessel = nullptr;
  int vessel_index = 0;
  bool outside = false, spline = true;
  int per_segment = 1;
};

/// One row's place.
struct Place {
  int edge = 0;
  double t = 0.0;

  double coordinate() const { return edge + t; }
};

GapForm gap_form(const Json& constraint) {
  const std::string gap = constraint.value("gap", "squared");
  if (gap == "squared") return GapForm::squared;
  if (gap == "distance") return GapForm::distance;
  if (gap == "smooth-distance") return GapForm::smooth_distance;
  throw UnknownTerm{"gap '" + gap + "' of constraint '" + constraint.value("name", "") + "'"};
}

/// Every node that is not wholly held, and the stations between nodes of segments that are not.
std::vector<Place> node_places(const ContactPlan& plan) {
  const Curve& wire = plan.wire->curve();
  std::vector<Place> out;
  for (int i = 0; i < wire.nodes; ++i) {
    if (!wire.wholly_held(i)) out.push_back(i < wire.edges() ? Place{i, 0.0} : Place{i - 1, 1.0});
    if (i == wire.edges() || (wire.wholly_held(i) && wire.wholly_held(i + 1))) continue;
    for (int k = 1; k < plan.per_segment; ++k) out.push_back({i, static_cast<double>(k) / plan.per_segment});
  }
  return out;
}

/// Rows at nodes that are not wholly held, each followed by those of its segment: one in each of its parts, which
/// stands where `contacts` says, and one between each two parts. Throws where a segment has none.
std::vector<Place> segment_places(const ContactPlan& plan, const std::vector<ContactEntry>& entries,
                                  std::size_t first) {
  const Curve& wire = plan.wire->curve();
  std::vector<Place> out;
  std::size_t row = first;
  for (int i = 0; i < wire.nodes; ++i) {
    if (!wire.wholly_held(i)) {
      out.push_back(i < wire.edges() ? Place{i, 0.0} : Place{i - 1, 1.0});
      ++row;
    }
    if (i == wire.edges() || (wire.wholly_held(i) && wire.wholly_held(i + 1))) continue;
    for (int k = 0; k < plan.per_segment; ++k) {
      if (k > 0) {
        out.push_back({i, static_cast<double>(k) / plan.per_segment});
        ++row;
      }
      out.push_back({i, entries.at(row++).coordinate - i});
    }
  }
  for (const Place& place : out) {
    if (place.t >= -on_node && place.t <= 1.0 + on_node) continue;
    throw std::runtime_error("segment " + std::to_string(place.edge) + " of '" + wire.name + "' has no row of '" +
                             plan.name + "'");
  }
  return out;
}

WallPoint near_sample(const Following& following, const Place& place) {
  const double sample = place.coordinate() * samples_per_segment;
  return following.samples[std::min(static_cast<std::size_t>(std::lround(sample)), following.samples.size() - 1)];
}

/// The lowest gap near the followed place. Where another place is as near, to rounding, the one that the document
/// names. Behind a crossed wall the following says nothing more, and rows are judged where the document has them.
WallPoint row_point(const ContactPlan& plan, const Wall& wall, const Place& place, const Following& following,
                    double named_arc) {
  const Point x = chord_point(plan.wire->curve(), place.edge, place.t);
  const double radius = radius_along(plan.wire->curve(), place.edge, place.t);
  if (plan.type == "same-index-contact") return wall.at(x, radius, place.coordinate());
  const double followed = near_sample(following, place).sigma;
  if (!std::isfinite(named_arc)) return wall.lowest(x, radius, followed, window);
  const WallPoint named = wall.descend(x, radius, sigma_of_arc(*plan.vessel, named_arc));
  const WallPoint start = following.crossed() ? named : wall.descend(x, radius, followed);
  const bool by_limb = plan.type == "node-wise-contact" && !plan.outside && plan.spline;
  const WallPoint found = by_limb ? wall.past_ridges(x, radius, start) : wall.lowest(x, radius, start.sigma, window);
  return std::abs(named.gap - found.gap) <= tie ? named : found;
}

/// h as a function of the unknowns at fixed σ*, which has its derivatives (envelope theorem).
Variable row_on_tape(const ContactPlan& plan, const Wall& wall, GapForm form, const Place& place, double sigma,
                     Tape& tape) {
  const Curve& wire = plan.wire->curve();
  Vector<Variable> d{0.0, 0.0, 0.0};
  if (place.t < 1.0) d = d + (1.0 - place.t) * plan.wire->node(tape, place.edge);
  if (place.t > 0.0) d = d + place.t * plan.wire->node(tape, place.edge + 1);
  for (const auto& [node, weight] : wall.weights(sigma)) d = d - weight * plan.vessel->node(tape, node);
  const double radius = radius_along(wire, place.edge, place.t);
  const double c = plan.outside ? wall.lumen_radius(sigma) + radius : wall.lumen_radius(sigma) - radius;
  const Variable a = dot(d, d);
  const GapJet f = gap_of(form, a.value, c);
  const double side = plan.outside ? -1.0 : 1.0;
  return tape.unary(side * f.value, a, side * f.by_a);
}

/// The largest gap along a straight chord: the highest sample, then the highest of ever finer ones beside it.
double chord_maximum(const ContactPlan& plan, const Wall& wall, const Following& following, int edge) {
  const Curve& wire = plan.wire->curve();
  const auto gap = [&](double t) {
    const Place place{edge, std::clamp(t, 0.0, 1.0)};
    return wall
        .descend(chord_point(wire, edge, place.t), radius_along(wire, edge, place.t),
                 near_sample(following, place).sigma)
        .gap;
  };
  double best = 0.0, value = gap(0.0);
  for (int k = 1; k <= samples_per_segment; ++k) {
    const double t = static_cast<double>(k) / samples_per_segment, candidate = gap(t);
    if (candidate > value) best = t, value = candidate;
  }
  for (double step = 0.5 / samples_per_segment; step > 1e-6; step *= 0.5) {
    for (const double t : {best - step, best + step}) {
      const double candidate = gap(t);
      if (candidate > value) best = std::clamp(t, 0.0, 1.0), value = candidate;
    }
  }
  return value;
}

int rows_per_segment(const Json& constraint, const ContactPlan& plan, std::size_t rows) {
  if (!constraint.contains("rows-per-segment")) return 1;
  if (constraint["rows-per-segment"].is_number()) return constraint["rows-per-segment"].get<int>();
  if (plan.type == "segment-wise-contact") return 1;
  ContactPlan one = plan;
  for (one.per_segment = 1; one.per_segment < 1000; ++one.per_segment) {
    if (node_places(one).size() >= rows) return one.per_segment;
  }
  return 1;
}

ContactPlan contact_plan(const Json& constraint, const RowWork& work, std::size_t rows) {
  ContactPlan plan;
  plan.type = constraint.at("type").get<std::string>();
  plan.name = constraint.value("name", plan.type);
  if (plan.type != "node-wise-contact" && plan.type != "segment-wise-contact" && plan.type != "same-index-contact") {
    throw UnknownTerm{"constraint '" + plan.type + "'"};
  }
  plan.wire = &(*work.models)[at(work.result->index(constraint.at("on").at(0).get<std::string>()))];
  plan.vessel = &(*work.models)[at(work.result->index(constraint.at("on").at(1).get<std::string>()))];
  plan.outside = constraint.value("side", "inside") == "outside";
  plan.spline = constraint.value("centerline", "spline") == "spline";
  plan.per_segment = rows_per_segment(constraint, plan, rows);
  return plan;
}

void add_contact_row(const ContactPlan& plan, const Wall& wall, GapForm form, const Place& place,
                     const WallPoint& point, double multiplier, const ContactEntry& entry, RowWork& work) {
  work.tape.clear();
  const Variable row = row_on_tape(plan, wall, form, place, point.sigma, work.tape);
  work.tape.add_gradient(row, multiplier, work.gradient);
  const std::string where = "row at " + std::to_string(place.coordinate()) + " of '" + plan.name + "'";
  RowFindings& out = work.findings;
  out.violation.see(row.value, where);
  out.complementarity.see(std::abs(multiplier * row.value), where);
  out.negative.see(-multiplier, where);
  out.smallest_multiplier = std::min(out.smallest_multiplier, multiplier);
  out.contact_entry.see(std::abs(entry.force - multiplier), "force_N, " + where);
  out.contact_entry.see(std::abs(entry.gap - row.value) / (1.0 + std::abs(row.value)), "gap_mm, " + where);
  out.contact_entry.see(std::abs(entry.coordinate - place.coordinate()), "wire_edge and t, " + where);
}

}  // namespace

void add_closure_rows(const CurveModel& model, RowWork& work) {
  const Curve& curve = model.curve();
  const std::vector<int> edges = closed_edges(model);
  if (edges.empty()) return;
  const int each = curve.edge_frames ? curve.dimension : 1;
  const std::vector<double>& lambda = multipliers(work, curve.name + ".closure", edges.size() * at(each));
  std::size_t row = 0;
  for (const int i : edges) {
    work.tape.clear();
    const std::string place = "closure of edge " + std::to_string(i) + " of '" + curve.name + "'";
    const Vector<Variable> e = model.node(work.tape, i + 1) - model.node(work.tape, i);
    const Variable length = model.edge_length(work.tape, i);
    if (!curve.edge_frames) {
      add_equality(norm(e) - length, lambda[row++], place, work);
      continue;
    }
    const Vector<Variable> r = e - length * model.side(work.tape, i).tangent;
    const Variable parts[3] = {r.x, r.y, r.z};
    for (int k = 0; k < curve.dimension; ++k) add_equality(parts[k], lambda[row++], place, work);
  }
}

void add_end_rows(const CurveModel& model, RowWork& work) {
  const Curve& curve = model.curve();
  const std::size_t rows = curve.rigid ? 0 : curve.end[0].row_axes.size() + curve.end[1].row_axes.size();
  if (rows == 0) return;
  const std::string group = "ends of '" + curve.name + "'";
  const std::vector<double>& lambda = multipliers(work, group, rows);
  std::size_t row = 0;
  for (int e = 0; e < 2; ++e) {
    const int node = e == 0 ? 0 : curve.nodes - 1;
    const Point held = curve.state1[at(node)] + curve.end[e].move;
    for (const Point& axis : curve.end[e].row_axes) {
      work.tape.clear();
      add_equality(dot(model.node(work.tape, node) - held, axis), lambda[row++], group, work);
    }
  }
}

Following follow(const CurveModel& wire, const CurveModel& vessel) {
  const Curve& w = wire.curve();
  const Curve& v = vessel.curve();
  const Wall wall(v.position, v.radius, true, GapForm::squared, false);
  Following out;
  out.crossing_allowance = allowance(wire, vessel);
  out.depth.value = -std::numeric_limits<double>::infinity();
  double sigma = first_place(wire, vessel, wall).sigma;
  for (int k = 0; k <= w.edges() * samples_per_segment; ++k) {
    const int edge = std::min(k / samples_per_segment, w.edges() - 1);
    const double t = static_cast<double>(k - edge * samples_per_segment) / samples_per_segment;
    const Point x = chord_point(w, edge, t);
    const double radius = radius_along(w, edge, t);
    WallPoint point = wall.descend(x, radius, sigma);
    if (point.depth > 0.0) {
      const WallPoint beyond = wall.past_ridges(x, radius, point);
      if (beyond.depth < point.depth) point = beyond;
    }
    sigma = point.sigma;
    out.samples.push_back(point);
    if (!(point.depth <= out.depth.value)) {
      out.depth.see(point.depth, "segment " + std::to_string(edge) + " of '" + w.name + "'");
    }
  }
  return out;
}

void add_contact_rows(const Json& constraint, const Following& following, std::size_t entry, RowWork& work) {
  const std::string name = constraint.value("name", constraint.at("type").get<std::string>());
  const auto group = work.result->multipliers.find(name);
  const std::size_t count = group == work.result->multipliers.end() ? 0 : group->second.size();
  const ContactPlan plan = contact_plan(constraint, work, count);
  const GapForm form = gap_form(constraint);
  const bool by_segment = plan.type == "segment-wise-contact";
  const std::vector<Place> places = by_segment ? segment_places(plan, work.result->contacts, entry) : node_places(plan);
  const std::vector<double>& mu = multipliers(work, name, places.size());
  const Curve& vessel = plan.vessel->curve();
  const Wall wall(vessel.position, vessel.radius, plan.spline, form, plan.outside);
  for (std::size_t r = 0; r < places.size(); ++r) {
    const ContactEntry& named = work.result->contacts.at(entry++);
    const WallPoint point = row_point(plan, wall, places[r], following, named.vessel_arc);
    add_contact_row(plan, wall, form, places[r], point, mu[r], named, work);
  }
  if (!by_segment || plan.outside || following.crossed()) return;
  const Curve& wire = plan.wire->curve();
  for (int i = 0; i < wire.edges(); ++i) {
    if (wire.wholly_held(i) && wire.wholly_held(i + 1)) continue;
    work.findings.chord.see(chord_maximum(plan, wall, following, i),
                            "chord " + std::to_string(i) + " of '" + wire.name + "'");
  }
}

}  // namespace recheck
