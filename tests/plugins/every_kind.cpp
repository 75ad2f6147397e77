#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <memory>

#include "core/interfaces/comparison.hpp"
#include "core/interfaces/constraint.hpp"
#include "core/interfaces/energy.hpp"
#include "core/interfaces/enforcement.hpp"
#include "core/interfaces/geometry.hpp"
#include "core/interfaces/ground_cost.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/interfaces/solver.hpp"
#include "core/interfaces/transport.hpp"
#include "core/interfaces/writer.hpp"
#include "core/transport/pair_costs.hpp"
#include "plugins/host/plugin_host.hpp"
#include "tests/plugins/plugin_folders.hpp"
#include "tests/plugins/quadratic_problem.hpp"

namespace bowstring {

namespace {

template <class Interface>
using Owned = std::unique_ptr<Interface, Destructor>;

PluginHost& host() {
  static PluginHost instance([] {
    PluginHostOptions options;
    options.command_line_path = {testing::fixture_folder()};
    options.executable_path = "";
    return options;
  }());
  return instance;
}

template <class Interface>
Owned<Interface> create(Kind kind, const std::string& name, const ParameterSet& parameters = {}) {
  Status status;
  const ComponentDescriptor* component = host().find(kind, name, status);
  REQUIRE_MESSAGE(component != nullptr, status.text);
  void* raw = nullptr;
  status = component->create(parameters, &raw);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return Owned<Interface>(static_cast<Interface*>(raw), component->destroy);
}

ParameterValue number(const std::string& key, double value) {
  ParameterValue out;
  out.key = key;
  out.number = value;
  return out;
}

ParameterValue integer(const std::string& key, long value) {
  ParameterValue out;
  out.key = key;
  out.type = ParameterType::integer;
  out.integer = value;
  return out;
}

/// Three nodes in the plane, the middle one pushed below y = 0.
struct Bent {
  std::vector<double> reference = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0};
  std::vector<double> position = {0.0, 0.0, 1.0, -0.5, 2.0, 0.25};
  std::vector<double> arc = {0.0, 1.0, 2.0};

  CurveView view() const {
    CurveView curve;
    curve.index = 4;
    curve.name = "bent";
    curve.dimension = 2;
    curve.nodes = 3;
    curve.reference = reference.data();
    curve.start = position.data();
    curve.arc = arc.data();
    return curve;
  }
};

class NodeTable final : public PlaceTables {
 public:
  explicit NodeTable(const Bent& curve) : curve_(&curve) {}
  const double* table(int curve, Site site) const noexcept override {
    return curve == 4 && site == Site::node ? curve_->position.data() : nullptr;
  }

 private:
  const Bent* curve_;
};

}  // namespace

TEST_CASE("geometry through the host") {
  const auto segment = create<Geometry>(Kind::geometry, "test-segment", {{number("length", 4.0), integer("nodes", 5)}});
  CurveGraph graph;
  REQUIRE(segment->build(2, graph).ok());
  REQUIRE(graph.curves.size() == 1);
  CHECK(graph.curves[0].points == std::vector<double>{0, 0, 1, 0, 2, 0, 3, 0, 4, 0});
}

TEST_CASE("kinematics through the host") {
  const Bent bent;
  const auto nodes = create<Kinematics>(Kind::kinematics, "test-free-nodes");
  KinematicsDeclaration declaration;
  Needs needs;
  needs.stretch = true;
  needs.reason = "the test asks for stretch";
  const Status refusal = nodes->declare(bent.view(), needs, declaration);
  CHECK(refusal.code == Code::unsupported);
  CHECK(refusal.text == "free nodes have no edges; the test asks for stretch");

  REQUIRE(nodes->declare(bent.view(), {}, declaration).ok());
  REQUIRE(declaration.sites.size() == 1);
  CHECK(declaration.fields[0].start == bent.position);
  CHECK(declaration.sites[0].stencil == std::vector<int>{0, 1, 2, 3, 4, 5});

  std::vector<double> values(6), jacobian(12);
  SiteEvaluation evaluation;
  evaluation.q = bent.position;
  evaluation.values = values;
  evaluation.jacobian = jacobian;
  REQUIRE(nodes->evaluate(evaluation).ok());
  CHECK(values == bent.position);
  CHECK(jacobian == std::vector<double>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});

  CurveSample sample;
  const std::vector<double> middle = {1.5};
  REQUIRE(nodes->sample(bent.position, middle, sample).ok());
  CHECK(sample.position == std::vector<double>{1.5, -0.125});

  std::vector<double> adopted(6);
  const std::vector<double> orientation(8, 0.0);
  REQUIRE(nodes->adopt({bent.reference, orientation}, adopted).ok());
  CHECK(adopted == bent.reference);
  adopted.resize(4);
  CHECK(nodes->adopt({bent.reference, orientation}, adopted).text == "another number of nodes");
}

TEST_CASE("energy through the host") {
  const Bent bent;
  const auto springs = create<Energy>(Kind::energy, "test-springs");
  EnergyDeclaration declaration;
  REQUIRE(springs->declare(bent.view(), declaration).ok());
  REQUIRE(declaration.laws.size() == 1);
  CHECK(declaration.descriptions[0].parameters == std::vector<std::string>{"stiffness"});

  const std::vector<double> stiffness(3, 8.0);
  const double* parameter[] = {stiffness.data()};
  std::vector<double> energy(3), stress(6), modulus(9);
  LawBatch batch;
  batch.count = 3;
  batch.dimension = 2;
  batch.x = bent.position.data();
  batch.reference = bent.reference.data();
  batch.parameter = parameter;
  batch.energy = energy.data();
  batch.stress = stress.data();
  batch.modulus = modulus.data();
  REQUIRE(declaration.laws[0]->evaluate(batch).ok());
  CHECK(energy == std::vector<double>{0.0, 1.0, 0.25});
  CHECK(stress == std::vector<double>{0, 0, 0, -4, 0, 2});
  CHECK(modulus == std::vector<double>{8, 0, 8, 8, 0, 8, 8, 0, 8});
}

TEST_CASE("constraint through the host") {
  const Bent bent;
  const auto floor = create<Constraint>(Kind::constraint, "test-floor");
  ConstraintScene scene;
  scene.dimension = 2;
  RowDeclaration rows;
  CHECK(floor->declare(scene, rows).text == "a floor acts on one curve");
  scene.on = {bent.view()};
  REQUIRE(floor->declare(scene, rows).ok());
  REQUIRE(rows.rows == 3);
  CHECK(rows.places[1].curve == 4);
  CHECK(rows.lower == std::vector<double>{0.0, 0.0, 0.0});
  const std::vector<double> before = {0.0, 0.5, 1.0, -0.75, 2.0, 0.0};
  scene.on.front().previous = before.data();
  RowDeclaration after;
  REQUIRE(floor->declare(scene, after).ok());
  CHECK(after.lower == std::vector<double>{0.0, -0.75, 0.0});

  const NodeTable table(bent);
  std::vector<double> residual(3), jacobian(6);
  RowEvaluation evaluation;
  evaluation.at = &table;
  evaluation.residual = residual;
  evaluation.jacobian = jacobian;
  REQUIRE(floor->evaluate(evaluation).ok());
  CHECK(residual == std::vector<double>{0.0, -0.5, 0.25});
  CHECK(jacobian == std::vector<double>{0, 1, 0, 1, 0, 1});
}

TEST_CASE("solver and enforcement through the host") {
  const auto solver = create<Solver>(Kind::solver, "test-steepest-descent",
                                     {{number("tolerance", 1e-10), integer("max-iterations", 1000)}});
  const auto enforcement = create<Enforcement>(Kind::enforcement, "test-pass-on");
  ProblemSummary with_rows;
  with_rows.inequalities = 2;
  ProblemSummary remaining;
  REQUIRE(enforcement->remaining(with_rows, remaining).ok());
  const Status refusal = solver->can(remaining);
  CHECK(refusal.code == Code::unsupported);
  CHECK(refusal.text == "steepest descent takes neither rows nor bounds");

  testing::QuadraticProblem problem({1.0, 3.0}, {2.0, -1.0});
  REQUIRE(solver->can(problem.summary()).ok());
  const std::vector<double> start = {10.0, 10.0};
  int calls = 0;
  SolverContext context;
  context.on_iteration = [&](const IterationRecord&) { return ++calls > 0; };
  SolverResult result;
  REQUIRE(enforcement->solve(problem, *solver, start, context, result).ok());
  CHECK(result.claim == Claim::optimal);
  REQUIRE(result.q.size() == 2);
  CHECK(result.q[0] == doctest::Approx(2.0).epsilon(1e-9));
  CHECK(result.q[1] == doctest::Approx(-1.0).epsilon(1e-9));
  CHECK(calls == result.iterations);
  CHECK(calls > 1);
}

namespace {

/// Unit speed along e₁ and the curvature 1/r about e₃: a circle in the plane z = 0. The number grows with s².
class Circle final : public GroupRightHandSide {
 public:
  explicit Circle(double radius) : radius_(radius) {}
  Status evaluate(double s, Span<const double>, Span<const double>, Span<double> body_velocity,
                  Span<double> rate) noexcept override {
    const double velocity[] = {0.0, 0.0, 1.0 / radius_, 1.0, 0.0, 0.0};
    std::copy(std::begin(velocity), std::end(velocity), body_velocity.begin());
    rate[0] = 2.0 * s;
    return {};
  }

 private:
  double radius_;
};

}  // namespace

TEST_CASE("integrator through the host") {
  const auto midpoint = create<Integrator>(Kind::integrator, "test-midpoint", {{integer("steps", 7)}});
  Circle circle(2.0);
  std::vector<double> frame = {1, 0, 0, 0, 0, 0, 0}, numbers = {0.0};
  REQUIRE(midpoint->integrate(circle, 0.0, std::acos(-1.0), frame, numbers).ok());
  // A quarter turn, exact for a constant velocity on the group.
  CHECK(frame[0] == doctest::Approx(std::sqrt(0.5)));
  CHECK(frame[3] == doctest::Approx(std::sqrt(0.5)));
  CHECK(frame[4] == doctest::Approx(2.0));
  CHECK(frame[5] == doctest::Approx(2.0));
  CHECK(numbers[0] == doctest::Approx(std::acos(-1.0) * std::acos(-1.0)));
}

TEST_CASE("ground cost through the host") {
  const auto cost = create<GroundCost>(Kind::ground_cost, "test-squared-distance");
  Measure a, b;
  a.position = {0, 0, 0, 1, 2, 3};
  a.orientation = {1, 0, 0, 0, std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // the second turned by π/2 about z
  b.position = {1, 0, 3};
  const std::vector<int> pairs = {0, 0, 1, 0};
  std::vector<double> value(2), gradient(12, -1.0);
  REQUIRE(cost->evaluate(a, b, pairs, value, gradient).ok());
  CHECK(value == std::vector<double>{10.0, 4.0});
  const std::vector<double> expected = {0, 0, 0, -2, 0, -6, 0, 0, 0, 4, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(gradient[i] == doctest::Approx(expected[i]));
  CHECK(cost->unit() == std::string("mm^2"));
  CHECK_FALSE(cost->needs_frames());
  CHECK_FALSE(cost->dear());
  REQUIRE(cost->rows(a, b, 0, 2, value).ok());
  CHECK(value == std::vector<double>{10.0, 4.0});
  CHECK(cost->lower_bounds(a, b, 0, 2, value).code == Code::unsupported);
}

TEST_CASE("transport through the host") {
  const auto transport = create<Transport>(Kind::transport, "test-north-west-corner");
  const std::vector<double> a = {0.5, 0.25, 0.25}, b = {0.25, 0.75};
  const double x[] = {0.0, 1.0, 3.0}, y[] = {0.0, 2.0};
  std::vector<double> cost;
  for (const double p : x) {
    for (const double q : y) cost.push_back((p - q) * (p - q));
  }
  MatrixCosts between(cost, 3, 2);
  TransportProblem problem;
  problem.weight_a = a;
  problem.weight_b = b;
  problem.between = &between;
  TransportAnswer answer;
  REQUIRE(transport->solve(problem, answer).ok());
  CHECK(answer.value == doctest::Approx(0.25 * 0 + 0.25 * 4 + 0.25 * 1 + 0.25 * 1));
  CHECK(std::fabs(answer.gap) < 1e-15);
  CHECK_FALSE(transport->lets_mass_go());
}

TEST_CASE("projection through the host") {
  const auto orthographic = create<Projection>(Kind::projection, "test-orthographic");
  const std::vector<double> points = {1, 2, 3, 4, 5, 6};
  std::vector<double> image(4), jacobian(12);
  REQUIRE(orthographic->project(points, image, jacobian).ok());
  CHECK(image == std::vector<double>{1, 2, 4, 5});
  CHECK(jacobian == std::vector<double>{1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0});
}

TEST_CASE("loss through the host") {
  const auto loss = create<Loss>(Kind::loss, "test-mean-squared-distance");
  Measure predicted, observed;
  predicted.position = {0, 0, 0, 1, 1, 1};
  observed.position = {0, 0, 2, 1, 1, 1};
  double value = 0.0;
  std::vector<double> gradient(6);
  REQUIRE(loss->evaluate(predicted, observed, &value, gradient).ok());
  CHECK(value == 2.0);
  CHECK(gradient == std::vector<double>{0, 0, -2, 0, 0, 0});
  observed.position.resize(3);
  CHECK(loss->evaluate(predicted, observed, &value, {}).text == "prediction and observation differ in size");
}

TEST_CASE("residual through the host") {
  const auto identity = create<Residual>(Kind::residual, "test-identity");
  std::vector<double> eta(6, 1.0);
  REQUIRE(identity->evaluate({}, eta).ok());
  CHECK(eta == std::vector<double>(6, 0.0));
}

TEST_CASE("readout and writer through the host") {
  const char* document = R"({"status": "converged"})";
  const auto length = create<Readout>(Kind::readout, "test-document-length");
  std::vector<std::string> names;
  std::vector<double> values;
  REQUIRE(length->read(document, names, values).ok());
  CHECK(names == std::vector<std::string>{"document_length"});
  CHECK(values == std::vector<double>{23.0});

  testing::TemporaryFolder folder;
  const auto copy = create<Writer>(Kind::writer, "test-copy");
  REQUIRE(copy->write(document, (folder.path() + "/copy").c_str()).ok());
  std::string written;
  std::getline(std::ifstream(folder.path() + "/copy"), written);
  CHECK(written == document);
  CHECK(copy->write(document, "/nonexistent/copy").text == "cannot write '/nonexistent/copy'");
}

TEST_CASE("every kind has its test plugin") {
  for (int kind = 0; kind < kind_count; ++kind) CHECK_FALSE(host().names(static_cast<Kind>(kind)).empty());
}

}  // namespace bowstring
