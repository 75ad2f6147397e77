#include <algorithm>
#include <cmath>
#include <string>

#include "core/contact/binding.hpp"
#include "core/contact/row_window.hpp"
#include "core/interfaces/constraint.hpp"
#include "core/lie/s2.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    contact::centerline_key("how the vessel runs between its nodes"),
    contact::window_key(
        "vessel segments (a number) or length (with a unit) that a row covers on each side of its place; "
        "default what the solver asks for"),
};
constexpr double rebind_margin = 0.2;   // of the window's half width
constexpr double largest_slant = 0.75;  // cosine of what a tangent may turn from its row's axes
constexpr int max_steps = 60;

/// One node of the wire on the centerline. σ is where the plane through the node across `axis` meets it, and the rows
/// are the components of x − q(σ) along `across`. These axes stay as they are during an epoch.
struct Place {
  int node = 0;
  contact::Window window;
  contact::NodeRange covers;
  double sigma = 0.0;  // at the accepted state
  double slant = 1.0;  // cosine between the tangent and the axis there
  Vector3 axis, across[2];
};

/// A place at some state.
struct Crossing {
  bool found = false;
  contact::CurveCoordinate at;
  Vector3 offset;         // x − q
  Vector3 slope, second;  // q', q''
};

Vector3 vector(const double* p) { return {{p[0], p[1], p[2]}}; }

/// x = q(σ*): the wire has no clearance, so that the tube holds it on its centerline wherever it slides to. One row per
/// node in the plane, two in space, all equalities (README.md).
class Concentric final : public Constraint {
 public:
  explicit Concentric(const ParameterSet& parameters)
      : interpolation_(contact::interpolation_of(parameters)), window_(parameters) {}

  Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept override {
    return guard([&] {
      if (scene.on.size() != 2 || scene.on[0].kind != CurveKind::wire || scene.on[1].kind != CurveKind::vessel) {
        throw StatusError(Code::invalid_input, "'concentric' acts on a wire and a vessel, in that order");
      }
      wire_ = scene.on[0];
      vessel_ = scene.on[1];
      dimension_ = scene.dimension;
      rows_each_ = dimension_ - 1;
      no_radius_.assign(static_cast<std::size_t>(vessel_.nodes), 1.0);
      segments_ = window_.segments(scene);
      make_places(scene);
      describe(out);
      out.inside_lumen = fits(scene);
    });
  }

  Status evaluate(const RowEvaluation& evaluation) const noexcept override {
    const contact::Centerline centerline = centerline_at(evaluation.at->table(vessel_.index, Site::node));
    const double* wire = evaluation.at->table(wire_.index, Site::node);
    double* jacobian = evaluation.jacobian.data();
    double* hessian = evaluation.hessian.data();
    std::size_t row = 0;
    for (const Place& place : places_) {
      const Crossing crossing = cross(centerline, place, wire + place.node * dimension_);
      if (!crossing.found) return {Code::left_window, {}};
      for (int k = 0; k < rows_each_; ++k, ++row) {
        const int numbers = (1 + place.covers.count) * dimension_;
        if (!evaluation.residual.empty()) evaluation.residual[row] = dot(place.across[k], crossing.offset);
        if (jacobian != nullptr) {
          write_gradient(place, crossing, k, jacobian);
          jacobian += numbers;
        }
        if (hessian != nullptr) {
          write_hessian(place, crossing, k, evaluation.weight[row], hessian);
          hessian += packed_size(numbers);
        }
      }
    }
    return {};
  }

  Status accept(const PlaceTables& at) noexcept override {
    const contact::Centerline centerline = centerline_at(at.table(vessel_.index, Site::node));
    const double* wire = at.table(wire_.index, Site::node);
    for (Place& place : places_) {
      const Crossing crossing = cross(centerline, place, wire + place.node * dimension_);
      if (!crossing.found) continue;
      place.sigma = crossing.at.sigma();
      tangents_[static_cast<std::size_t>(&place - places_.data())] = normalized(crossing.slope);
      place.slant = dot(place.axis, normalized(crossing.slope));
    }
    return {};
  }

  bool rebind_due() const noexcept override {
    return std::any_of(places_.begin(), places_.end(), [&](const Place& place) {
      const double margin = rebind_margin * 0.5 * (place.window.high - place.window.low);
      return place.slant < largest_slant ||
             contact::near_edge(place.window, place.sigma, place.sigma, margin, vessel_.nodes);
    });
  }

  Status rebind(RowDeclaration& out) noexcept override {
    return guard([&] {
      for (std::size_t i = 0; i < places_.size(); ++i) {
        cover(places_[i]);
        turn_axes(places_[i], tangents_[i]);
      }
      describe(out);
    });
  }

  Status bind(const PlaceTables& at, RowDeclaration& out) noexcept override {
    return guard([&] {
      const contact::Centerline centerline = centerline_at(at.table(vessel_.index, Site::node));
      const double* wire = at.table(wire_.index, Site::node);
      const std::vector<double> sigma = contact::places_at(wire_, centerline, wire, nullptr, first_places_);
      for (Place& place : places_) {
        place.sigma = sigma[static_cast<std::size_t>(place.node)];
        cover(place);
        const contact::CurvePoint q = contact::evaluate(centerline, contact::coordinate(place.sigma, vessel_.nodes));
        turn_axes(place, normalized(vector(q.slope)));
      }
      describe(out);
    });
  }

  Status report(const PlaceTables& at, std::vector<RowReport>& out) const noexcept override {
    return guard([&] {
      const contact::Centerline centerline = centerline_at(at.table(vessel_.index, Site::node));
      const double* wire = at.table(wire_.index, Site::node);
      out.clear();
      for (const Place& place : places_) {
        const Crossing crossing = cross(centerline, place, wire + place.node * dimension_);
        for (int k = 0; k < rows_each_; ++k) {
          const Vector3 pull = pull_of(place, crossing, k);
          RowReport report;
          report.wire_curve = wire_.index;
          report.vessel_curve = vessel_.index;
          report.wire_coordinate = place.node;
          report.vessel_coordinate = crossing.at.sigma();
          report.gap = dot(place.across[k], crossing.offset);
          report.force_per_multiplier = norm(pull);
          for (int i = 0; i < 3; ++i) report.direction[i] = -pull[i] / norm(pull);
          out.push_back(report);
        }
      }
    });
  }

 private:
  contact::Centerline centerline_at(const double* points) const noexcept {
    return {interpolation_, dimension_, vessel_.nodes, points, no_radius_.data()};
  }

  /// Whether a lumen is known that the wire can be inside of.
  static bool fits(const ConstraintScene& scene) {
    if (scene.radius[0] == nullptr || scene.radius[1] == nullptr) return false;
    const double widest = *std::max_element(scene.radius[0], scene.radius[0] + scene.on[0].nodes);
    return *std::min_element(scene.radius[1], scene.radius[1] + scene.on[1].nodes) > widest;
  }

  void make_places(const ConstraintScene& scene) {
    const contact::Centerline centerline = centerline_at(vessel_.start);
    first_places_ = contact::first_places(scene, centerline);
    places_.clear();
    tangents_.clear();
    for (int i = 0; i < wire_.nodes; ++i) {
      if (position_held(wire_, i)) continue;
      Place place;
      place.node = i;
      place.sigma = first_places_[static_cast<std::size_t>(i)];
      cover(place);
      const contact::CurvePoint q = contact::evaluate(centerline, contact::coordinate(place.sigma, vessel_.nodes));
      set_axes(place, lie::frame_from_tangent(normalized(vector(q.slope))));
      tangents_.push_back(place.axis);
      places_.push_back(place);
    }
  }

  /// In the plane the second axis of the frame is the normal in it.
  static void set_axes(Place& place, const lie::Rotation& frame) {
    const Matrix3 r = frame.matrix();
    place.axis = r.column(0);
    place.across[0] = r.column(1);
    place.across[1] = r.column(2);
    place.slant = 1.0;
  }

  /// By the least turn, so that multipliers keep their meaning.
  static void turn_axes(Place& place, const Vector3& tangent) {
    Matrix3 axes;
    axes.set_column(0, place.axis);
    axes.set_column(1, place.across[0]);
    axes.set_column(2, place.across[1]);
    set_axes(place, lie::transport(lie::from_matrix(axes), tangent));
  }

  void cover(Place& place) const {
    place.window = contact::window_around(place.sigma, segments_, vessel_.nodes);
    place.covers = contact::window_nodes(interpolation_, place.window, vessel_.nodes);
  }

  /// The zero of axis·(q(σ) − x), which grows along the window, by Newton's steps within a bracket. The curve goes on
  /// as its end segments' polynomials by up to one segment beyond its ends.
  Crossing cross(const contact::Centerline& centerline, const Place& place, const double* x) const noexcept {
    double low = place.window.low > 0.0 ? place.window.low : -1.0;
    double high = place.window.high < vessel_.nodes - 1 ? place.window.high : vessel_.nodes;
    const auto coordinate = [&](double sigma) {
      contact::CurveCoordinate at = contact::coordinate(sigma, vessel_.nodes);
      at.u = sigma - at.segment;
      return at;
    };
    Crossing here;
    const auto visit = [&](double sigma) {
      here.at = coordinate(sigma);
      const contact::CurvePoint q = contact::segment_polynomial(centerline, here.at.segment, x).at(here.at.u);
      here.offset = -vector(q.position);
      here.slope = vector(q.slope);
      here.second = vector(q.second);
      return -dot(place.axis, here.offset);
    };
    if (!(visit(low) <= 0.0) || !(visit(high) >= 0.0)) return here;
    double sigma = std::clamp(place.sigma, low, high);
    double ahead = visit(sigma);
    for (int i = 0; i < max_steps && ahead != 0.0; ++i) {
      (ahead < 0.0 ? low : high) = sigma;
      const double speed = dot(place.axis, here.slope);
      double next = speed > 0.0 ? sigma - ahead / speed : low - 1.0;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double step = std::abs(next - sigma);
      sigma = next;
      ahead = visit(sigma);
      if (step <= 4e-16 * (1.0 + std::abs(sigma))) break;
    }
    here.found = true;
    return here;
  }

  /// m of ∂r/∂x = m: across the curve, whatever the axes.
  static Vector3 pull_of(const Place& place, const Crossing& crossing, int k) noexcept {
    const Vector3& n = place.across[k];
    return n - dot(n, crossing.slope) / dot(place.axis, crossing.slope) * place.axis;
  }

  struct Weights {
    double value[1 + contact::max_stencil] = {1.0}, slope[1 + contact::max_stencil] = {};
    int blocks = 1, shift = 0;  // blocks of the wire node and the stencil; where the stencil begins in the row
  };
  Weights weights(const Place& place, const Crossing& crossing) const noexcept {
    const contact::Stencil stencil = contact::stencil(interpolation_, crossing.at, vessel_.nodes);
    Weights w;
    for (int k = 0; k < stencil.nodes.count; ++k) {
      w.value[1 + k] = -stencil.value[k];
      w.slope[1 + k] = -stencil.slope[k];
    }
    w.blocks = 1 + stencil.nodes.count;
    w.shift = stencil.nodes.first - place.covers.first;
    return w;
  }
  int at(const Weights& w, int block, int axis) const noexcept {
    return (block == 0 ? 0 : block + w.shift) * dimension_ + axis;
  }

  void write_gradient(const Place& place, const Crossing& crossing, int k, double* out) const noexcept {
    const Weights w = weights(place, crossing);
    const Vector3 m = pull_of(place, crossing, k);
    std::fill(out, out + (1 + place.covers.count) * dimension_, 0.0);
    for (int a = 0; a < w.blocks; ++a) {
      for (int i = 0; i < dimension_; ++i) out[at(w, a, i)] = w.value[a] * m[i];
    }
  }

  /// weight·∂²r: with s = axis·q', (w'_a w_b m_i T_j + w_a w'_b T_i m_j)/s − w_a w_b T_i T_j (m·q'')/s².
  void write_hessian(const Place& place, const Crossing& crossing, int k, double weight, double* out) const noexcept {
    std::fill(out, out + packed_size((1 + place.covers.count) * dimension_), 0.0);
    if (weight == 0.0) return;
    const Weights w = weights(place, crossing);
    const Vector3 m = pull_of(place, crossing, k);
    const Vector3& axis = place.axis;
    const double speed = dot(axis, crossing.slope);
    const double bend = dot(m, crossing.second) / (speed * speed);
    for (int a = 0; a < w.blocks; ++a) {
      for (int i = 0; i < dimension_; ++i) {
        for (int b = 0; b < w.blocks; ++b) {
          for (int j = 0; j < dimension_; ++j) {
            const int row = at(w, a, i), column = at(w, b, j);
            if (column > row) continue;
            const double mixed = w.slope[a] * w.value[b] * m[i] * axis[j] + w.value[a] * w.slope[b] * axis[i] * m[j];
            out[packed_index(row, column)] =
                weight * (mixed / speed - w.value[a] * w.value[b] * axis[i] * axis[j] * bend);
          }
        }
      }
    }
  }

  void describe(RowDeclaration& out) const {
    out.rows = static_cast<int>(places_.size()) * rows_each_;
    out.place_begin.assign(1, 0);
    out.places.clear();
    for (const Place& place : places_) {
      for (int k = 0; k < rows_each_; ++k) {
        out.places.push_back({wire_.index, Site::node, place.node});
        for (int j = 0; j < place.covers.count; ++j) {
          out.places.push_back({vessel_.index, Site::node, place.covers.first + j});
        }
        out.place_begin.push_back(static_cast<int>(out.places.size()));
      }
    }
    out.lower.assign(static_cast<std::size_t>(out.rows), 0.0);
    out.upper.assign(static_cast<std::size_t>(out.rows), 0.0);
  }

  contact::Interpolation interpolation_;
  contact::RowWindow window_;
  int segments_ = 2, dimension_ = 3, rows_each_ = 2;
  CurveView wire_, vessel_;
  std::vector<double> no_radius_;
  std::vector<double> first_places_;  // per wire node: σ at the start of the scene
  std::vector<Place> places_;
  std::vector<Vector3> tangents_;  // at the accepted state
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Constraint, bowstring::Concentric>(
    bowstring::Kind::constraint, "concentric",
    "The wire lies on the vessel's centerline and slides along it: contact without clearance", bowstring::schema))
