#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>

#include "constraints/wall-contact/contact_rows.hpp"
#include "core/contact/binding.hpp"
#include "core/contact/row_window.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring::wall_contact {
namespace {

constexpr ParameterDeclaration gap_key{.key = "gap",
                                       .type = ParameterType::choice,
                                       .unit = "",
                                       .default_text = "\"squared\"",
                                       .description = "form of the gap function; all have the same zero set",
                                       .choices = "squared|distance|smooth-distance"};
constexpr ParameterDeclaration side_key{.key = "side",
                                        .type = ParameterType::choice,
                                        .unit = "",
                                        .default_text = "\"inside\"",
                                        .description = "the side of the wall that the wire stays on",
                                        .choices = "inside|outside"};
constexpr ParameterDeclaration rows_key{
    .key = "rows-per-segment",
    .type = ParameterType::scalar,
    .unit = "",
    .default_text = "1",
    .description =
        "rows per wire segment, evenly spaced; \"auto\": as many as keep rows closer than 0.65 of the "
        "smallest clearance. With segment-wise-contact the parts of a segment that have a row of their own, where the "
        "gap is largest, \"auto\" being 1",
    .lower = 1.0,
    .upper = 1000.0,
    .choices = "auto"};
constexpr ParameterDeclaration schema[] = {
    contact::centerline_key("how the wall runs between vessel nodes"), gap_key, side_key, rows_key,
    contact::window_key("vessel segments (a number) or length (with a unit) that a row covers on each side of its "
                        "closest point; default "
                        "what the solver asks for; without effect with same-index-contact, which searches none")};

constexpr double rebind_margin = 0.2;       // of the window's half width
constexpr double automatic_spacing = 0.65;  // of the smallest clearance
constexpr double straight = 1e-9;           // mm: a chord whose gap bends less may have its row at either place

contact::GapForm gap_form_of(const std::string& name) {
  if (name == "distance") return contact::GapForm::distance;
  if (name == "smooth-distance") return contact::GapForm::smooth_distance;
  return contact::GapForm::squared;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// A wire on its side of a vessel's wall. Preprint eqs. (9) and (11), with the gap of a tube whose radius varies.
template <Discretisation discretisation>
class WallContact final : public Constraint {
 public:
  explicit WallContact(const ParameterSet& parameters)
      : interpolation_(contact::interpolation_of(parameters)),
        window_(parameters),
        form_(gap_form_of(parameters.text("gap"))),
        outside_(parameters.text("side") == "outside") {
    const ParameterValue& rows = parameters.at("rows-per-segment");
    rows_per_segment_ = rows.text.empty() ? rows.number : 0.0;
    if (rows_per_segment_ != std::floor(rows_per_segment_)) {
      throw StatusError(Code::invalid_input, "'rows-per-segment' is " + number(rows_per_segment_) +
                                                 "; expected a whole number, or \"auto\"");
    }
  }

  Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept override {
    return guard([&] {
      check(scene);
      wire_ = scene.on[0];
      vessel_ = scene.on[1];
      dimension_ = scene.dimension;
      radius_.assign(scene.radius[1], scene.radius[1] + vessel_.nodes);
      wire_radius_.assign(static_cast<std::size_t>(wire_.nodes), 0.0);
      if (scene.radius[0] != nullptr) wire_radius_.assign(scene.radius[0], scene.radius[0] + wire_.nodes);
      segments_ = window_.segments(scene);
      first_places_ = first_places(scene);
      measure_clearance(first_places_);
      make_rows(first_places_, bounded_wall_of(vessel_.start), wire_.start);
      describe(out);
      out.inside_lumen = !outside_;
      warn(out);
      if (discretisation == Discretisation::segment_wise && rows_per_segment_ <= 0.0) {
        out.without_effect.push_back({"rows-per-segment", "segment-wise-contact finds the place of the largest gap"});
      }
      if (discretisation == Discretisation::same_index) {
        out.without_effect.push_back({"window", "same-index-contact searches no closest point"});
      }
    });
  }

  Status evaluate(const RowEvaluation& evaluation) const noexcept override {
    const Wall wall = wall_at(*evaluation.at);
    const double* wire = evaluation.at->table(wire_.index, Site::node);
    const bool derivatives = !evaluation.jacobian.empty() || !evaluation.hessian.empty();
    const bool all_places = evaluation.support.empty();
    double* jacobian = evaluation.jacobian.data();
    double* hessian = evaluation.hessian.data();
    const auto first = static_cast<std::size_t>(evaluation.first);
    const std::size_t count = evaluation.count < 0 ? rows_.size() : static_cast<std::size_t>(evaluation.count);
    for (std::size_t r = 0; r < count; ++r) {
      const Row& row = rows_[first + r];
      Found& found = found_[first + r];
      const bool again = evaluation.beyond_window && found.point.closest.location == contact::Location::window_edge;
      if (evaluation.state == 0 || found.state != evaluation.state || again) {
        found.point = locate(row, wall, wire, evaluation.beyond_window ? reach_of(row) : row.window);
        found.state = evaluation.state;
        found.beyond_window = evaluation.beyond_window;
        found.expanded = false;
      }
      if (found.point.closest.location == contact::Location::window_edge) return {Code::left_window, {}};
      if (!evaluation.beyond_window && !covers(row, found.point)) return {Code::left_window, {}};
      if (!evaluation.residual.empty()) evaluation.residual[r] = found.point.gap;
      if (!derivatives) continue;
      if (!found.expanded) found.expansion = expand(wall, found.point);
      found.expanded = true;
      const int numbers = row.places() * dimension_;
      if (!all_places) evaluation.support[r] = support(row, found.expansion);
      if (jacobian != nullptr) {
        write_gradient(row, wall, found.expansion, all_places, jacobian);
        jacobian += numbers;
      }
      if (hessian != nullptr) {
        write_hessian(row, wall, found.expansion, evaluation.weight[r], all_places, hessian);
        hessian += packed_size(numbers);
      }
    }
    return {};
  }

  Status accept(const PlaceTables& at) noexcept override {
    const Wall wall = bounded_wall_at(at);
    const double* wire = at.table(wire_.index, Site::node);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Found& found = found_[r];
      const bool known = at.state() != 0 && found.state == at.state() && serves(rows_[r], found);
      refer_to(rows_[r], wall, wire, reach_of(rows_[r]), known ? &found.point : nullptr);
    }
    forget();
    return {};
  }

  Travel travel(const PlaceTables& at) const noexcept override {
    const double* wire = at.table(wire_.index, Site::node);
    const double* vessel = at.table(vessel_.index, Site::node);
    Travel largest;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const double fraction = travelled(rows_[r], dimension_, wire, vessel);
      if (fraction > largest.fraction_of_clearance) largest = {fraction, static_cast<int>(r)};
    }
    return largest;
  }

  bool rebind_due() const noexcept override {
    const bool moved = std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) {
      if (row.jumped) return true;
      if (!row.searches) return false;
      const double margin = rebind_margin * (segments_ + 0.5);
      const auto [first, last] = std::minmax(row.end_sigma[0], row.end_sigma[1]);
      return contact::near_edge(row.window, first, last, margin, vessel_.nodes);
    });
    return moved || std::any_of(rows_.begin(), rows_.end(), changes);
  }

  Status rebind(RowDeclaration& out) noexcept override {
    return guard([&] {
      for (Row& row : rows_) {
        cover(row);
        if (changes(row)) row.midway = !row.midway;
        row.jumped = false;
      }
      forget();
      describe(out);
    });
  }

  Status bind(const PlaceTables& at, RowDeclaration& out) noexcept override {
    return guard([&] {
      const Wall wall = bounded_wall_at(at);
      const double* wire = at.table(wire_.index, Site::node);
      if (discretisation == Discretisation::same_index) {
        make_rows(first_places_, wall, wire);
      } else {
        std::vector<double> radius = wire_radius_;
        if (outside_) std::transform(radius.begin(), radius.end(), radius.begin(), std::negate<>());
        make_rows(contact::places_at(wire_, wall.centerline, wire, radius.data(), first_places_), wall, wire);
        for (Row& row : rows_) settle(row, wall, wire);
        for (Row& row : rows_) row.jumped = false;
      }
      describe(out);
    });
  }

  Status report(const PlaceTables& at, std::vector<RowReport>& out) const noexcept override {
    return guard([&] {
      const Wall wall = bounded_wall_at(at);
      const double* wire = at.table(wire_.index, Site::node);
      out.clear();
      for (const Row& row : rows_) {
        RowPoint point = locate(row, wall, wire, reach_of(row));
        const contact::ClosestPoint lowest = lowest_place(row, wall, point);
        if (lowest.gap < point.closest.gap) {
          point.closest = lowest;
          point.gap = lowest.gap;
        }
        const contact::CurvePoint q = contact::evaluate(wall.centerline, point.closest.at);
        double x[3] = {};
        point.wire.position(dimension_, x);
        RowReport report;
        report.wire_curve = wire_.index;
        report.vessel_curve = vessel_.index;
        report.wire_coordinate = row.node + (row.nodes == 1 ? 0.0 : point.wire.t);
        report.vessel_coordinate = point.closest.at.sigma();
        report.gap = point.gap;
        report.clearance = point.closest.clearance;
        const double inward = outside_ ? -1.0 : 1.0;
        for (int k = 0; k < dimension_ && point.closest.distance > 0.0; ++k) {
          report.direction[k] = inward * (q.position[k] - x[k]) / point.closest.distance;
        }
        out.push_back(report);
      }
    });
  }

 private:
  /// What the last evaluation of a row found: further ones at that state, and its acceptance, have the same closest
  /// point.
  struct Found {
    std::uint64_t state = 0;  // 0: nothing
    bool beyond_window = false, expanded = false;
    RowPoint point;
    contact::GapExpansion expansion;
  };

  Wall wall_at(const PlaceTables& at) const noexcept { return wall_of(at.table(vessel_.index, Site::node)); }
  Wall wall_of(const double* points) const noexcept {
    return {{interpolation_, dimension_, vessel_.nodes, points, radius_.data()}, form_, outside_, {}};
  }
  /// For what looks for the lowest places.
  Wall bounded_wall_of(const double* points) const noexcept {
    Wall wall = wall_of(points);
    wall.bounds = contact::tube_bounds(wall.centerline);
    return wall;
  }
  Wall bounded_wall_at(const PlaceTables& at) const noexcept {
    return bounded_wall_of(at.table(vessel_.index, Site::node));
  }

  /// Where a row may find its place: on a spline its search descends from the accepted place and cannot take a shortcut
  /// to another limb; on a polyline it takes the lowest minimum of all that it sees.
  contact::Window reach_of(const Row& row) const noexcept {
    const bool descends = row.searches && interpolation_ == contact::Interpolation::spline;
    return descends ? contact::Window{0.0, vessel_.nodes - 1.0} : row.window;
  }

  static bool covers(const Row& row, const RowPoint& point) noexcept {
    const double sigma = point.closest.at.sigma();
    return sigma >= row.window.low && sigma <= row.window.high;
  }

  /// Whether a search of all that the row can reach would have ended at the same place, by the same steps.
  bool serves(const Row& row, const Found& found) const noexcept {
    if (found.point.closest.location == contact::Location::window_edge) return false;
    if (found.beyond_window || !row.searches) return true;
    const bool inside = row.sigma < row.window.high || row.window.high == vessel_.nodes - 1.0;
    return inside && row.sigma >= row.window.low;
  }

  void check(const ConstraintScene& scene) const {
    if (scene.on.size() != 2 || scene.on[0].kind != CurveKind::wire || scene.on[1].kind != CurveKind::vessel) {
      throw StatusError(Code::invalid_input, "contact acts on a wire and a vessel, in that order");
    }
    const std::string vessel = scene.on[1].name;
    if (scene.radius[1] == nullptr) {
      throw StatusError(Code::invalid_input,
                        "vessel '" + vessel + "' has no radius; give it one, or a geometry with a column radius_mm");
    }
    const int wire_nodes = scene.on[0].nodes, vessel_nodes = scene.on[1].nodes;
    if (discretisation == Discretisation::same_index && wire_nodes != vessel_nodes) {
      throw StatusError(Code::invalid_input, "same-index-contact compares nodes of the same number, but wire '" +
                                                 std::string(scene.on[0].name) + "' has " + std::to_string(wire_nodes) +
                                                 " nodes and vessel '" + vessel + "' " + std::to_string(vessel_nodes) +
                                                 "; give both the same number, or use type = \"node-wise-contact\"");
    }
  }

  /// The smallest clearance of the wire's nodes at the places that they are first bound to. Inside, the wire fits in
  /// everywhere, or there is no gap to speak of.
  void measure_clearance(const std::vector<double>& sigma) {
    smallest_clearance_ = std::numeric_limits<double>::infinity();
    double place = 0.0, radius = 0.0;
    for (std::size_t i = 0; i < sigma.size(); ++i) {
      const contact::CurveCoordinate at = contact::coordinate(sigma[i], vessel_.nodes);
      const auto between = [&](const double* values) {
        return (1.0 - at.u) * values[at.segment] + at.u * values[at.segment + 1];
      };
      const double lumen = between(radius_.data());
      const double clearance = outside_ ? lumen + wire_radius_[i] : lumen - wire_radius_[i];
      if (clearance > smallest_clearance_) continue;
      smallest_clearance_ = clearance;
      place = between(vessel_.arc);
      radius = wire_radius_[i];
    }
    if (outside_ || smallest_clearance_ > 0.0) return;
    throw StatusError(Code::invalid_input,
                      "wire '" + std::string(wire_.name) + "' (radius " + number(radius) +
                          " mm) is as wide as the lumen of '" + vessel_.name + "' or wider, by " +
                          number(std::fabs(smallest_clearance_)) + " mm at s = " + number(place) +
                          " mm; reduce the wire's radius, or use type = \"concentric\", which has no clearance");
  }

  double longest_edge() const { return *std::max_element(wire_.edge_length, wire_.edge_length + wire_.nodes - 1); }

  /// Rows at fixed places per segment, its first node's among them.
  int stations() const {
    if (discretisation == Discretisation::segment_wise) return std::max(1, static_cast<int>(rows_per_segment_));
    if (rows_per_segment_ > 0.0) return static_cast<int>(rows_per_segment_);
    return std::max(1, static_cast<int>(std::ceil(longest_edge() / (automatic_spacing * smallest_clearance_))));
  }

  /// Rows at every place that may carry one, in order along the wire, each segment's after its first node's. A row that
  /// searches stands between each two fixed places.
  /// `sigma`: where each node is bound to, at the state of `wall` and `wire`.
  void make_rows(const std::vector<double>& sigma, const Wall& wall, const double* wire) {
    const int per_segment = stations();
    const bool search = discretisation == Discretisation::segment_wise;
    rows_.clear();
    for (int i = 0; i < wire_.nodes; ++i) {
      if (!position_held(wire_, i)) add_row(i, 1, {0.0, 0.0}, sigma, wall, wire);
      if (i == wire_.nodes - 1 || (position_held(wire_, i) && position_held(wire_, i + 1))) continue;
      for (int k = 0; k < per_segment; ++k) {
        const double low = static_cast<double>(k) / per_segment, high = static_cast<double>(k + 1) / per_segment;
        if (k > 0) add_row(i, 2, {low, low}, sigma, wall, wire);
        if (search) add_row(i, 2, {low + chord_margin, high - chord_margin}, sigma, wall, wire);
      }
    }
    found_.assign(rows_.size(), {});
  }

  /// A row at a place of a segment, or one that looks for its place in a part of it.
  void add_row(int node, int nodes, contact::ChordPart part, const std::vector<double>& sigma, const Wall& wall,
               const double* wire) {
    const auto first = static_cast<std::size_t>(node);
    const double t = part.middle();
    Row row;
    row.node = node;
    row.nodes = nodes;
    row.t = t;
    row.part = part;
    row.extremal = part.low < part.high;
    row.searches = discretisation != Discretisation::same_index;
    row.radius[0] = wire_radius_[first];
    row.radius[1] = nodes == 2 ? wire_radius_[first + 1] : row.radius[0];
    row.sigma = nodes == 1 ? sigma[first] : (1.0 - t) * sigma[first] + t * sigma[first + 1];
    row.end_sigma[0] = row.extremal ? sigma[first] : row.sigma;
    row.end_sigma[1] = row.extremal ? sigma[first + 1] : row.sigma;
    cover(row);
    refer_to(row, wall, wire, row.window);
    cover(row);
    row.jumped = false;
    row.midway = changes(row);
    rows_.push_back(row);
  }

  /// Moves a row's window until its closest point lies within: a place between two nodes, or on a polyline, is not
  /// where the nodes on the spline are.
  void settle(Row& row, const Wall& wall, const double* wire) const {
    for (int i = 0; i < vessel_.nodes; ++i) {
      if (locate(row, wall, wire, row.window).closest.location != contact::Location::window_edge) return;
      refer_to(row, wall, wire, row.window);
      cover(row);
    }
  }

  std::vector<double> first_places(const ConstraintScene& scene) const {
    if (discretisation != Discretisation::same_index) {
      return contact::first_places(scene, wall_of(vessel_.start).centerline);
    }
    std::vector<double> sigma;
    for (int i = 0; i < wire_.nodes; ++i) sigma.push_back(i);
    return sigma;
  }

  void cover(Row& row) const {
    if (row.searches) {
      const auto [first, last] = std::minmax(row.end_sigma[0], row.end_sigma[1]);
      row.window = {contact::window_around(first, segments_, vessel_.nodes).low,
                    contact::window_around(last, segments_, vessel_.nodes).high};
    } else {
      const int segment = contact::coordinate(row.sigma, vessel_.nodes).segment;
      row.window = {static_cast<double>(segment), segment + 1.0};
    }
    row.covers = contact::window_nodes(interpolation_, row.window, vessel_.nodes);
  }

  /// Whether the accepted state asks for the row of a chord at another place: where the gap is largest between the
  /// nodes, or, where the wall bends away so that it is largest at one of them and would jump to the other one, midway.
  static bool changes(const Row& row) noexcept {
    return row.extremal && (row.midway ? row.bend < -straight : row.bend > straight);
  }

  void forget() {
    for (Found& found : found_) found.state = 0;
  }

  void describe(RowDeclaration& out) const {
    out.rows = static_cast<int>(rows_.size());
    out.in_parts = true;
    out.place_begin.assign(1, 0);
    out.places.clear();
    for (const Row& row : rows_) {
      for (int k = 0; k < row.nodes; ++k) out.places.push_back({wire_.index, Site::node, row.node + k});
      for (int k = 0; k < row.covers.count; ++k) {
        out.places.push_back({vessel_.index, Site::node, row.covers.first + k});
      }
      out.place_begin.push_back(static_cast<int>(out.places.size()));
    }
    out.lower.assign(rows_.size(), -std::numeric_limits<double>::infinity());
    out.upper.assign(rows_.size(), 0.0);
  }

  void warn(RowDeclaration& out) const {
    const std::string pair = "contact of '" + std::string(wire_.name) + "' with '" + vessel_.name + "': ";
    const int per_segment = stations();
    const double spacing = discretisation == Discretisation::segment_wise ? 0.0 : longest_edge() / per_segment;
    const double clearance = smallest_clearance_;
    if (spacing > clearance) {
      out.warnings.push_back(pair + "rows are up to " + number(spacing) +
                             " mm apart, farther than the smallest clearance (" + number(clearance) +
                             " mm), so the wall may pass between them; use rows-per-segment = \"auto\", "
                             "segment-wise-contact, or more wire nodes");
    }
    if (form_ == contact::GapForm::smooth_distance) {
      out.warnings.push_back(pair + "the smooth distance lets the wire into the wall by up to " +
                             number(contact::gap_smoothing) + " mm");
    }
    double outside = 0.0, place = -1.0;
    for (const Row& row : rows_) {
      const double distance = std::hypot(row.offset[0], row.offset[1], row.offset[2]);
      const double depth = outside_ ? row.clearance - distance : distance - row.clearance;
      if (depth <= outside) continue;
      outside = depth;
      place = wire_.arc[row.node] + (row.nodes == 1 ? 0.0 : row.t * wire_.edge_length[row.node]);
    }
    if (place >= 0.0) {
      out.warnings.push_back("wire '" + std::string(wire_.name) + "' starts " + (outside_ ? "inside" : "outside") +
                             " of '" + vessel_.name + "' by up to " + number(outside) + " mm, at s = " + number(place) +
                             " mm");
    }
  }

  contact::Interpolation interpolation_;
  contact::RowWindow window_;
  contact::GapForm form_;
  bool outside_;
  double rows_per_segment_ = 1.0;  // 0: as many as keep them close
  int segments_ = 2;
  CurveView wire_, vessel_;
  int dimension_ = 3;
  std::vector<double> radius_, wire_radius_;
  std::vector<double> first_places_;  // per wire node: σ at the start of the scene
  double smallest_clearance_ = 0.0;
  std::vector<Row> rows_;
  mutable std::vector<Found> found_;  // per row
};

}  // namespace
}  // namespace bowstring::wall_contact

BOWSTRING_PLUGIN(
    bowstring::component<bowstring::Constraint,
                         bowstring::wall_contact::WallContact<bowstring::wall_contact::Discretisation::node_wise>>(
        bowstring::Kind::constraint, "node-wise-contact",
        "The wire stays in the lumen at its nodes: one closest-point gap per node, or more per segment",
        bowstring::wall_contact::schema),
    bowstring::component<bowstring::Constraint,
                         bowstring::wall_contact::WallContact<bowstring::wall_contact::Discretisation::segment_wise>>(
        bowstring::Kind::constraint, "segment-wise-contact",
        "The wire's straight segments stay in the lumen: one row per segment, where its gap is largest",
        bowstring::wall_contact::schema),
    bowstring::component<bowstring::Constraint,
                         bowstring::wall_contact::WallContact<bowstring::wall_contact::Discretisation::same_index>>(
        bowstring::Kind::constraint, "same-index-contact",
        "Each wire node stays near the vessel node of the same number, within the lumen radius",
        bowstring::wall_contact::schema))
