#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/enforcement/enforcement_case.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

OwnedEnforcement augmented(long most_solves = 50, double first_weight = 100.0,
                           const std::vector<std::string>& on = {}) {
  return enforcement_plugin("augmented-lagrangian", [&](const SetParameter& value) {
    value("first-weight", ParameterType::scalar).number = first_weight;
    value("max-outer-iterations", ParameterType::integer).integer = most_solves;
    if (!on.empty()) value("on", ParameterType::names).names = on;
  });
}

/// ½ (x − 3)² + ½ (y − 1)² + (z + 2)² with x ≤ 1, −1 ≤ z ≤ 5, |y| ≤ 9 without effect, and x + y + z = −0.5.
RowProblem held(bool with_equality = false) {
  std::vector<QuadraticRow> rows = {
      {{1.0, 0.0, 0.0}, -infinity, 1.0}, {{0.0, 0.0, 1.0}, -1.0, 5.0}, {{0.0, 1.0, 0.0}, -9.0, 9.0}};
  if (with_equality) rows.push_back({{1.0, 1.0, 1.0}, -0.5, -0.5});
  return RowProblem(stiffness, rest, rows);
}

}  // namespace

TEST_CASE("an augmented Lagrangian ends on its rows, with the multipliers that belong to them, by every solver") {
  for (const char* name : {"interior-point", "active-set", "trust-region", "ipopt", "nlopt"}) {
    CAPTURE(std::string(name));
    Status status;
    if (plugin_host().find(Kind::solver, name, status) == nullptr) continue;
    for (const bool with_equality : {false, true}) {
      CAPTURE(with_equality);
      RowProblem problem = held(with_equality);
      int calls = 0;
      const Answer answer =
          solve_around(*augmented(), *plain_solver(name), problem, {0.0, 0.0, 0.0}, [&](const IterationRecord& r) {
            CHECK(r.iteration == calls++);
            return true;
          });
      const SolverResult& result = answer.result;
      CHECK_MESSAGE(result.claim == Claim::optimal, result.reason);
      const double y = with_equality ? -0.5 : 1.0, equality = with_equality ? 1.5 : 0.0;
      check_point(result.q, {1.0, y, -1.0}, 2e-8);
      REQUIRE(result.multipliers.size() == (with_equality ? 4u : 3u));
      CHECK(result.multipliers[0] == doctest::Approx(2.0 - equality).epsilon(1e-6));
      CHECK(result.multipliers[1] == doctest::Approx(-2.0 - equality).epsilon(1e-6));
      CHECK(result.multipliers[2] == 0.0);
      if (with_equality) CHECK(result.multipliers[3] == doctest::Approx(equality).epsilon(1e-6));
      CHECK(static_cast<int>(result.history.size()) == result.iterations + 1);
      CHECK(calls == result.iterations + 1);
      CHECK(result.enforcement.outer_iterations > 1);
      CHECK(result.enforcement.outer_iterations < 12);
      CHECK(result.enforcement.penetration.value() <= 1e-8);
      CHECK(contains(result.reason, " of the augmented Lagrangian: weight "));
    }
  }
}

TEST_CASE("the result does not depend on the first weight, and multipliers to start from save solves") {
  for (const double weight : {1e-2, 1.0, 1e2, 1e5}) {
    CAPTURE(weight);
    RowProblem problem = held(true);
    const Answer answer = solve_around(*augmented(50, weight), *plain_solver("active-set"), problem, {0.0, 0.0, 0.0});
    CHECK_MESSAGE(answer.result.claim == Claim::optimal, answer.result.reason);
    check_point(answer.result.q, {1.0, -0.5, -1.0}, 1e-8);
    const Answer again = solve_around(*augmented(50, weight), *plain_solver("active-set"), problem, answer.result.q, {},
                                      answer.result.multipliers);
    CHECK(again.result.claim == Claim::optimal);
    CHECK(again.result.enforcement.outer_iterations <= 2);
    CHECK(again.result.enforcement.outer_iterations < answer.result.enforcement.outer_iterations);
  }
}

TEST_CASE("equality rows may be taken, too") {
  RowProblem problem = held(true);
  const Answer answer =
      solve_around(*augmented(50, 100.0, {"rows"}), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK_MESSAGE(answer.result.claim == Claim::failed, answer.result.reason);
  CHECK(contains(answer.result.reason, "lacks a pair of unknowns that row 3 reads"));
  RowProblem apart(stiffness, rest, {{{1.0, 0.0, 0.0}, 2.0, 2.0}, {{0.0, 1.0, 0.0}, -infinity, 0.5}});
  const Answer held_apart =
      solve_around(*augmented(50, 100.0, {"rows"}), *plain_solver("trust-region"), apart, {0.0, 0.0, 0.0});
  CHECK(held_apart.result.claim == Claim::optimal);
  check_point(held_apart.result.q, {2.0, 0.5, -2.0}, 1e-8);
  CHECK(held_apart.result.multipliers[0] == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("limits, and the user's stop") {
  RowProblem problem = held();
  Answer answer = solve_around(*augmented(2, 1.0), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK(answer.result.claim == Claim::stalled);
  CHECK(contains(answer.result.reason, "the limit of outer iterations was reached, in solve 2"));
  CHECK(answer.result.enforcement.outer_iterations == 2);
  answer = solve_around(*augmented(), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0},
                        [](const IterationRecord& record) { return record.iteration < 3; });
  CHECK(answer.result.claim == Claim::stalled);
  CHECK(contains(answer.result.reason, "stopped by the user"));
  CHECK(answer.result.iterations == 3);
}

}  // namespace bowstring::testing
