#include "tests/recheck/recheck.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/recheck/energies.hpp"

namespace recheck {

namespace {

constexpr double agreement = 1e-9;     // of reported numbers with recomputed ones, relative where they exceed 1
constexpr double same_number = 1e-12;  // of numbers that stand twice in the document
constexpr double at_bound = 1e-8;      // mm

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

class Recheck {
 public:
  explicit Recheck(const Result& result) : result_(result) {
    for (const Curve& curve : result.curves) models_.emplace_back(curve, unknowns_);
    work_.result = &result;
    work_.models = &models_;
    work_.gradient.assign(unknowns_.size(), 0.0);
    out_.status = result.status;
    out_.not_rechecked = result.unknown;
  }

  Findings run() {
    check_consistency();
    add_energies();
    for (const CurveModel& model : models_) {
      add_closure_rows(model, work_);
      add_end_rows(model, work_);
    }
    out_.depth = std::numeric_limits<double>::quiet_NaN();
    add_contacts();
    check_multiplier_groups();
    find_stationarity();
    find_rounding_floor();
    check_folds();
    judge();
    return out_;
  }

 private:
  void require(bool holds, const std::string& reason) {
    if (!holds) out_.reasons.push_back(reason);
  }

  void require_below(const Worst& worst, double limit, const char* what, const char* unit) {
    require(worst.value <= limit, std::string(what) + " " + text(worst.value) + " " + unit + " (" + worst.place + ")");
  }

  /// Numbers that the document holds twice, and what its ends hold.
  void check_consistency() {
    for (std::size_t c = 0; c < models_.size(); ++c) {
      const Curve& curve = result_.curves[c];
      Worst worst;
      for (int i = 0; i < curve.nodes; ++i) {
        const Point d = curve.points.at(at(i)) - curve.position[at(i)];
        worst.see(norm(d), "node " + std::to_string(i) + " of '" + curve.name + "'");
      }
      require_below(worst, same_number, "points and state differ by", "mm");
      Worst held;
      held.see(models_[c].held_error(), "'" + curve.name + "'");
      require_below(held, agreement, "what the ends hold is off by", "mm or rad");
      check_radius(models_[c]);
    }
  }

  void check_radius(const CurveModel& model) {
    const Json& table = model.curve().description;
    if (!table.contains("radius") || !(table["radius"].is_number() || table["radius"].is_string())) return;
    Worst worst;
    for (const double r : model.curve().radius)
      worst.see(std::abs(r - number_of(table["radius"])), "'" + model.curve().name + "'");
    require_below(worst, same_number, "radius_mm and the composition differ by", "mm");
  }

  void see_energy(const std::string& name, double value) {
    const auto reported = result_.energy.find(name);
    const double found = reported == result_.energy.end() ? std::numeric_limits<double>::quiet_NaN() : reported->second;
    out_.energy_difference.see(std::abs(found - value), name);
    require(std::abs(found - value) <= agreement * std::max(1.0, std::abs(value)),
            "energy '" + name + "' is " + text(found) + " N mm in the document and off by " + text(found - value));
  }

  void add_energies() {
    bool all = true;
    for (const Json& term : result_.energies) {
      try {
        const CurveModel& model = models_[at(result_.index(term.at("on").get<std::string>()))];
        const double value = energy(term, model, work_.tape, work_.gradient);
        out_.total_energy += value;
        see_energy(term.value("name", term.at("type").get<std::string>()), value);
      } catch (const UnknownTerm& unknown) {
        out_.not_rechecked.push_back(unknown.what);
        all = false;
      }
    }
    if (all) see_energy("total", out_.total_energy);
  }

  void add_contacts() {
    std::size_t entry = 0;
    for (const Json& constraint : result_.constraints) {
      const std::string name = constraint.value("name", constraint.at("type").get<std::string>());
      const auto rows = result_.multipliers.find(name);
      const std::size_t next = entry + (rows == result_.multipliers.end() ? 0 : rows->second.size());
      try {
        add_contact(constraint, entry);
      } catch (const UnknownTerm& unknown) {
        out_.not_rechecked.push_back(unknown.what);
      }
      known_groups_.push_back(name);
      entry = next;
    }
  }

  void add_contact(const Json& constraint, std::size_t entry) {
    const std::vector<std::string> on = constraint.at("on").get<std::vector<std::string>>();
    if (on.size() != 2) throw UnknownTerm{"constraint '" + constraint.value("type", "") + "'"};
    const CurveModel& wire = models_[at(result_.index(on[0]))];
    const CurveModel& vessel = models_[at(result_.index(on[1]))];
    if (wire.curve().radius.empty() || vessel.curve().radius.empty()) throw UnknownTerm{"a contact without radii"};
    const Following following = follow(wire, vessel);
    if (constraint.value("side", "inside") == "inside") judge_depth(following);
    add_contact_rows(constraint, following, entry, work_);
  }

  void judge_depth(const Following& following) {
    if (!(following.depth.value <= out_.depth)) out_.depth = following.depth.value;
    require_below(following.depth, following.crossing_allowance, "the wall is crossed by", "mm");
  }

  /// A multiplier whose row this program does not know would be missing in the Lagrangian.
  void check_multiplier_groups() {
    for (const Curve& curve : result_.curves) {
      known_groups_.push_back(curve.name + ".closure");
      known_groups_.push_back("ends of '" + curve.name + "'");
    }
    for (const auto& [group, values] : result_.multipliers) {
      const bool known = std::find(known_groups_.begin(), known_groups_.end(), group) != known_groups_.end();
      if (!known && !values.empty()) out_.not_rechecked.push_back("rows '" + group + "'");
    }
  }

  /// Largest entry of the gradient of the Lagrangian; at a lower bound only what pushes away from it counts.
  void find_stationarity() {
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const Unknown& unknown = unknowns_[u];
      if (!unknown.free) continue;
      double slope = work_.gradient[u] / unknown.per_length;
      const bool bound = unknown.value - unknown.lower <= at_bound;
      require(!bound, unknown.place + " is on its bound, which no equilibrium of a curve is");
      if (bound) slope = std::min(slope, 0.0);
      out_.stationarity.see(std::abs(slope), unknown.place);
    }
  }

  /// What rounding leaves: about EI ε |p|/h³ of node positions, EI ε π/h² of edge frames.
  void find_rounding_floor() {
    for (const Json& term : result_.energies) {
      if (!term.contains("bending-stiffness") || !term["bending-stiffness"].is_number()) continue;
      const CurveModel& model = models_[at(result_.index(term.at("on").get<std::string>()))];
      double h = std::numeric_limits<double>::infinity(), extent = 0.0;
      for (int i = 0; i < model.curve().edges(); ++i) h = std::min(h, model.current_length(i));
      for (const Point& p : model.curve().position) extent = std::max(extent, norm(p));
      const double unit = number_of(term["bending-stiffness"]) * std::numeric_limits<double>::epsilon();
      const double floor = model.curve().edge_frames ? unit * std::acos(-1.0) / (h * h) : unit * extent / (h * h * h);
      out_.rounding_floor = std::max(out_.rounding_floor, floor);
    }
  }

  /// Vessel edges shorter than a share of State 1's, or turned by more than 90° against the edge before.
  void check_folds() {
    for (const CurveModel& model : models_) {
      const Curve& curve = model.curve();
      for (int i = 0; !curve.wire && i < curve.edges(); ++i) {
        const std::string place = "edge " + std::to_string(i) + " of '" + curve.name + "'";
        const double stretch = model.current_length(i) / model.reference_length(i);
        require(stretch > result_.thresholds.stretch, place + " is folded, stretch ratio " + text(stretch));
        if (i == 0) continue;
        const Point before = curve.position[at(i)] - curve.position[at(i - 1)];
        const Point after = curve.position[at(i + 1)] - curve.position[at(i)];
        require(dot(before, after) > 0.0, place + " turns by more than 90 degrees");
      }
    }
  }

  void judge() {
    out_.rows = work_.findings;
    const Thresholds& limit = result_.thresholds;
    // Without a term the others do not balance, which says nothing of the document.
    if (out_.not_rechecked.empty()) require_below(out_.stationarity, limit.stationarity, "stationarity", "N");
    require_below(out_.rows.violation, limit.penetration, "row violated by", "mm");
    require_below(out_.rows.chord, limit.penetration, "a chord whose row does not see it is in the wall by", "mm");
    require_below(out_.rows.complementarity, limit.complementarity, "complementarity", "N mm");
    require_below(out_.rows.negative, -limit.multiplier, "multiplier below zero by", "N");
    require_below(out_.rows.contact_entry, 10.0 * agreement, "contacts and state differ by", "mm or N");
  }

  const Result& result_;
  std::vector<Unknown> unknowns_;
  std::vector<CurveModel> models_;
  RowWork work_;
  Findings out_;
  std::vector<std::string> known_groups_;
};

}  // namespace

Findings recheck(const Result& result) { return Recheck(result).run(); }

}  // namespace recheck
