#include "tests/recheck/energies.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace recheck {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A quantity along a curve: one value, or linear between the rows of a table over State 1 arc length.
class Profile {
 public:
  Profile(const Json& json, const std::string& key) {
    if (json.is_object()) {
      if (!json.contains("table") || json.contains("measured-from")) throw UnknownTerm{"form of '" + key + "'"};
      for (const Json& row : json["table"]) {
        arc_.push_back(number_of(row.at(0)));
        value_.push_back(number_of(row.at(1)));
      }
    } else {
      arc_ = {0.0};
      value_ = {number_of(json)};
    }
  }

  double operator()(double arc) const {
    const auto next = std::upper_bound(arc_.begin(), arc_.end(), arc);
    if (next == arc_.begin()) return value_.front();
    if (next == arc_.end()) return value_.back();
    const auto i = static_cast<std::size_t>(next - arc_.begin());
    const double share = (arc - arc_[i - 1]) / (arc_[i] - arc_[i - 1]);
    return value_[i - 1] + share * (value_[i] - value_[i - 1]);
  }

 private:
  std::vector<double> arc_, value_;
};

Profile profile(const Json& term, const char* key) { return Profile(term.contains(key) ? term[key] : Json(0.0), key); }

struct Sum {
  Tape* tape;
  std::vector<double>* gradient;
  double value = 0.0;

  /// Adds one local term, which `term` computes on the cleared tape.
  void add(const std::function<Variable(Tape&)>& term) {
    tape->clear();
    const Variable result = term(*tape);
    tape->add_gradient(result, 1.0, *gradient);
    value += result.value;
  }
};

template <class Scalar>
Scalar squared_bend(Orientation orientation, const Side<Scalar>& a, const Side<Scalar>& b) {
  if (orientation != Orientation::angle) return squared_angle(a.tangent, b.tangent);
  const Scalar angle = plane_angle(a, b);
  return angle * angle;
}

/// ½ Σ EI θ²/Δs, Δs of the wire's material.
void wire_bending(const Json& term, const CurveModel& model, Sum& sum) {
  const Profile stiffness = profile(term, "bending-stiffness");
  for (const Station& station : model.stations()) {
    sum.add([&](Tape& tape) {
      const Side<Variable> a = model.side(tape, station.earlier), b = model.side(tape, station.later);
      return 0.5 * stiffness(station.arc) * squared_bend(model.curve().orientation, a, b) /
             model.station_length(tape, station);
    });
  }
}

/// (θ − θ⁰)² of unsigned angles.
Variable squared_difference(const Variable& squared, double reference) {
  if (reference == 0.0) return squared;
  return squared - 2.0 * reference * sqrt(squared) + reference * reference;
}

/// (ζ − ζ⁰)ᵀ diag(GJ, EI, EI) (ζ − ζ⁰) of one station.
Variable strain_product(const CurveModel& model, const Station& station, double bending, double torsion, Tape& tape) {
  const Side<Variable> a = model.side(tape, station.earlier), b = model.side(tape, station.later);
  const Side<double> a0 = model.reference_side(station.earlier), b0 = model.reference_side(station.later);
  if (model.curve().orientation == Orientation::angle) {
    const Variable change = plane_angle(a, b) - plane_angle(a0, b0);
    return bending * change * change;
  }
  if (model.curve().orientation == Orientation::direction) {
    return bending *
           squared_difference(squared_angle(a.tangent, b.tangent), std::sqrt(squared_angle(a0.tangent, b0.tangent)));
  }
  const Vector<Variable> change = rotation_vector(a.frame, b.frame) - rotation_vector(a0.frame, b0.frame);
  return torsion * change.x * change.x + bending * (change.y * change.y + change.z * change.z);
}

void vessel_strain(const Json& term, const CurveModel& model, Sum& sum) {
  const Profile bending = profile(term, "bending-stiffness"), torsion = profile(term, "torsional-stiffness");
  const Profile stretch = profile(term, "stretch-stiffness");
  for (const Station& station : model.stations()) {
    sum.add([&](Tape& tape) {
      return 0.5 / station.reference_length *
             strain_product(model, station, bending(station.arc), torsion(station.arc), tape);
    });
  }
  for (int i = 0; i < model.curve().edges(); ++i) {
    const double length = model.reference_length(i);
    const double stiffness = stretch(0.5 * (model.arc()[at(i)] + model.arc()[at(i + 1)]));
    if (stiffness == 0.0) continue;
    sum.add([&](Tape& tape) {
      const Variable strain = model.edge_length(tape, i) / length - 1.0;
      return 0.5 * stiffness * length * strain * strain;
    });
  }
}

/// "per node" or "per length" by the unit that stands behind the number.
bool per_length(const Json& stiffness) {
  const std::string text = stiffness.dump();
  if (text.find("N/mm^2") != std::string::npos) return true;
  if (text.find("N/mm") != std::string::npos) return false;
  throw UnknownTerm{"'stiffness' without a unit"};
}

/// ½ Σ k w |p − p⁰|², w = 1 per node, or half of the adjacent State 1 edges.
void springs(const Json& term, const CurveModel& model, Sum& sum) {
  const Profile stiffness = profile(term, "stiffness");
  const bool weighted = per_length(term.at("stiffness"));
  const Curve& curve = model.curve();
  for (int i = 0; i < curve.nodes; ++i) {
    double weight = 1.0;
    if (weighted) {
      weight =
          0.5 * ((i > 0 ? model.reference_length(i - 1) : 0.0) + (i < curve.edges() ? model.reference_length(i) : 0.0));
    }
    sum.add([&](Tape& tape) {
      const Vector<Variable> moved = model.node(tape, i) - curve.reference[at(i)];
      return 0.5 * stiffness(model.arc()[at(i)]) * weight * dot(moved, moved);
    });
  }
}

/// T (Σ|e| − chord) of a wire that slides; no effect otherwise.
void axial_tension(const Json& term, const CurveModel& model, Sum& sum) {
  if (model.curve().extension != Extension::sliding) return;
  const double tension = number_of(term.at("tension"));
  sum.add([&](Tape& tape) { return tension * (model.free_length(tape) + model.held_length() - model.end_distance()); });
}

/// The edge that holds the place of a load, and how far along it.
struct LoadPlace {
  int edge = 0;
  double t = 0.0;
};

LoadPlace load_place(const Json& where, const CurveModel& model) {
  const int last = model.curve().edges() - 1;
  if (where == "first") return {0, 0.0};
  if (where == "last") return {last, 1.0};
  const double arc = number_of(where);
  const auto next = std::upper_bound(model.arc().begin() + 1, model.arc().end() - 1, arc);
  const int edge = static_cast<int>(next - model.arc().begin()) - 1;
  return {edge, (arc - model.arc()[at(edge)]) / (model.arc()[at(edge + 1)] - model.arc()[at(edge)])};
}

/// −F·u, shared between two nodes like a weight on a lever.
void point_load(const Json& term, const CurveModel& model, Sum& sum) {
  const LoadPlace place = load_place(term.at("at"), model);
  const Json& f = term.at("force");
  const Point force{number_of(f.at(0)), number_of(f.at(1)), f.size() > 2 ? number_of(f.at(2)) : 0.0};
  const std::vector<Point>& p0 = model.curve().reference;
  sum.add([&](Tape& tape) {
    const Vector<Variable> u = model.node(tape, place.edge) - p0[at(place.edge)];
    const Vector<Variable> v = model.node(tape, place.edge + 1) - p0[at(place.edge + 1)];
    return -((1.0 - place.t) * dot(u, force) + place.t * dot(v, force));
  });
}

/// −M Δθ of the edge that holds the place.
void dead_moment(const Json& term, const CurveModel& model, Sum& sum) {
  if (model.curve().orientation != Orientation::angle || !model.curve().edge_frames)
    throw UnknownTerm{"dead-moment here"};
  const int edge = load_place(term.at("at"), model).edge;
  const double moment = number_of(term.at("moment"));
  sum.add([&](Tape& tape) { return -moment * (model.side(tape, edge).angle - model.reference_side(edge).angle); });
}

}  // namespace

double energy(const Json& term, const CurveModel& model, Tape& tape, std::vector<double>& gradient) {
  const std::string type = term.at("type").get<std::string>();
  Sum sum{&tape, &gradient};
  if (type == "wire-bending") {
    wire_bending(term, model, sum);
  } else if (type == "vessel-strain") {
    vessel_strain(term, model, sum);
  } else if (type == "anchoring" || type == "extravascular") {
    springs(term, model, sum);
  } else if (type == "axial-tension") {
    axial_tension(term, model, sum);
  } else if (type == "point-load") {
    point_load(term, model, sum);
  } else if (type == "dead-moment") {
    dead_moment(term, model, sum);
  } else {
    throw UnknownTerm{"energy '" + type + "'"};
  }
  return sum.value;
}

}  // namespace recheck
