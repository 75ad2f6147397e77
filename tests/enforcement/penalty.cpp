#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/enforcement/enforcement_case.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Keys {
  double weight = 100.0, first_weight = 100.0, smoothing_force = 0.01;
  const char* form = "quadratic";
  const char* bias = "estimated";
  std::vector<std::string> on = {};
};

OwnedEnforcement penalty(const Keys& keys) {
  return enforcement_plugin("penalty", [&](const SetParameter& value) {
    value("weight", ParameterType::scalar).number = keys.weight;
    value("first-weight", ParameterType::scalar).number = keys.first_weight;
    value("smoothing-force", ParameterType::scalar).number = keys.smoothing_force;
    value("form", ParameterType::choice).text = keys.form;
    value("bias", ParameterType::choice).text = keys.bias;
    if (!keys.on.empty()) value("on", ParameterType::names).names = keys.on;
  });
}

/// ½ (x − 3)² + ½ (y − 1)² + (z + 2)² with x ≤ 1, −1 ≤ z ≤ 5, and y without effect.
RowProblem held() {
  return RowProblem(stiffness, rest,
                    {{{1.0, 0.0, 0.0}, -infinity, 1.0}, {{0.0, 0.0, 1.0}, -1.0, 5.0}, {{0.0, 1.0, 0.0}, -9.0, 9.0}});
}

}  // namespace

TEST_CASE("a penalised quadratic: where it gives way to, by every solver, with multipliers and what they estimate") {
  const double w = 100.0;
  // (3 − x) = w (x − 1), −2 (z + 2) = −w (−1 − z)
  const double x = (3.0 + w) / (1.0 + w), z = (-4.0 - w) / (2.0 + w);
  for (const char* name : {"interior-point", "active-set", "trust-region", "ipopt", "nlopt"}) {
    CAPTURE(std::string(name));
    Status status;
    if (plugin_host().find(Kind::solver, name, status) == nullptr) continue;
    RowProblem problem = held();
    const OwnedSolver solver = plain_solver(name);
    const OwnedEnforcement enforcement = penalty({w});
    ProblemSummary left;
    REQUIRE(enforcement->remaining(problem.summary(), left).ok());
    CHECK(left.inequalities == 0);
    int calls = 0;
    const Answer answer = solve_around(*enforcement, *solver, problem, {0.0, 0.0, 0.0}, [&](const IterationRecord& r) {
      CHECK(r.iteration == calls++);
      return true;
    });
    const SolverResult& result = answer.result;
    check_point(result.q, {x, 1.0, z}, 1e-6);
    REQUIRE(result.multipliers.size() == 3);
    CHECK(result.multipliers[0] == doctest::Approx(3.0 - x).epsilon(1e-5));
    CHECK(result.multipliers[1] == doctest::Approx(-2.0 * (z + 2.0)).epsilon(1e-5));
    CHECK(result.multipliers[2] == 0.0);
    CHECK(static_cast<int>(result.history.size()) == result.iterations + 1);
    CHECK(calls == result.iterations + 1);
    CHECK(result.history.back().penetration == doctest::Approx(x - 1.0).epsilon(1e-4));
    const EnforcementReport& report = result.enforcement;
    CHECK(report.outer_iterations == 1);
    CHECK(report.weight.value() == w);
    CHECK(report.penetration.value() == doctest::Approx(x - 1.0).epsilon(1e-4));
    // What exact rows add: to first order the multipliers' work, and a little more, as the energy is convex.
    const auto energy = [](double a, double b) { return 0.5 * (a - 3.0) * (a - 3.0) + (b + 2.0) * (b + 2.0); };
    const double gap = energy(1.0, -1.0) - energy(x, z);
    CHECK(report.energy.value() == doctest::Approx((3.0 - x) * (x - 1.0) + 2.0 * (z + 2.0) * (-1.0 - z)).epsilon(1e-4));
    CHECK(report.energy.value() < gap);
    CHECK(report.energy.value() > (1.0 - 2.0 / w) * gap);
    CHECK_FALSE(report.measured_energy.has_value());
  }
}

TEST_CASE("the bias is measured where the solver takes exact rows, and the result stays the penalty's") {
  RowProblem problem = held();
  const double w = 1e4, x = (3.0 + w) / (1.0 + w), z = (-4.0 - w) / (2.0 + w);
  Keys keys{w};
  keys.bias = "measured";
  Answer answer = solve_around(*penalty(keys), *plain_solver("active-set"), problem, {0.0, 0.0, 0.0});
  check_point(answer.result.q, {x, 1.0, z}, 1e-9);
  REQUIRE(answer.result.enforcement.measured_energy.has_value());
  CHECK(answer.result.enforcement.measured_energy.value() ==
        doctest::Approx(answer.result.enforcement.energy.value()).epsilon(1e-3));
  CHECK(answer.result.enforcement.measured_energy.value() > 1e-4);
  CHECK_FALSE(answer.result.enforcement.measured_motion.has_value());  // this problem has no nodes
  CHECK(problem.reference == answer.result.q);

  answer = solve_around(*penalty(keys), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK(answer.result.claim == Claim::optimal);
  CHECK_FALSE(answer.result.enforcement.measured_energy.has_value());
  CHECK(contains(answer.result.reason, "(not measured: with exact rows the solver refuses the problem: trust-region"));
}

TEST_CASE("the smooth form presses with its force where the parabola begins, and less inside") {
  RowProblem problem = held();
  Keys keys{1e3};
  keys.form = "log-quadratic";
  const Answer answer = solve_around(*penalty(keys), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK(answer.result.claim == Claim::optimal);
  // (3 − x) = f + w (x − 1 + f/w)
  const double f = 0.01, w = 1e3, x = (3.0 - 2.0 * f + w) / (1.0 + w);
  CHECK(answer.result.q[0] == doctest::Approx(x).epsilon(1e-7));
  CHECK(std::fabs(answer.result.multipliers[2]) > 0.0);
  CHECK(std::fabs(answer.result.multipliers[2]) < 1e-6);
}

TEST_CASE("weights rise to the one asked for, and counts are those of all solves") {
  RowProblem problem = held();
  Keys keys{1e6};
  const Answer answer = solve_around(*penalty(keys), *plain_solver("interior-point"), problem, {0.0, 0.0, 0.0});
  CHECK(answer.result.claim == Claim::optimal);
  CHECK(answer.result.enforcement.outer_iterations == 5);
  CHECK(answer.result.enforcement.weight.value() == 1e6);
  for (std::size_t k = 0; k < answer.result.history.size(); ++k) {
    CHECK(answer.result.history[k].iteration == static_cast<int>(k));
  }
  CHECK(answer.result.factorizations >= 5);
  CHECK(answer.result.evaluations > answer.result.iterations);
  // With multipliers the start is near a solution, and one solve is enough.
  const Answer again = solve_around(*penalty(keys), *plain_solver("interior-point"), problem, answer.result.q, {},
                                    answer.result.multipliers);
  CHECK(again.result.enforcement.outer_iterations == 1);
  check_point(again.result.q, answer.result.q, 1e-9);
}

TEST_CASE("equality rows that are named give way too; others stay exact") {
  RowProblem problem(stiffness, rest, {{{1.0, 0.0, 0.0}, 2.0, 2.0}, {{0.0, 1.0, 0.0}, -infinity, 0.5}});
  Keys keys{100.0};
  const Answer by_default = solve_around(*penalty(keys), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK(by_default.result.q[0] == doctest::Approx(2.0).epsilon(1e-10));
  CHECK(by_default.result.multipliers[0] == doctest::Approx(1.0));
  CHECK(by_default.result.q[1] == doctest::Approx(51.0 / 101.0));
  keys.on = {"rows"};
  const Answer named = solve_around(*penalty(keys), *plain_solver("trust-region"), problem, {0.0, 0.0, 0.0});
  CHECK(named.result.q[0] == doctest::Approx(203.0 / 101.0));
  CHECK(named.result.multipliers[0] == doctest::Approx(100.0 * (203.0 / 101.0 - 2.0)));
  CHECK(named.result.q[1] == doctest::Approx(51.0 / 101.0));
}

TEST_CASE("stops, failures and refusals of the inner solve are the answer") {
  RowProblem problem = held();
  const OwnedSolver solver = plain_solver("trust-region");
  Keys keys{1e6};
  Answer answer = solve_around(*penalty(keys), *solver, problem, {0.0, 0.0, 0.0},
                               [](const IterationRecord& record) { return record.iteration < 2; });
  CHECK(answer.result.claim == Claim::stalled);
  CHECK(contains(answer.result.reason, "stopped by the user, with the penalty's weight at 100 of 1e+06 N/mm"));
  CHECK(answer.result.iterations == 2);

  problem.answer = [](const RowProblem&, const std::vector<double>& q) {
    return q[0] > 0.5 ? Status::failure(Code::interrupted, "somebody pulled the plug") : Status{};
  };
  SolverResult result;
  const Status status = penalty(keys)->solve(problem, *solver, std::vector<double>{0.0, 0.0, 0.0}, {}, result);
  CHECK(status.code == Code::interrupted);
  CHECK(status.text == "somebody pulled the plug");
}

}  // namespace bowstring::testing
