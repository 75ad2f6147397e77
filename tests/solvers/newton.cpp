#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "solvers/newton/active_set_method.hpp"
#include "solvers/newton/barrier_method.hpp"
#include "solvers/newton/diagnosis.hpp"
#include "solvers/newton/filter.hpp"
#include "solvers/newton/hand_over.hpp"
#include "solvers/newton/inertia_correction.hpp"
#include "solvers/newton/restoration.hpp"
#include "solvers/newton/sides.hpp"
#include "tests/solvers/solver_case.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const std::vector<double> origin = {0.0, 0.0, 0.0};

struct Run {
  SolverResult result;
  newton::Ending ending;
  std::vector<double> q, multipliers;
};

enum class Method { barrier, active_set, both };
constexpr Method methods[] = {Method::barrier, Method::active_set, Method::both};
constexpr double hand_overs[] = {1e-3, 1e-6};

Run solve(RowProblem& problem, const std::vector<double>& start, Method method, newton::Limits limits = {},
          std::vector<double> multipliers = {}, const std::function<bool(const IterationRecord&)>& progress = {}) {
  Run run;
  SolverContext context;
  context.on_iteration = progress;
  newton::Point point(problem, run.result);
  point.q = start;
  newton::Progress record(limits, context, run.result);
  if (method == Method::barrier) {
    newton::BarrierMethod barrier(point, record, {});
    run.ending = barrier.run(multipliers);
  } else if (method == Method::active_set) {
    bool new_epoch = false;
    REQUIRE(point.accept(new_epoch).ok());
    REQUIRE(point.expand().ok());
    newton::ActiveSetMethod active(point, record, false);
    run.ending = active.run(multipliers);
  } else {
    run.ending = newton::solve_by_hand_over(point, record, {hand_overs, std::size(hand_overs)}, multipliers);
  }
  run.q = point.q;
  run.multipliers = multipliers;
  return run;
}

void check_optimal(const Run& run, const std::vector<double>& q, const std::vector<double>& multipliers,
                   double tolerance = 2e-8) {
  CHECK_MESSAGE(run.ending.claim == Claim::optimal, run.ending.reason);
  REQUIRE(largest(q) > 0.5);
  CHECK(largest_difference(run.q, q) <= tolerance);
  CHECK(largest_difference(run.multipliers, multipliers) <= tolerance);
}

Status far_fails(const RowProblem&, const std::vector<double>& q) {
  return q[0] > 0.5 ? Status::failure(Code::failed, "energy 'test' is not a number at element 4") : Status{};
}

}  // namespace

TEST_CASE("filter: what is dominated is refused, what improves in one way is taken, and it forgets") {
  newton::Filter filter;
  filter.reset(10.0);
  CHECK(filter.accepts(9.0, 1e9));
  CHECK_FALSE(filter.accepts(11.0, -1e9));
  CHECK_FALSE(filter.accepts(1.0, std::nan("")));
  CHECK_FALSE(filter.accepts(std::nan(""), 0.0));
  filter.add(1.0, 5.0);
  CHECK(filter.accepts(0.9, 7.0));
  CHECK(filter.accepts(2.0, 4.0));
  CHECK_FALSE(filter.accepts(1.0, 5.0));
  CHECK_FALSE(filter.accepts(1.5, 5.5));
  filter.add(0.5, 3.0);  // dominates the first one
  CHECK_FALSE(filter.accepts(0.9, 4.0));
  CHECK(filter.accepts(0.4, 1e3));
  CHECK(newton::Filter::improves(0.9, 9.0, 1.0, 5.0));
  CHECK(newton::Filter::improves(1.0, 4.0, 1.0, 5.0));
  CHECK_FALSE(newton::Filter::improves(1.0, 5.0, 1.0, 5.0));
  filter.reset(10.0);
  CHECK(filter.accepts(1.0, 5.0));
}

TEST_CASE("sides: one for each finite bound of an inequality row or unknown, none for an equality") {
  RowProblem problem(stiffness, rest,
                     {{{1.0, 0.0, 0.0}, -1.0, 2.0}, {{0.0, 1.0, 0.0}, 3.0, 3.0}, {{0.0, 0.0, 1.0}, -infinity, 4.0}});
  problem.lower_bounds[2] = -7.0;
  const std::vector<newton::Side> rows = newton::sides_of_rows(problem), bounds = newton::sides_of_unknowns(problem);
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].violation(2.5) == 0.5);
  CHECK(rows[1].violation(2.5) == -3.5);
  CHECK(rows[1].sign == -1.0);
  CHECK(rows[2].index == 2);
  REQUIRE(bounds.size() == 1);
  CHECK(bounds[0].violation(-8.0) == 1.0);
  CHECK(newton::equality_rows(problem) == std::vector<int>{1});
}

TEST_CASE("inertia correction: no shift where none is needed, otherwise one that leaves no direction negative") {
  SolverResult count;
  for (const double curvature : {2.0, -3.0, -3e4}) {
    CAPTURE(curvature);
    RowProblem problem({curvature, 1.0}, {0.0, 0.0}, {{{0.0, 1.0}, 0.0, 0.0}});
    newton::Point point(problem, count);
    point.q = {0.3, 0.0};
    REQUIRE(point.expand().ok());
    REQUIRE(point.find_hessian(std::vector<double>{0.0}).ok());
    kkt::KktSystem::Values values;
    values.hessian = point.hessian;
    values.jacobian = point.jacobian;
    const std::vector<double> softness(1, infinity);
    values.softness = softness;
    newton::InertiaCorrection inertia;
    REQUIRE(inertia.factor(point.system(), values, 0.0, count));
    CHECK((inertia.shift() > 0.0) == (curvature < 0.0));
    CHECK(inertia.shift() >= std::min(0.0, -curvature));
    if (curvature < 0.0) CHECK(inertia.shift() > -curvature);
    const double before = inertia.shift();
    REQUIRE(inertia.factor(point.system(), values, 0.0, count));
    CHECK(inertia.shift() <= before);
  }
}

TEST_CASE("no rows at all, equality rows alone, and rows that are open") {
  for (const Method method : methods) {
    CAPTURE(static_cast<int>(method));
    RowProblem free(stiffness, rest);
    check_optimal(solve(free, origin, method), rest, {});
    // x + y + z = 8: 6 = λ (1 + 1 + ½) with the sign of −λ.
    RowProblem held(stiffness, rest, {{{1.0, 1.0, 1.0}, 8.0, 8.0}});
    check_optimal(solve(held, origin, method), {5.4, 3.4, -0.8}, {-2.4});
    RowProblem open(stiffness, rest, {{{1.0, 0.0, 0.0}, -infinity, 9.0}});
    check_optimal(solve(open, origin, method), rest, {0.0});
  }
}

TEST_CASE("rows: one side or the other of two, a curved one, and their forces") {
  for (const Method method : methods) {
    CAPTURE(static_cast<int>(method));
    for (const double sign : {1.0, -1.0}) {
      RowProblem both(stiffness, {sign * 3.0, 1.0, -2.0}, {{{1.0, 0.0, 0.0}, -1.0, 1.0}});
      const std::vector<double> guess =
          method == Method::active_set ? std::vector<double>{sign} : std::vector<double>();
      check_optimal(solve(both, origin, method, {}, guess), {sign, 1.0, -2.0}, {2.0 * sign});
    }
    // |x|² ≤ 1 about a rest at distance √14: x = rest/√14, λ = (√14 − 1)/2.
    RowProblem ball({1.0, 1.0, 1.0}, rest, {{{0.0, 0.0, 0.0}, -infinity, 1.0, 1.0}});
    const double distance = std::sqrt(14.0);
    const std::vector<double> start = method == Method::active_set ? std::vector<double>{0.7, 0.2, -0.6} : origin;
    const std::vector<double> guess = method == Method::active_set ? std::vector<double>{1.0} : std::vector<double>();
    check_optimal(solve(ball, start, method, {}, guess), {3.0 / distance, 1.0 / distance, -2.0 / distance},
                  {0.5 * (distance - 1.0)});
  }
}

TEST_CASE("rows that say the same twice share a force") {
  for (const Method method : methods) {
    CAPTURE(static_cast<int>(method));
    RowProblem twice(stiffness, rest, {{{1.0, 0.0, 0.0}, -infinity, 1.0}, {{1.0, 0.0, 0.0}, -infinity, 1.0}});
    const std::vector<double> guess =
        method == Method::active_set ? std::vector<double>{0.5, 0.5} : std::vector<double>();
    const Run run = solve(twice, origin, method, {}, guess);
    CHECK_MESSAGE(run.ending.claim == Claim::optimal, run.ending.reason);
    CHECK(largest_difference(run.q, {1.0, 1.0, -2.0}) <= 2e-8);
    CHECK(run.multipliers[0] + run.multipliers[1] == doctest::Approx(2.0).epsilon(1e-7));
    CHECK(std::min(run.multipliers[0], run.multipliers[1]) >= 0.0);
  }
}

TEST_CASE("a row that touches and carries nothing") {
  for (const Method method : {Method::barrier, Method::both}) {
    RowProblem weak(stiffness, rest, {{{1.0, 0.0, 0.0}, -infinity, 3.0}});
    const Run run = solve(weak, origin, method);
    CHECK_MESSAGE(run.ending.claim == Claim::optimal, run.ending.reason);
    // Distance and force have the tolerance of their product.
    CHECK(largest_difference(run.q, rest) <= 1e-4);
    CHECK(std::fabs(run.multipliers[0]) <= 1e-4);
  }
}

TEST_CASE("negative curvature goes to a wall, and never stops on the ridge beside it") {
  for (const Method method : {Method::barrier, Method::both}) {
    for (const double start : {0.3, -0.3}) {
      RowProblem ridge({-1.0, 1.0}, {0.0, 2.0}, {{{1.0, 0.0}, -1.0, 1.0}});
      const double wall = start > 0.0 ? 1.0 : -1.0;
      check_optimal(solve(ridge, {start, 0.0}, method), {wall, 2.0}, {wall});
    }
  }
}

TEST_CASE("bounds on unknowns are kept, those that hold included") {
  for (const Method method : {Method::barrier, Method::both}) {
    RowProblem bounded(stiffness, rest, {{{0.0, 1.0, 0.0}, -infinity, 0.5}});
    bounded.upper_bounds[0] = 2.0;
    bounded.lower_bounds[2] = -9.0;
    std::vector<double> largest_seen(1, -infinity);
    bounded.answer = [&](const RowProblem&, const std::vector<double>& q) {
      largest_seen[0] = std::max(largest_seen[0], q[0]);
      return Status{};
    };
    const Run run = solve(bounded, {5.0, 0.0, 0.0}, method);
    CHECK_MESSAGE(run.ending.claim == Claim::optimal, run.ending.reason);
    CHECK(largest_difference(run.q, {2.0, 0.5, -2.0}) <= 1e-6);
    CHECK(largest_seen[0] < 2.0);
  }
}

TEST_CASE("rows that cannot hold together are infeasible, and the worst is named") {
  for (const Method method : {Method::barrier, Method::both}) {
    CAPTURE(static_cast<int>(method));
    RowProblem walls(stiffness, rest, {{{1.0, 0.0, 0.0}, -infinity, -1.0}, {{1.0, 0.0, 0.0}, 1.0, infinity}});
    const Run run = solve(walls, origin, method);
    CHECK_MESSAGE(run.ending.claim == Claim::infeasible, run.ending.reason);
    CHECK(contains(run.ending.reason, "the rows cannot hold together: "));
    CHECK(contains(run.ending.reason, "2 of 2 rows of 'rows' fail, row "));
    CHECK(std::fabs(run.q[0]) <= 1e-3);  // the least that they fail by, in the sum of squares
    CHECK(newton::largest_violation(walls, std::vector<double>{run.q[0], run.q[0]}) ==
          doctest::Approx(1.0).epsilon(1e-3));

    RowProblem planes(stiffness, rest, {{{1.0, 1.0, 0.0}, 0.0, 0.0}, {{1.0, 1.0, 0.0}, 1.0, 1.0}});
    const Run contradiction = solve(planes, origin, method);
    CHECK_MESSAGE(contradiction.ending.claim == Claim::infeasible, contradiction.ending.reason);
    CHECK(contains(contradiction.ending.reason, "by 0.5 mm"));
  }
}

TEST_CASE("a restoration comes to its goal, with bounds kept, or says how near it came") {
  SolverResult count;
  const SolverContext context;
  RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 7.0, 7.0}, {{0.0, 0.0, 1.0}, 1.0, infinity}});
  problem.upper_bounds[0] = 3.5;
  newton::Point point(problem, count);
  point.q = origin;
  REQUIRE(point.expand().ok());
  newton::Progress progress({}, context, count);
  newton::Restoration restoration(point, progress);
  std::vector<double> multipliers;
  const newton::Ending ending = restoration.run(1e-3, multipliers);
  CHECK_MESSAGE(ending.claim == Claim::optimal, ending.reason);
  CHECK(std::fabs(point.q[0] + point.q[1] - 7.0) + std::max(0.0, 1.0 - point.q[2]) <= 1e-3);
  CHECK(point.q[0] < 3.5);
}

TEST_CASE("an energy without a lower bound diverges, whether or not a row is there") {
  for (const bool with_row : {false, true}) {
    std::vector<QuadraticRow> rows;
    if (with_row) rows.push_back({{0.0, 1.0}, -infinity, 1.0});
    RowProblem problem({-1.0, 1.0}, {0.0, 2.0}, rows);
    const Run run = solve(problem, {0.1, 0.0}, Method::both);
    CHECK_MESSAGE(run.ending.claim == Claim::diverged, run.ending.reason);
    CHECK(contains(run.ending.reason, "the energy falls without a bound: from "));
    CHECK(contains(run.ending.reason, "while the scene grew from 0.1 to "));
  }
}

TEST_CASE("trials that cannot be evaluated shorten the step; where every one is, the text says why") {
  // The minimum can be evaluated, and so can all that lies before it.
  RowProblem passable(stiffness, {0.4, 1.0, -2.0});
  passable.answer = far_fails;
  check_optimal(solve(passable, {-5.0, 0.0, 0.0}, Method::barrier), {0.4, 1.0, -2.0}, {});
  RowProblem blocked(stiffness, rest);
  blocked.answer = far_fails;
  const Run run = solve(blocked, {-5.0, 0.0, 0.0}, Method::both);
  CHECK(run.ending.claim == Claim::failed);
  CHECK(contains(run.ending.reason, "energy 'test' is not a number at element 4"));
  CHECK(run.q[0] <= 0.5);
  CHECK(run.q[0] > 0.4);
  const Run start = solve(blocked, {1.0, 0.0, 0.0}, Method::both);
  CHECK(start.ending.claim == Claim::failed);
  CHECK(contains(start.ending.reason, "the start cannot be evaluated: energy 'test' is not a number at element 4"));
}

TEST_CASE("limits and the user's stop end as stalled at the last point, from which a second solve goes on") {
  const std::vector<QuadraticRow> ball = {{{0.0, 0.0, 0.0}, -infinity, 1.0, 1.0}};
  RowProblem problem({1.0, 1.0, 1.0}, rest, ball);
  newton::Limits few;
  few.max_iterations = 4;
  const Run limited = solve(problem, origin, Method::both, few);
  CHECK(limited.ending.claim == Claim::stalled);
  CHECK(limited.ending.reason == "the iteration limit was reached");
  CHECK(limited.result.iterations == 4);
  CHECK(problem.reference == limited.q);
  CHECK(limited.multipliers.size() == 1);
  newton::Limits brief;
  brief.time_limit = 1e-9;
  CHECK(solve(problem, origin, Method::both, brief).ending.reason == "the time limit was reached");
  const auto stop = [](const IterationRecord& record) { return record.iteration < 2; };
  CHECK(solve(problem, origin, Method::both, {}, {}, stop).ending.reason == "stopped by the user");
  const Run resumed = solve(problem, limited.q, Method::both, {}, limited.multipliers);
  const double distance = std::sqrt(14.0);
  check_optimal(resumed, {3.0 / distance, 1.0 / distance, -2.0 / distance}, {0.5 * (distance - 1.0)});
}

TEST_CASE("the active set gives its start back where it goes astray, and settles in few steps near a solution") {
  RowProblem ridge({-1.0, 1.0}, {0.0, 2.0}, {{{1.0, 0.0}, -1.0, 1.0}});
  const Run astray = solve(ridge, {0.3, 0.25}, Method::active_set);
  CHECK(astray.ending.claim == Claim::stalled);
  CHECK(astray.q == std::vector<double>{0.3, 0.25});
  CHECK(ridge.reference == astray.q);
  RowProblem problem(stiffness, rest, {{{1.0, 0.0, 0.0}, -infinity, 1.0}, {{0.0, 1.0, 0.0}, -infinity, 0.9}});
  const Run near = solve(problem, {0.99, 0.9, -2.0}, Method::active_set, {}, {1.9, 0.0});
  check_optimal(near, {1.0, 0.9, -2.0}, {2.0, 0.1});
  CHECK(near.result.factorizations <= 5);
}

TEST_CASE("what rows fail by is told group by group") {
  const RowProblem problem(stiffness, rest, {{{1.0, 0.0, 0.0}, -1.0, 1.0}, {{0.0, 1.0, 0.0}, 0.0, 0.0}});
  CHECK(newton::failing_rows(problem, std::vector<double>{1.0, 0.0}, 1e-8).empty());
  CHECK(newton::failing_rows(problem, std::vector<double>{-3.5, 0.25}, 1e-8) ==
        "2 of 2 rows of 'rows' fail, row 0 the most, by 2.5 mm");
  CHECK(newton::row_name(problem, 1) == "row 1 of 'rows'");
  CHECK(newton::largest_violation(problem, std::vector<double>{-3.5, 0.25}) == 2.5);
}

TEST_CASE("a row may read any number of unknowns") {
  // ½ Σ (x − 1)² with Σ x ≤ n/2, whose multiplier is ½.
  constexpr std::size_t n = 150;
  for (const Method method : methods) {
    RowProblem problem(std::vector<double>(n, 1.0), std::vector<double>(n, 1.0),
                       {{std::vector<double>(n, 1.0), -infinity, 0.5 * n, 0.0}});
    const Run run = solve(problem, std::vector<double>(n, 0.0), method, {}, std::vector<double>(1, 1.0));
    CHECK(run.ending.claim == Claim::optimal);
    CHECK(largest_difference(run.q, std::vector<double>(n, 0.5)) <= 1e-7);
    REQUIRE(run.multipliers.size() == 1);
    CHECK(run.multipliers[0] == doctest::Approx(0.5).epsilon(1e-6));
  }
}

}  // namespace bowstring::testing
