#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/result/quantities.hpp"
#include "tests/solvers/solver_case.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Keys {
  bool leave_saddles = true;
  double time_limit = 0.0;    // 0: none
  double first_radius = 0.0;  // 0: the default
  long max_iterations = 0;    // 0: the default
};

OwnedSolver make_solver(const Keys& keys = {}) {
  return solver_plugin("trust-region", [&](const SetParameter& value) {
    value("leave-saddles", ParameterType::flag).flag = keys.leave_saddles;
    if (keys.time_limit > 0.0) value("time-limit", ParameterType::scalar).number = keys.time_limit;
    if (keys.first_radius > 0.0) value("first-radius", ParameterType::scalar).number = keys.first_radius;
    if (keys.max_iterations > 0) value("max-iterations", ParameterType::integer).integer = keys.max_iterations;
  });
}

Answer solve_problem(Problem& problem, const std::vector<double>& start, const Keys& keys = {},
                     const std::function<bool(const IterationRecord&)>& progress = {}) {
  return solve_with(*make_solver(keys), problem, start, progress);
}

SolvedScene solved_file(const char* name, const std::vector<Override>& overrides) {
  return solved(session_of_file(name, overrides));
}

double energy_of(SolvedScene& scene) {
  double energy = 0.0;
  ProblemEvaluation wanted;
  wanted.energy = &energy;
  REQUIRE(scene.assembly().evaluate(scene.solution.q, wanted).ok());
  return energy;
}

const char* const bend_45 = R"(schema = 1
[scene]
dimension = 3
[[wire]]
name     = "rod"
geometry = { type = "arc", radius = "100 mm", angle = "45 deg", nodes = 41 }
radius   = "0.1 mm"
ends     = ["clamped", "free"]
[[energy]]
type = "vessel-strain"
on   = "rod"
bending-stiffness   = "833333.333333333 N mm^2"
torsional-stiffness = "833333.333333333 N mm^2"
[[energy]]
type  = "point-load"
on    = "rod"
force = ["0 N", "0 N", "FORCE N"]
at    = "last"
[solver]
type = "trust-region"
)";

/// Node positions of the scene's first curve.
std::vector<double> points(SolvedScene& scene) {
  Readings readings;
  const Status status = read_solution(*scene.session, scene.solution, readings);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return readings.curves.front().points;
}

}  // namespace

TEST_CASE("a quadratic: its rest in a few steps, and what was done is said") {
  RowProblem problem(stiffness, rest);
  int calls = 0;
  const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {}, [&](const IterationRecord& record) {
    CHECK(record.iteration == calls++);
    return true;
  });
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  CHECK(answer.result.claim == Claim::optimal);
  CHECK(contains(answer.result.reason, "the curvature is positive in every direction that the rows leave"));
  check_point(answer.result.q, rest, 1e-8);
  CHECK(answer.result.evaluations > 1);
  CHECK(answer.result.factorizations > 1);
  CHECK(static_cast<int>(answer.result.history.size()) == answer.result.iterations + 1);
  CHECK(calls == answer.result.iterations + 1);
  CHECK(answer.result.history.front().energy == doctest::Approx(9.0));
  CHECK(answer.result.history.back().stationarity <= 1e-8);
  CHECK(answer.result.history.back().step == 1.0);
  CHECK(problem.guards == std::vector<double>{0.5, infinity});
  CHECK(problem.reference == answer.result.q);
}

TEST_CASE("equality rows hold, with their multipliers") {
  RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 2.0, 2.0}});
  const Answer answer = solve_problem(problem, {0.5, 0.0, -1.0});
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  CHECK(answer.result.claim == Claim::optimal);
  check_point(answer.result.q, {2.0, 0.0, -2.0}, 1e-8);
  REQUIRE(answer.result.multipliers.size() == 1);
  CHECK(answer.result.multipliers[0] == doctest::Approx(1.0));
}

TEST_CASE("rows that contradict each other are infeasible") {
  RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 2.0, 2.0}, {{1.0, 1.0, 0.0}, 3.0, 3.0}});
  const Answer answer = solve_problem(problem, {0.5, 0.0, -1.0});
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  CHECK(answer.result.claim == Claim::infeasible);
  CHECK(contains(answer.result.reason, "the rows cannot hold together: "));
}

TEST_CASE("inequality rows are refused with a reason, and more equality rows than unknowns") {
  const OwnedSolver solver = make_solver();
  CHECK_FALSE(solver->traits().inequalities);
  ProblemSummary summary;
  summary.unknowns = 5;
  CHECK(solver->can(summary).ok());
  summary.inequalities = 3;
  const Status refused = solver->can(summary);
  CHECK(refused.code == Code::unsupported);
  CHECK(contains(refused.text, "takes no inequality rows (3)"));
  summary.inequalities = 0;
  summary.equalities = 6;
  CHECK(contains(solver->can(summary).text, "more equality rows (6) than unknowns (5)"));
  CHECK(contains(refusal_of(edited(contact_text(contact_scene(2)), "type = \"ipopt\"", "type = \"trust-region\"")),
                 "it takes no inequality rows"));
}

TEST_CASE("bounds keep steps inside, and hold them back where the minimum lies beyond") {
  RowProblem inside(stiffness, rest);
  inside.upper_bounds[0] = 3.5;
  inside.lower_bounds[2] = -2.1;
  const Answer free = solve_problem(inside, {0.0, 0.0, 5.0});
  REQUIRE_MESSAGE(free.status.ok(), free.status.text);
  CHECK(free.result.claim == Claim::optimal);
  check_point(free.result.q, rest, 1e-8);

  RowProblem beyond(stiffness, rest);
  beyond.upper_bounds[0] = 2.0;
  const Answer held = solve_problem(beyond, {2.5, 0.0, 0.0});
  REQUIRE_MESSAGE(held.status.ok(), held.status.text);
  CHECK(held.result.claim == Claim::stalled);
  CHECK(contains(held.result.reason, "a bound on an unknown"));
  CHECK(held.result.q[0] < 2.0);
  CHECK(held.result.q[0] > 1.9);
  for (const IterationRecord& record : held.result.history) CHECK(std::isfinite(record.energy));
}

TEST_CASE("refused trials shorten the region") {
  for (const bool rows : {false, true}) {
    CAPTURE(rows);
    std::vector<QuadraticRow> list;
    if (rows) list = {{{1.0, 1.0, 0.0}, 2.0, 2.0}};
    RowProblem problem(stiffness, rest, list);
    int refused = 0;
    problem.answer = [&](const RowProblem& self, const std::vector<double>& q) {
      Status status = within_reach(self, q);
      refused += status.ok() ? 0 : 1;
      return status;
    };
    const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {true, 0.0, 10.0});
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    CHECK(refused > 0);
    CHECK(answer.result.claim == Claim::optimal);
    check_point(answer.result.q, rows ? std::vector<double>{2.0, 0.0, -2.0} : rest, 1e-8);
  }
}

TEST_CASE("no step at all: the solver stalls where it is; an evaluation that breaks down is the reason") {
  const std::vector<double> start = {0.5, 0.25, 0.0};
  RowProblem problem(stiffness, rest);
  problem.answer = [](const RowProblem& self, const std::vector<double>& q) {
    return q == self.reference ? Status{} : Status{Code::refused, {}};
  };
  Answer answer = solve_problem(problem, start);
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  CHECK(answer.result.claim == Claim::stalled);
  CHECK(answer.result.reason == "every trial step was refused, however short");
  CHECK(answer.result.q == start);

  problem.answer = [](const RowProblem&, const std::vector<double>& q) {
    return q[0] > 2.0 ? Status::failure(Code::failed, "a law broke") : Status{};
  };
  answer = solve_problem(problem, start);
  CHECK(answer.result.claim == Claim::failed);
  CHECK(answer.result.reason == "a law broke");

  problem.answer = [](const RowProblem&, const std::vector<double>& q) {
    return q[0] > 0.5 ? Status::failure(Code::interrupted, "somebody pulled the plug") : Status{};
  };
  answer = solve_problem(problem, start);
  CHECK(answer.status.code == Code::interrupted);
  CHECK(answer.status.text == "somebody pulled the plug");
  CHECK(problem.guards.back() == infinity);
}

TEST_CASE("limits and the user's stop") {
  RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 2.0, 2.0}});
  const std::vector<double> start = {0.5, 1.5, 0.0};
  const auto reason = [&](const Keys& keys, const std::function<bool(const IterationRecord&)>& progress = {}) {
    const Answer answer = solve_problem(problem, start, keys, progress);
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    CHECK(answer.result.claim == Claim::stalled);
    CHECK(answer.result.q.size() == start.size());
    return answer.result.reason;
  };
  CHECK(reason({true, 0.0, 0.0, 1}) == "the iteration limit was reached");
  CHECK(reason({true, 1e-12}) == "the time limit was reached");
  CHECK(reason({}, [](const IterationRecord&) { return false; }) == "stopped by the user");
  const Answer thrown = solve_problem(problem, start, {}, [](const IterationRecord&) -> bool {
    throw std::runtime_error("the progress bar fell off");
  });
  CHECK(thrown.status.code == Code::failed);
  CHECK(thrown.status.text == "the progress bar fell off");
}

TEST_CASE("a saddle is left along negative curvature, which the rows may forbid") {
  // ½ (−x² + y² + z²) has a saddle at 0 and no minimum; where 2x + y = 1 it has one.
  const std::vector<double> saddle = {-1.0, 1.0, 1.0}, centre = {0.0, 0.0, 0.0};
  RowProblem unbounded(saddle, centre);
  const Answer down = solve_problem(unbounded, centre);
  REQUIRE_MESSAGE(down.status.ok(), down.status.text);
  CHECK(down.result.claim == Claim::diverged);
  CHECK(contains(down.result.reason, "the energy falls without a bound: from 0 to -"));
  CHECK(down.result.q[0] > 100.0);  // the sign is fixed
  CHECK(down.result.iterations < 30);

  const Answer stays = solve_problem(unbounded, centre, {false});
  CHECK(stays.result.claim == Claim::optimal);
  CHECK(contains(stays.result.reason, "at a saddle: 1 direction of negative curvature, the leftmost -3 N/mm"));
  CHECK(stays.result.q == centre);

  RowProblem held(saddle, centre, {{{2.0, 1.0, 0.0}, 1.0, 1.0}});
  const Answer on_row = solve_problem(held, {1.0, 1.0, 1.0});
  CHECK_MESSAGE(on_row.result.claim == Claim::optimal, on_row.result.reason);
  CHECK(contains(on_row.result.reason, "the curvature is positive"));
  check_point(on_row.result.q, {2.0 / 3.0, -1.0 / 3.0, 0.0}, 1e-8);
}

TEST_CASE("an exactly straight column is a saddle, and says so") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    CAPTURE(std::string(kinematics));
    const std::vector<Override> straight = {
        {"wire.rod.kinematics", kinematics}, {"wire.rod.geometry.amplitude", "0.0"}, {"wire.rod.geometry.nodes", "41"}};
    std::vector<Override> stopped = straight;
    stopped.push_back({"solver.leave-saddles", "false"});
    SolvedScene stays = solved_file("column.toml", stopped);
    CHECK(stays.solution.solver.iterations == 0);
    CHECK(contains(stays.solution.solver.reason, "at a saddle: 1 direction of negative curvature, the leftmost -0.0"));

    // Beyond the second Euler load there are two.
    stopped.push_back({"energy.point-load.force", "[-4.5, 0.0]"});
    CHECK(contains(solved_file("column.toml", stopped).solution.solver.reason, "at a saddle: 2 directions"));
    // Below the first it is a minimum.
    stopped.back().value = "[-0.98, 0.0]";
    CHECK(contains(solved_file("column.toml", stopped).solution.solver.reason, "the curvature is positive"));

    SolvedScene leaves = solved_file("column.toml", straight);
    CHECK(leaves.solution.solver.claim == Claim::optimal);
    CHECK(contains(leaves.solution.solver.reason, "the curvature is positive"));
    CHECK(energy_of(leaves) < energy_of(stays) - 1.0);
    // The same bits again.
    CHECK(solved_file("column.toml", straight).solution.q == leaves.solution.q);
  }
}

TEST_CASE("mirrored imperfections reach mirrored minima") {
  for (const char* scene : {"column.toml", "shortened-rod.toml"}) {
    std::vector<Override> overrides = {{"wire.rod.kinematics", "nodes"}, {"wire.rod.geometry.amplitude", "0.0001"}};
    SolvedScene one = solved_file(scene, overrides);
    overrides[1].value = "-0.0001";
    SolvedScene other = solved_file(scene, overrides);
    const double energy = energy_of(one);
    REQUIRE(std::fabs(energy) > 1.0);
    CHECK(std::fabs(energy_of(other) - energy) <= 1e-9 * std::fabs(energy));
    const std::vector<double> p = points(one), mirrored = points(other);
    REQUIRE(p.size() == 2 * 81);
    double sag = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < p.size(); i += 2) {
      sag = std::max(sag, std::fabs(p[i + 1]));
      difference = std::max({difference, std::fabs(p[i] - mirrored[i]), std::fabs(p[i + 1] + mirrored[i + 1])});
    }
    CHECK(sag > 29.0);
    CHECK(difference <= 1e-5);
  }
}

TEST_CASE("ends that no straight state allows: the singular rows are named") {
  const SolvedScene scene =
      solved_file("shortened-rod.toml", {{"wire.rod.geometry.amplitude", "0.0"}, {"wire.rod.geometry.nodes", "41"}});
  CHECK(scene.solution.solver.claim == Claim::infeasible);
  const std::string& reason = scene.solution.solver.reason;
  CHECK_MESSAGE(contains(reason, "to first order no step brings them closer, as their Jacobian is singular here"),
                reason);
  CHECK_MESSAGE(contains(reason, "40 of 80 rows of 'rod.closure' fail, row 0 the most, by 0.6475 mm (edge 0)"), reason);

  // Farther apart than the rod is long.
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    const SolvedScene torn = solved_file(
        "shortened-rod.toml", {{"wire.rod.kinematics", kinematics},
                               {"wire.rod.geometry.nodes", "21"},
                               {"wire.rod.ends", R"(["pinned", { type = "pinned", move = ["5 mm", "0 mm"] }])"}});
    CHECK_MESSAGE(torn.solution.solver.claim == Claim::infeasible, torn.solution.solver.reason);
    CHECK_MESSAGE(contains(torn.solution.solver.reason, "rows of 'rod.closure' fail"), torn.solution.solver.reason);
  }
}

TEST_CASE("a wire and a vessel without contact: Ipopt's energy, with lengths that have bounds") {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"edge-frames", "nodes"}) {
      CAPTURE(dimension);
      CAPTURE(std::string(kinematics));
      SmallScene scene = contact_scene(dimension, kinematics, kinematics);
      scene.contact = "";
      const std::string force = dimension == 2 ? R"(["0.2 N", "0.5 N"])" : R"(["0.2 N", "0.5 N", "-0.4 N"])";
      const std::string load =
          "[[energy]]\ntype = \"point-load\"\non = \"vessel\"\nat = \"25 mm\"\nforce = " + force + "\n";
      const std::string text = edited(contact_text(scene, "tolerance = 1e-9"), "[solver]", load + "[solver]");
      SolvedScene ipopt = solved(session_of_text(text));
      SolvedScene own = solved(session_of_text(edited(text, "type = \"ipopt\"", "type = \"trust-region\"")));
      REQUIRE(own.assembly().summary().bounded_unknowns);
      CHECK(own.solution.solver.claim == Claim::optimal);
      CHECK(own.solution.solver.iterations <= 12);
      const double energy = energy_of(ipopt);
      REQUIRE(std::fabs(energy) > 0.1);
      CHECK(std::fabs(energy_of(own) - energy) <= 1e-8 * std::fabs(energy));
    }
  }
}

TEST_CASE("bilateral rows that find closest points, and their epochs") {
  SmallScene scene = contact_scene(2);
  scene.contact_type = "concentric";
  const std::string text = contact_text(scene, "tolerance = 1e-9");
  SolvedScene ipopt = solved(session_of_text(text));
  SolvedScene own = solved(session_of_text(edited(text, "type = \"ipopt\"", "type = \"trust-region\"")));
  CHECK(own.solution.solver.claim == Claim::optimal);
  const double energy = energy_of(ipopt);
  REQUIRE(std::fabs(energy) > 0.1);
  CHECK(std::fabs(energy_of(own) - energy) <= 1e-8 * std::fabs(energy));
}

TEST_CASE("a wire that is pushed grows without a bound, and is said to") {
  SmallScene scene = contact_scene(2);
  scene.contact = "";
  std::string text = edited(contact_text(scene, ""), "tension = \"3 N\"", "tension = \"-2 N\"");
  const SolvedScene own = solved(session_of_text(edited(text, "type = \"ipopt\"", "type = \"trust-region\"")));
  CHECK(own.solution.solver.claim == Claim::diverged);
  CHECK_MESSAGE(contains(own.solution.solver.reason, "the length of a sliding wire"), own.solution.solver.reason);
}

TEST_CASE("a bend of 45 degrees under a tip force out of its plane, of second order") {
  // K.-J. Bathe and S. Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961, inextensible.
  struct Load {
    const char* force;
    double tip[3];
  };
  for (const Load& load : {Load{"300", {58.77969, 22.24504, 40.18828}}, Load{"450", {52.23930, 18.50846, 48.49798}},
                           Load{"600", {47.15129, 15.68508, 53.46860}}}) {
    CAPTURE(std::string(load.force));
    double before = 0.0;
    for (const char* nodes : {"21", "41", "81", "161"}) {
      SolvedScene scene = solved(
          session_of_text(edited(edited(bend_45, "FORCE", load.force), "nodes = 41", std::string("nodes = ") + nodes)));
      CHECK(scene.solution.solver.claim == Claim::optimal);
      CHECK(scene.solution.solver.iterations <= 12);
      double off = 0.0;
      const std::vector<double> all = points(scene);
      for (std::size_t k = 0; k < 3; ++k) off = std::max(off, std::fabs(all[all.size() - 3 + k] - load.tip[k]));
      if (before > 0.0) {
        const double order = std::log2(before / off);
        CHECK(order > 1.8);
        CHECK(order < 2.2);
      }
      before = off;
    }
    CHECK(before < 1e-3);
  }
}

}  // namespace bowstring::testing
