#include "core/enforcement/softened_problem.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/enforcement/row_choice.hpp"
#include "core/kkt/kkt_system.hpp"
#include "enforcement/augmented-lagrangian/law.hpp"
#include "enforcement/penalty/law.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/assembly/small_scene.hpp"
#include "tests/certificate/solved_scene.hpp"
#include "tests/solvers/row_problem.hpp"

namespace bowstring::testing {

namespace {

/// φ = c r + ½ k r² + ⅙ b r³, another one for each row: every derivative is there wherever a row stands.
class Cubic final : public RowLaw {
 public:
  RowEnergy at(int row, double r) const noexcept override {
    const double c = 0.3 + 0.1 * (row % 3), k = 2.0 + (row % 2), b = 0.2;
    return {r * (c + r * (0.5 * k + r * b / 6.0)), c + r * (k + 0.5 * b * r), k + b * r};
  }
  double stiffest() const noexcept override { return 3.0; }
};

struct NamedScene {
  std::string name;
  SmallScene scene;
};

std::vector<NamedScene> scenes() {
  std::vector<NamedScene> out;
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const char* type : {"node-wise-contact", "segment-wise-contact", "concentric"}) {
        SmallScene scene;
        scene.dimension = dimension;
        scene.vessel_kinematics = scene.wire_kinematics = kinematics;
        scene.contact_type = type;
        scene.vessel_frames = dimension == 3;
        scene.wire_ends = R"(["clamped", "pinned"])";
        out.push_back({std::string(kinematics) + ", " + type + (dimension == 2 ? ", plane" : ", space"), scene});
      }
    }
  }
  return out;
}

std::vector<char> rows_of_lumen(const Assembly& assembly) { return chosen_rows(assembly, {"lumen"}); }

/// The wire's inner nodes moved across, out of the lumen: 4.5 mm where the clearance is at most 3.6.
std::vector<double> penetrated(const Session& session, unsigned seed) {
  std::vector<double> q = moved_start(session, 0.2, seed);
  const Curve& wire = *session.scene->find("wire");
  const int d = session.scene->dimension;
  for (int i = 1; i + 1 < wire.view.nodes; ++i) q[at(wire.coordinate_begin + i * d + 1)] += 4.5;
  return q;
}

std::vector<double> rows_at(Assembly& assembly, const std::vector<double>& q) {
  std::vector<double> rows(at(assembly.rows()));
  ProblemEvaluation wanted;
  wanted.rows = rows;
  const Status status = assembly.evaluate(q, wanted);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return rows;
}

}  // namespace

TEST_CASE(
    "derivatives of a softened problem are those of differences: at the start, at random and at penetrated states") {
  const Cubic law;
  for (const NamedScene& named : scenes()) {
    CAPTURE(named.name);
    const auto session = session_of(named.scene);
    Assembly& assembly = *session->assembly;
    SoftenedProblem softened(assembly, rows_of_lumen(assembly), law);
    REQUIRE_FALSE(softened.soft_rows().empty());
    REQUIRE(softened.rows() == assembly.rows() - static_cast<int>(softened.soft_rows().size()));
    std::vector<std::vector<double>> states = {moved_start(*session, 1e-3, 3), moved_start(*session, 0.3, 5)};
    if (named.scene.contact_type == "node-wise-contact") states.push_back(penetrated(*session, 7));
    for (const std::vector<double>& q : states) check_derivatives(tangent_problem(softened, q));
  }
}

TEST_CASE("derivatives on a chart of a softened problem are those of differences") {
  const Cubic law;
  for (const NamedScene& named : scenes()) {
    CAPTURE(named.name);
    const auto session = session_of(named.scene);
    Assembly& assembly = *session->assembly;
    SoftenedProblem softened(assembly, rows_of_lumen(assembly), law);
    const auto chart = softened.chart(moved_start(*session, 0.2, 1));
    std::vector<double> x(at(softened.unknowns()));
    chart->start(x);
    const std::vector<double> step = random_numbers(softened.unknowns(), 9);
    for (std::size_t u = 0; u < x.size(); ++u) x[u] += 0.1 * step[u];
    check_derivatives(chart_problem(softened, *chart, x));
  }
}

TEST_CASE("the penalties' own laws, in states that are penetrated beyond their kinks") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    SmallScene scene;
    scene.vessel_kinematics = scene.wire_kinematics = kinematics;
    const auto session = session_of(scene);
    Assembly& assembly = *session->assembly;
    const std::vector<double> q = penetrated(*session, 7), rows = rows_at(assembly, q);
    const softening::RowSides sides(assembly);
    const penalty::PenaltyLaw<penalty::Quadratic> quadratic(sides, {20.0});
    const penalty::PenaltyLaw<penalty::LogQuadratic> logarithmic(sides, {20.0, 0.5});
    augmented::AugmentedLaw augmented(sides, assembly.rows());
    augmented.weight = 20.0;
    std::fill(augmented.multipliers.begin(), augmented.multipliers.end(), 0.7);
    int pressed = 0;
    for (const RowLaw* law : {static_cast<const RowLaw*>(&quadratic), static_cast<const RowLaw*>(&logarithmic),
                              static_cast<const RowLaw*>(&augmented)}) {
      SoftenedProblem softened(assembly, chosen_rows(assembly, {}), *law);
      for (const int r : softened.soft_rows()) {
        REQUIRE(std::fabs(rows[at(r)]) > 0.05);
        pressed += law->at(r, rows[at(r)]).force > 1.0 ? 1 : 0;
      }
      check_derivatives(tangent_problem(softened, q));
    }
    CHECK(pressed >= 9);
  }
}

TEST_CASE("what is left is numbered anew: rows, groups, bounds, patterns, order, border and local rows") {
  const Cubic law;
  for (NamedScene& named : scenes()) {
    CAPTURE(named.name);
    // Another constraint before and after the one that is taken.
    std::string text = named.scene.text();
    const std::string other =
        "[[constraint]]\nname = \"NAME\"\ntype = \"node-wise-contact\"\non = [\"wire\", \"vessel\"]\nwindow = 20\n";
    text = edited(text, "[[constraint]]", edited(other, "NAME", "first") + "[[constraint]]");
    text = edited(text, "[solver]", edited(other, "NAME", "last") + "[solver]");
    const auto session = session_of_text(text);
    Assembly& assembly = *session->assembly;
    SoftenedProblem softened(assembly, rows_of_lumen(assembly), law);
    const int m = assembly.rows(), n = assembly.unknowns();
    const RowOrigin lumen = *std::find_if(assembly.row_origins().begin(), assembly.row_origins().end(),
                                          [](const RowOrigin& origin) { return origin.name == "lumen"; });
    REQUIRE(lumen.count > 0);
    REQUIRE(lumen.first + lumen.count < m);
    CHECK(softened.rows() == m - lumen.count);

    // The summary is what was said before anything was built.
    ProblemSummary said;
    REQUIRE(without_rows(assembly.summary(), {"lumen"}, said).ok());
    CHECK(said.equalities == softened.summary().equalities);
    CHECK(said.inequalities == softened.summary().inequalities);
    CHECK(said.equalities + said.inequalities == softened.rows());
    REQUIRE(said.row_groups.size() == softened.summary().row_groups.size());
    for (std::size_t g = 0; g < said.row_groups.size(); ++g) {
      CHECK(said.row_groups[g].name == softened.summary().row_groups[g].name);
      CHECK(said.row_groups[g].first == softened.summary().row_groups[g].first);
      CHECK(said.row_groups[g].count == softened.summary().row_groups[g].count);
      CHECK(said.row_groups[g].inequalities == softened.summary().row_groups[g].inequalities);
    }

    // Values and Jacobians are those of the rows kept.
    const std::vector<double> q = moved_start(*session, 0.2, 2), rows = rows_at(assembly, q);
    std::vector<double> kept(at(softened.rows())), jacobian(at(softened.jacobian_pattern().entries())),
        all(at(assembly.jacobian_pattern().entries()));
    ProblemEvaluation wanted;
    wanted.rows = kept;
    wanted.jacobian = jacobian;
    REQUIRE(softened.evaluate(q, wanted).ok());
    wanted = {};
    wanted.jacobian = all;
    REQUIRE(assembly.evaluate(q, wanted).ok());
    const std::vector<double> before = dense_rows(assembly.jacobian_pattern(), all, m, n),
                              after = dense_rows(softened.jacobian_pattern(), jacobian, softened.rows(), n);
    REQUIRE(largest(after) > 0.1);
    int k = 0;
    for (int r = 0; r < m; ++r) {
      if (r >= lumen.first && r < lumen.first + lumen.count) continue;
      CHECK(kept[at(k)] == rows[at(r)]);
      CHECK(softened.row_upper()[at(k)] == assembly.row_upper()[at(r)]);
      CHECK(softened.row_lower()[at(k)] == assembly.row_lower()[at(r)]);
      CHECK(std::equal(after.begin() + k * n, after.begin() + (k + 1) * n, before.begin() + r * n));
      ++k;
    }

    // Every unknown and every row once, in the same sequence.
    std::vector<int> order(softened.order().begin(), softened.order().end()), sorted = order, expected;
    for (const int index : assembly.order()) {
      const int r = index - n;
      if (r < 0) expected.push_back(index);
      if (r >= 0 && r < lumen.first) expected.push_back(index);
      if (r >= lumen.first + lumen.count) expected.push_back(index - lumen.count);
    }
    CHECK(order == expected);
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> each(sorted.size());
    std::iota(each.begin(), each.end(), 0);
    CHECK(sorted == each);
    CHECK(softened.border() == assembly.border());
    REQUIRE(softened.local_rows().size() == assembly.local_rows().size());

    // A row that is kept and one that is taken away weigh the same in the Lagrangian where the law says the multiplier.
    std::vector<double> multipliers = random_numbers(m, 4), expected_hessian(at(assembly.hessian_pattern().entries())),
                        hessian = expected_hessian, kept_multipliers(kept.size());
    class Linear final : public RowLaw {
     public:
      explicit Linear(const std::vector<double>& forces) : forces_(forces) {}
      RowEnergy at(int row, double r) const noexcept override {
        const double force = forces_[static_cast<std::size_t>(row)];
        return {force * r, force, 0.0};
      }
      double stiffest() const noexcept override { return 0.0; }

     private:
      const std::vector<double>& forces_;
    } linear(multipliers);
    SoftenedProblem forced(assembly, rows_of_lumen(assembly), linear);
    forced.gather(multipliers, kept_multipliers);
    REQUIRE(assembly.lagrangian_hessian(q, 1.0, multipliers, expected_hessian).ok());
    REQUIRE(forced.lagrangian_hessian(q, 1.0, kept_multipliers, hessian).ok());
    REQUIRE(largest(expected_hessian) > 1.0);
    CHECK(hessian == expected_hessian);
  }
}

TEST_CASE("patterns follow epochs, and the KKT system of a softened problem is that of its numbers") {
  const Cubic law;
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    SmallScene scene;
    scene.vessel_kinematics = scene.wire_kinematics = kinematics;
    const auto session = narrow_session(scene);
    Assembly& assembly = *session->assembly;
    SoftenedProblem softened(assembly, chosen_rows(assembly, {}), law);
    const std::vector<int> before(softened.order().begin(), softened.order().end());
    const std::vector<double> q = slid(*session, 1.4);
    REQUIRE(softened.accept(q).ok());
    REQUIRE(softened.epoch_due());
    REQUIRE(softened.new_epoch().ok());
    CHECK(softened.epochs() == 2);
    CHECK(std::vector<int>(softened.order().begin(), softened.order().end()) != before);
    check_derivatives(tangent_problem(softened, q));

    std::vector<double> gradient(at(softened.unknowns())), jacobian(at(softened.jacobian_pattern().entries())),
        hessian(at(softened.hessian_pattern().entries())), none(at(softened.rows()), 0.0), delta(gradient.size()),
        lambda(none.size());
    ProblemEvaluation wanted;
    wanted.gradient = gradient;
    wanted.jacobian = jacobian;
    REQUIRE(softened.evaluate(q, wanted).ok());
    REQUIRE(softened.lagrangian_hessian(q, 1.0, none, hessian).ok());
    kkt::KktSystem system;
    system.analyse(softened, jacobian);
    kkt::KktSystem::Values values;
    values.hessian = hessian;
    values.jacobian = jacobian;
    values.softness = none;
    REQUIRE(system.factor(values).exists);
    REQUIRE(largest(gradient) > 0.1);
    CHECK(system.solve(gradient, none, {}, 5, delta, lambda) <= 1e-9);
    CHECK(largest(delta) > 0.0);
  }
}

TEST_CASE("the step guard and what is refused are the problem's own") {
  const Cubic law;
  const auto session = session_of(SmallScene{});
  SoftenedProblem softened(*session->assembly, chosen_rows(*session->assembly, {}), law);
  double energy = 0.0;
  ProblemEvaluation wanted;
  wanted.energy = &energy;
  const std::vector<double> far = penetrated(*session, 1), near = moved_start(*session, 1e-3, 1);
  softened.set_guard(0.5);
  CHECK(softened.evaluate(near, wanted).ok());
  CHECK(softened.evaluate(far, wanted).code == Code::refused);
  CHECK(softened.travelled() > 0.5);
  // A wire that stands outside may move from there as freely as one inside.
  REQUIRE(softened.accept(far).ok());
  CHECK(softened.evaluate(far, wanted).ok());
  CHECK(softened.travelled() <= 1e-12);
  softened.set_guard(std::numeric_limits<double>::infinity());
  CHECK(softened.largest_motion(near, far) > 4.0);
  CHECK(softened.largest_motion(near, far) < 5.0);
}

TEST_CASE("a stiff row's rounding is a floor of the stationarity") {
  class Stiff final : public RowLaw {
   public:
    RowEnergy at(int, double) const noexcept override { return {}; }
    double stiffest() const noexcept override { return 1e9; }
  } law;
  const auto session = session_of(SmallScene{});
  Assembly& assembly = *session->assembly;
  SoftenedProblem softened(assembly, chosen_rows(assembly, {}), law), nothing(assembly, {}, law);
  const std::vector<double> q = session->scene->start_coordinates();
  REQUIRE(softened.accept(q).ok());
  REQUIRE(nothing.accept(q).ok());
  CHECK(softened.row_rounding() > 1e-16);
  CHECK(softened.row_rounding() < 1e-13);
  CHECK(softened.rounding_floor() >= 1e9 * softened.row_rounding());
  CHECK(nothing.rounding_floor() == assembly.rounding_floor());
}

TEST_CASE("a pattern that lacks a row's pairs is said, not written past") {
  RowProblem problem({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, {{{1.0, 1.0, 0.0}}});
  const Cubic law;
  SoftenedProblem softened(problem, {1}, law);
  std::vector<double> values(3);
  const Status status = softened.lagrangian_hessian(std::vector<double>{1.0, 1.0, 1.0}, 1.0, {}, values);
  CHECK(status.code == Code::failed);
  CHECK(status.text ==
        "the Hessian's pattern lacks a pair of unknowns that row 0 reads, so that its energy finds no place there");
}

}  // namespace bowstring::testing
