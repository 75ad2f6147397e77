#include <cmath>
#include <limits>
#include <vector>

#include "core/interfaces/constraint.hpp"
#include "plugin_under_test.hpp"

namespace bowstring::testing {

namespace {

/// A curve of four nodes, (0, 0), (1, 2), (2, 4), … in the plane, (0, 0, 0), (1, 2, −1), … in space.
struct Curve final : PlaceTables {
  CurveView view;
  std::vector<double> points;
  std::vector<double> radius = {0.1, 0.2, 0.3, 0.4};

  explicit Curve(int dimension) {
    const double step[] = {1.0, 2.0, -1.0};
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < dimension; ++k) points.push_back(i * step[k]);
    }
    view.name = "curve";
    view.dimension = dimension;
    view.nodes = 4;
    view.start = view.reference = points.data();
  }
  void hold(int end) {
    for (bool& held : view.end[end].position_held) held = true;
  }
  const double* table(int, Site) const noexcept override { return points.data(); }
};

struct HalfSpace {
  std::unique_ptr<Constraint> constraint;
  RowDeclaration rows;
  Status status;

  HalfSpace(const Curve& curve, std::vector<double> normal, double offset, bool surface, bool has_radius = true) {
    ParameterSet parameters;
    add(parameters, "normal").vector = std::move(normal);
    add(parameters, "offset").number = offset;
    add(parameters, "touches").text = surface ? "surface" : "axis";
    constraint = make<Constraint>(parameters);
    ConstraintScene scene;
    scene.dimension = curve.view.dimension;
    scene.on = {curve.view};
    scene.radius = {has_radius ? curve.radius.data() : nullptr};
    status = constraint->declare(scene, rows);
  }

  std::vector<double> residual(const Curve& at) const {
    std::vector<double> out(static_cast<std::size_t>(rows.rows));
    RowEvaluation evaluation;
    evaluation.at = &at;
    evaluation.residual = out;
    REQUIRE(constraint->evaluate(evaluation).ok());
    return out;
  }
};

}  // namespace

TEST_CASE("a row says how far a node's surface is beyond the plane, in mm, whatever the normal's length") {
  const Curve curve(2);
  const HalfSpace surface(curve, {3.0, 4.0}, 5.0, true), axis(curve, {30.0, 40.0}, 5.0, false);
  REQUIRE_MESSAGE(surface.status.ok(), surface.status.text);
  REQUIRE(surface.rows.rows == 4);
  const std::vector<double> deep = surface.residual(curve), deep_axis = axis.residual(curve);
  for (std::size_t i = 0; i < 4; ++i) {
    const double along = 2.2 * static_cast<double>(i);  // (1, 2)·(0.6, 0.8) per node
    CHECK(deep[i] == doctest::Approx(along - 5.0 + curve.radius[i]).epsilon(1e-14));
    CHECK(deep_axis[i] == doctest::Approx(along - 5.0).epsilon(1e-14));
    CHECK(surface.rows.upper[i] == 0.0);
    CHECK(surface.rows.lower[i] == -std::numeric_limits<double>::infinity());
    CHECK(surface.rows.places[i].site == Site::node);
    CHECK(surface.rows.places[i].index == static_cast<int>(i));
  }
}

TEST_CASE("the Jacobian is the row's slope, and there is no second derivative") {
  for (const int dimension : {2, 3}) {
    Curve curve(dimension);
    const auto d = static_cast<std::size_t>(dimension);
    const HalfSpace plane(curve, dimension == 2 ? std::vector<double>{1.0, -2.0} : std::vector<double>{1.0, -2.0, 2.0},
                          0.4, true);
    std::vector<double> jacobian(4 * d), weight(4, 2.0);
    std::vector<double> hessian(4 * static_cast<std::size_t>(packed_size(dimension)), 7.0);
    RowEvaluation evaluation;
    evaluation.at = &curve;
    evaluation.jacobian = jacobian;
    evaluation.weight = weight;
    evaluation.hessian = hessian;
    REQUIRE(plane.constraint->evaluate(evaluation).ok());
    for (const double second : hessian) CHECK(second == 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
      double squared = 0.0;
      for (std::size_t k = 0; k < d; ++k) {
        const double h = 0.5;  // exact: the row is linear
        const auto moved = [&](double by) {
          Curve out(dimension);
          out.points[i * d + k] += by;
          return plane.residual(out)[i];
        };
        const double slope = (moved(h) - moved(-h)) / (2.0 * h);
        CHECK(jacobian[i * d + k] == doctest::Approx(slope).epsilon(1e-12));
        squared += slope * slope;
      }
      CHECK(squared == doctest::Approx(1.0));  // so that a multiplier is a force
    }
  }
}

TEST_CASE("held nodes have no row, and are named where they are beyond the plane") {
  Curve curve(2);
  curve.hold(0);
  const HalfSpace one(curve, {0.0, 1.0}, 10.0, true);
  CHECK(one.rows.rows == 3);
  CHECK(one.rows.places[0].index == 1);
  CHECK(one.rows.warnings.empty());

  curve.view.end[0].edge_held = true;
  CHECK(HalfSpace(curve, {0.0, 1.0}, 10.0, true).rows.rows == 2);

  curve.hold(1);
  const HalfSpace beyond(curve, {0.0, 1.0}, 5.0, true);
  CHECK(beyond.rows.rows == 1);
  REQUIRE(beyond.rows.warnings.size() == 1);
  CHECK(beyond.rows.warnings[0] == "half-space: 'curve' is held 1.4 mm beyond the plane, where no row acts");
}

TEST_CASE("what cannot be is refused in words") {
  Curve curve(2);
  const HalfSpace flat(curve, {0.0, 0.0, 1.0}, 0.0, true);
  CHECK(flat.status.code == Code::invalid_input);
  CHECK(flat.status.text == "'normal' has 3 entries; expected one per dimension of the scene, 2");
  CHECK(HalfSpace(curve, {0.0, 0.0}, 0.0, true).status.text ==
        "'normal' has no length; expected a direction; write the one that leads out of the half-space");
  CHECK(HalfSpace(curve, {0.0, 1.0}, 0.0, false, false).status.ok());
  CHECK(HalfSpace(curve, {0.0, 1.0}, 0.0, true, false).status.text ==
        "'curve' has no radius, so that its surface is not known; give it one, or write touches = \"axis\"");
  curve.view.rigid = true;
  CHECK(HalfSpace(curve, {0.0, 1.0}, 0.0, true).status.text ==
        "every node of the curves in 'on' is held; expected one that can move; leave the constraint out, or free an "
        "end");
}

}  // namespace bowstring::testing
