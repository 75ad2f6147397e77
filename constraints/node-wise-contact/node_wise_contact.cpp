#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "core/contact/gap.hpp"
#include "core/interfaces/constraint.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "centerline",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"spline\"",
     .description = "how the wall runs between vessel nodes",
     .choices = "spline|polyline"},
    {.key = "gap",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"squared\"",
     .description = "form of the gap function; all have the same zero set",
     .choices = "squared|distance|smooth-distance"},
    {.key = "window",
     .type = ParameterType::scalar,
     .unit = "|mm",
     .default_text = "",
     .description = "vessel segments (a number) or length (with a unit) that a row covers on each side of its closest "
                    "point; default what the solver asks for",
     .lower = 0.0,
     .lower_exclusive = true},
};
constexpr int window_in_length = 1;
constexpr double rebind_margin = 0.2;  // of the window's half width

struct Row {
  int node = 0;  // of the wire
  contact::GapShape shape;
  contact::Window window;
  contact::NodeRange nodes;  // of the vessel, that the window covers
  double sigma = 0.0;        // closest point at the accepted state
  contact::Stencil stencil;  // there
  double offset[3] = {};     // wire node minus that point, at the accepted state
  double tangent[3] = {};    // unit, of the vessel there
  double clearance = 1.0;
};

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

/// One row per wire node whose position is not wholly held: its gap to the wall is at most zero. Preprint eqs. (9) and
/// (11), with the gap of a tube whose radius varies.
class NodeWiseContact final : public Constraint {
 public:
  explicit NodeWiseContact(const ParameterSet& parameters)
      : interpolation_(parameters.text("centerline") == "polyline" ? contact::Interpolation::polyline
                                                                   : contact::Interpolation::spline),
        form_(gap_form_of(parameters.text("gap"))) {
    if (!parameters.has("window")) return;
    window_ = parameters.scalar("window");
    window_is_length_ = parameters.at("window").unit_alternative == window_in_length;
  }

  Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept override {
    return guard([&] {
      if (scene.on.size() != 2 || scene.on[0].kind != CurveKind::wire || scene.on[1].kind != CurveKind::vessel) {
        throw StatusError(Code::invalid_input, "contact acts on a wire and a vessel, in that order");
      }
      if (scene.radius[1] == nullptr) {
        throw StatusError(Code::invalid_input,
                          "vessel '" + std::string(scene.on[1].name) +
                              "' has no radius; give it one, or a geometry with a column radius_mm");
      }
      wire_ = scene.on[0];
      vessel_ = scene.on[1];
      dimension_ = scene.dimension;
      radius_.assign(scene.radius[1], scene.radius[1] + vessel_.nodes);
      set_window(scene);
      make_rows(scene);
      describe(out);
      warn(out);
    });
  }

  Status evaluate(const RowEvaluation& evaluation) const noexcept override {
    const contact::Centerline wall = centerline(*evaluation.at);
    const double* wire = evaluation.at->table(wire_.index, Site::node);
    double* jacobian = evaluation.jacobian.data();
    double* hessian = evaluation.hessian.data();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      const double* x = wire + row.node * dimension_;
      const contact::ClosestPoint point = contact::closest(wall, x, row.shape, row.window, row.sigma);
      if (point.location == contact::Location::window_edge) return {Code::left_window, {}};
      if (!evaluation.residual.empty()) evaluation.residual[r] = point.gap;
      const int numbers = (1 + row.nodes.count) * dimension_;
      if (jacobian != nullptr) {
        write_gradient(wall, x, row, point, jacobian);
        jacobian += numbers;
      }
      if (hessian != nullptr) {
        write_hessian(wall, x, row, point, evaluation.weight[r], hessian);
        hessian += packed_size(numbers);
      }
    }
    return {};
  }

  Status accept(const PlaceTables& at) noexcept override {
    const contact::Centerline wall = centerline(at);
    const double* wire = at.table(wire_.index, Site::node);
    for (Row& row : rows_) refer_to(row, wall, wire + row.node * dimension_);
    return {};
  }

  Travel travel(const PlaceTables& at) const noexcept override {
    const double* wire = at.table(wire_.index, Site::node);
    const double* vessel = at.table(vessel_.index, Site::node);
    Travel largest;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      double motion[3] = {};
      double along = 0.0;
      for (int k = 0; k < dimension_; ++k) {
        double q = 0.0;
        for (int j = 0; j < row.stencil.nodes.count; ++j) {
          q += row.stencil.value[j] * vessel[(row.stencil.nodes.first + j) * dimension_ + k];
        }
        motion[k] = wire[row.node * dimension_ + k] - q - row.offset[k];
        along += motion[k] * row.tangent[k];
      }
      double squared = 0.0;
      for (int k = 0; k < dimension_; ++k) {
        const double transverse = motion[k] - along * row.tangent[k];
        squared += transverse * transverse;
      }
      const double fraction = std::sqrt(squared) / row.clearance;
      if (fraction > largest.fraction_of_clearance) largest = {fraction, static_cast<int>(r)};
    }
    return largest;
  }

  bool rebind_due() const noexcept override {
    return std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) {
      const double margin = rebind_margin * 0.5 * (row.window.high - row.window.low);
      const bool low = row.window.low > 0.0 && row.sigma < row.window.low + margin;
      const bool high = row.window.high < vessel_.nodes - 1 && row.sigma > row.window.high - margin;
      return low || high;
    });
  }

  Status rebind(RowDeclaration& out) noexcept override {
    return guard([&] {
      for (Row& row : rows_) cover(row);
      describe(out);
    });
  }

  Status report(const PlaceTables& at, std::vector<RowReport>& out) const noexcept override {
    return guard([&] {
      const contact::Centerline wall = centerline(at);
      const double* wire = at.table(wire_.index, Site::node);
      out.clear();
      for (const Row& row : rows_) {
        const double* x = wire + row.node * dimension_;
        const contact::ClosestPoint point = contact::closest(wall, x, row.shape, row.window, row.sigma);
        const contact::CurvePoint q = contact::evaluate(wall, point.at);
        RowReport report;
        report.wire_curve = wire_.index;
        report.vessel_curve = vessel_.index;
        report.wire_coordinate = row.node;
        report.vessel_coordinate = point.at.sigma();
        report.gap = point.gap;
        report.clearance = point.clearance;
        for (int k = 0; k < dimension_ && point.distance > 0.0; ++k) {
          report.direction[k] = (q.position[k] - x[k]) / point.distance;
        }
        out.push_back(report);
      }
    });
  }

 private:
  contact::Centerline centerline(const PlaceTables& at) const noexcept {
    return {interpolation_, dimension_, vessel_.nodes, at.table(vessel_.index, Site::node), radius_.data()};
  }

  void set_window(const ConstraintScene& scene) {
    const double edge = vessel_.arc[vessel_.nodes - 1] / (vessel_.nodes - 1);
    const auto segments = [&](double length) { return static_cast<int>(std::ceil(length / edge)); };
    if (window_ > 0.0) {
      segments_ = window_is_length_ ? segments(window_) : static_cast<int>(std::lround(window_));
    } else {
      segments_ = std::max(scene.window_segments, segments(scene.window_length));
    }
    segments_ = std::max(segments_, 1);
  }

  void make_rows(const ConstraintScene& scene) {
    const double* wire_radius = scene.radius[0];
    const contact::Centerline wall = {interpolation_, dimension_, vessel_.nodes, vessel_.start, radius_.data()};
    std::vector<double> sigma(static_cast<std::size_t>(wire_.nodes));
    if (scene.starts_along) {
      along_equal_arc(scene.start_arc, sigma);
    } else {
      contact::bind_along(wall, wire_.start, wire_.nodes, sigma.data());
    }
    rows_.clear();
    for (int i = 0; i < wire_.nodes; ++i) {
      if (is_held(i)) continue;
      Row row;
      row.node = i;
      row.shape = {form_, wire_radius == nullptr ? 0.0 : wire_radius[i]};
      row.sigma = sigma[static_cast<std::size_t>(i)];
      cover(row);
      refer_to(row, wall, wire_.start + i * dimension_);
      cover(row);
      rows_.push_back(row);
    }
  }

  /// σ at the arc coordinate that each wire node has, the vessel's whole length for the wire's.
  void along_equal_arc(double start_arc, std::vector<double>& sigma) const {
    const double scale = (vessel_.arc[vessel_.nodes - 1] - start_arc) / wire_.arc[wire_.nodes - 1];
    int segment = 0;
    for (int i = 0; i < wire_.nodes; ++i) {
      const double arc = start_arc + scale * wire_.arc[i];
      while (segment < vessel_.nodes - 2 && vessel_.arc[segment + 1] < arc) ++segment;
      const double length = vessel_.arc[segment + 1] - vessel_.arc[segment];
      sigma[static_cast<std::size_t>(i)] = segment + std::clamp((arc - vessel_.arc[segment]) / length, 0.0, 1.0);
    }
  }

  bool is_held(int node) const {
    for (int e = 0; e < 2; ++e) {
      const EndCondition& end = wire_.end[e];
      const int first = e == 0 ? 0 : wire_.nodes - 1;
      const int second = e == 0 ? 1 : wire_.nodes - 2;
      const bool wholly =
          std::all_of(end.position_held, end.position_held + dimension_, [](bool held) { return held; });
      if (wholly && (node == first || (end.edge_held && node == second))) return true;
    }
    return false;
  }

  void cover(Row& row) const {
    row.window = contact::window_around(row.sigma, segments_, vessel_.nodes);
    row.nodes = contact::window_nodes(interpolation_, row.window, vessel_.nodes);
  }

  void refer_to(Row& row, const contact::Centerline& wall, const double* x) const {
    const contact::ClosestPoint point = contact::closest(wall, x, row.shape, row.window, row.sigma);
    const contact::CurvePoint q = contact::evaluate(wall, point.at);
    row.sigma = point.at.sigma();
    row.stencil = contact::stencil(interpolation_, point.at, vessel_.nodes);
    row.clearance = point.clearance;
    double speed = 0.0;
    for (int k = 0; k < dimension_; ++k) speed += q.slope[k] * q.slope[k];
    speed = std::sqrt(speed);
    for (int k = 0; k < dimension_; ++k) {
      row.offset[k] = x[k] - q.position[k];
      row.tangent[k] = q.slope[k] / speed;
    }
  }

  void describe(RowDeclaration& out) const {
    out.rows = static_cast<int>(rows_.size());
    out.place_begin.assign(1, 0);
    out.places.clear();
    for (const Row& row : rows_) {
      out.places.push_back({wire_.index, Site::node, row.node});
      for (int k = 0; k < row.nodes.count; ++k) out.places.push_back({vessel_.index, Site::node, row.nodes.first + k});
      out.place_begin.push_back(static_cast<int>(out.places.size()));
    }
    out.lower.assign(rows_.size(), -std::numeric_limits<double>::infinity());
    out.upper.assign(rows_.size(), 0.0);
  }

  void warn(RowDeclaration& out) const {
    const double spacing = *std::max_element(wire_.edge_length, wire_.edge_length + wire_.nodes - 1);
    double clearance = std::numeric_limits<double>::infinity();
    double outside = 0.0;
    int outside_node = -1;
    for (const Row& row : rows_) {
      clearance = std::min(clearance, row.clearance);
      double squared = 0.0;
      for (int k = 0; k < dimension_; ++k) squared += row.offset[k] * row.offset[k];
      const double depth = std::sqrt(squared) - row.clearance;
      if (depth > outside) outside = depth, outside_node = row.node;
    }
    if (spacing > clearance) {
      out.warnings.push_back("contact of '" + std::string(wire_.name) + "' with '" + vessel_.name +
                             "': rows are up to " + number(spacing) +
                             " mm apart, farther than the smallest clearance (" + number(clearance) +
                             " mm), so the wall may pass between them; use more wire nodes");
    }
    if (outside_node >= 0) {
      out.warnings.push_back("wire '" + std::string(wire_.name) + "' starts outside of '" + vessel_.name +
                             "' by up to " + number(outside) + " mm, at s = " + number(wire_.arc[outside_node]) +
                             " mm");
    }
  }

  void write_gradient(const contact::Centerline& wall, const double* x, const Row& row,
                      const contact::ClosestPoint& point, double* out) const {
    double local[(1 + contact::max_stencil) * 3];
    const contact::NodeRange nodes = contact::gap_derivatives(wall, x, row.shape, point, local, 0.0, nullptr);
    std::fill(out, out + (1 + row.nodes.count) * dimension_, 0.0);
    std::copy_n(local, dimension_, out);
    std::copy_n(local + dimension_, nodes.count * dimension_, out + (1 + nodes.first - row.nodes.first) * dimension_);
  }

  void write_hessian(const contact::Centerline& wall, const double* x, const Row& row,
                     const contact::ClosestPoint& point, double weight, double* out) const {
    std::fill(out, out + packed_size((1 + row.nodes.count) * dimension_), 0.0);
    if (weight == 0.0) return;
    double local[packed_size((1 + contact::max_stencil) * 3)];
    const contact::NodeRange nodes = contact::gap_derivatives(wall, x, row.shape, point, nullptr, weight, local);
    const int shift = (nodes.first - row.nodes.first) * dimension_;
    const int order = (1 + nodes.count) * dimension_;
    const auto place = [&](int k) { return k < dimension_ ? k : k + shift; };
    for (int a = 0, k = 0; a < order; ++a) {
      for (int b = 0; b <= a; ++b, ++k) out[packed_index(place(a), place(b))] = local[k];
    }
  }

  contact::Interpolation interpolation_;
  contact::GapForm form_;
  double window_ = 0.0;
  bool window_is_length_ = false;
  int segments_ = 2;
  CurveView wire_, vessel_;
  int dimension_ = 3;
  std::vector<double> radius_;
  std::vector<Row> rows_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Constraint, bowstring::NodeWiseContact>(
    bowstring::Kind::constraint, "node-wise-contact",
    "The wire stays in the lumen at each of its nodes: one closest-point gap per node", bowstring::schema))
