#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "core/interfaces/constraint.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;

constexpr ParameterDeclaration schema[] = {
    {"normal", ParameterType::vector, "", nullptr,
     "direction out of the half-space, toward what must not be crossed, in global axes; its length does not matter"},
    {"offset", ParameterType::scalar, "mm", nullptr, "where the plane is along the normal, from the origin"},
    {"touches", ParameterType::choice, "", "\"surface\"",
     "what stays on this side of the plane: the curve's surface, at its radius, or its axis", -1e308, 1e308, false,
     false, "surface|axis"},
};

std::string millimetres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g mm", value);
  return text;
}

/// One row per node that can move: r = n·p + a − offset ≤ 0 with the unit normal n and the radius a. Its multiplier is
/// the force, in N, with which the plane pushes the node along −n.
class HalfSpace final : public Constraint {
 public:
  explicit HalfSpace(const ParameterSet& parameters)
      : normal_(parameters.vector("normal")),
        offset_(parameters.scalar("offset")),
        surface_(parameters.text("touches") == "surface") {}

  Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept override {
    return guard([&] {
      dimension_ = scene.dimension;
      normalise();
      nodes_.clear();
      for (std::size_t c = 0; c < scene.on.size(); ++c) add_rows(scene.on[c], scene.radius[c], out);
      if (nodes_.empty()) {
        throw StatusError(Code::invalid_input,
                          "every node of the curves in 'on' is held; expected one that can move; leave the constraint "
                          "out, or free an end");
      }
      describe(out);
    });
  }

  Status evaluate(const RowEvaluation& evaluation) const noexcept override {
    const std::size_t d = normal_.size();
    for (std::size_t r = 0; r < nodes_.size(); ++r) {
      const Node& node = nodes_[r];
      if (!evaluation.residual.empty()) {
        const double* p = evaluation.at->table(node.curve, Site::node) + node.index * dimension_;
        evaluation.residual[r] = depth(p, node.radius);
      }
      if (!evaluation.jacobian.empty()) std::copy(normal_.begin(), normal_.end(), evaluation.jacobian.data() + r * d);
    }
    std::fill(evaluation.hessian.begin(), evaluation.hessian.end(), 0.0);  // the rows are linear
    return {};
  }

  /// Each row is a contact of its node with the plane, which belongs to no vessel.
  Status report(const PlaceTables& at, std::vector<RowReport>& out) const noexcept override {
    return guard([&] {
      out.clear();
      for (const Node& node : nodes_) {
        RowReport report;
        report.wire_curve = node.curve;
        report.wire_coordinate = node.index;
        report.gap = depth(at.table(node.curve, Site::node) + node.index * dimension_, node.radius);
        for (std::size_t k = 0; k < normal_.size(); ++k) report.direction[k] = -normal_[k];
        out.push_back(report);
      }
    });
  }

 private:
  struct Node {
    int curve, index;
    double radius;
  };

  void normalise() {
    if (static_cast<int>(normal_.size()) != dimension_) {
      throw StatusError(Code::invalid_input, "'normal' has " + std::to_string(normal_.size()) +
                                                 " entries; expected one per dimension of the scene, " +
                                                 std::to_string(dimension_));
    }
    double length = 0.0;
    for (const double n : normal_) length = std::hypot(length, n);
    if (!(length > 0.0)) {
      throw StatusError(Code::invalid_input,
                        "'normal' has no length; expected a direction; write the one that leads "
                        "out of the half-space");
    }
    for (double& n : normal_) n /= length;
  }

  void add_rows(const CurveView& curve, const double* radius, RowDeclaration& out) {
    if (surface_ && radius == nullptr && !curve.rigid) {
      throw StatusError(Code::invalid_input, "'" + std::string(curve.name) +
                                                 "' has no radius, so that its surface is not known; give it one, or "
                                                 "write touches = \"axis\"");
    }
    double deepest = 0.0;
    for (int i = 0; i < curve.nodes; ++i) {
      const double a = surface_ && radius != nullptr ? radius[i] : 0.0;
      if (position_held(curve, i)) {
        deepest = std::max(deepest, depth(curve.start + i * dimension_, a));
      } else {
        nodes_.push_back({curve.index, i, a});
      }
    }
    if (deepest > 0.0) {
      out.warnings.push_back("half-space: '" + std::string(curve.name) + "' is held " + millimetres(deepest) +
                             " beyond the plane, where no row acts");
    }
  }

  /// Beyond the plane, mm.
  double depth(const double* p, double radius) const noexcept {
    double out = radius - offset_;
    for (std::size_t k = 0; k < normal_.size(); ++k) out += normal_[k] * p[k];
    return out;
  }

  void describe(RowDeclaration& out) const {
    out.rows = static_cast<int>(nodes_.size());
    out.place_begin.assign(1, 0);
    out.places.clear();
    for (const Node& node : nodes_) {
      out.places.push_back({node.curve, Site::node, node.index});
      out.place_begin.push_back(static_cast<int>(out.places.size()));
    }
    out.lower.assign(nodes_.size(), -std::numeric_limits<double>::infinity());
    out.upper.assign(nodes_.size(), 0.0);
  }

  std::vector<double> normal_;
  double offset_;
  bool surface_;
  int dimension_ = 3;
  std::vector<Node> nodes_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Constraint, HalfSpace>(
    bowstring::Kind::constraint, "half-space", "No node that can move crosses a plane: a bone, or the table", schema))
