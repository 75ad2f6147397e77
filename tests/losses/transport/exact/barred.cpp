#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "core/transport/check_measure.hpp"
#include "core/transport/one_sided.hpp"
#include "problems.hpp"

using namespace exact_test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("entries up to 1e32 do not drown the others: the matrix of POT issue 229") {
  const std::vector<double> weight{0.125, 0.125, 0.125, 0.125, 0.5};
  const MatrixProblem problem{
      weight, weight, {250.275352, 374.653218, 2413.52736,  1e32,       1.51751540e-3, 213.082030, 328.812836,
                       2294.87946, 1e32,       0.137109800, 197.333083, 309.175848,    2242.50550, 1e32,
                       2.46506283, 1e32,       1e32,        1e32,       5.26223432,    2.5e31,     38.4690152,
                       80.9465684, 333.064175, 2.5e31,      0.0}};
  for (const std::string& method : exact_methods()) {
    CAPTURE(method);
    const TransportAnswer answer = solve_cold(method, problem);
    CHECK(answer.value == doctest::Approx(57.543210).epsilon(1e-8));
    CHECK(answer.certificate.cost_scale == doctest::Approx(2413.52736));
    check_proof(problem, answer);
  }
}

TEST_CASE("huge entries that a plan needs are used, and as few as can be") {
  for (const std::string& method : exact_methods()) {
    const MatrixProblem problem{{0.5, 0.5}, {0.25, 0.75}, {1.0, 1e20, 2.0, 3e20}};
    const TransportAnswer answer = solve_cold(method, problem);
    CHECK(answer.value == doctest::Approx(0.25 * 3e20 + 0.5 * 1e20).epsilon(1e-12));
    check_proof(problem, answer);
  }
}

TEST_CASE("huge entries among many, where they can be gone around") {
  std::mt19937 random(8);
  for (const std::string& method : exact_methods()) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      const int count = 2 + below(random, 12);
      std::vector<double> weight = uniform_weights(static_cast<std::size_t>(count));
      for (std::size_t k = 1; repeat % 2 == 1 && k < weight.size(); k += 2) weight[k] = 0.0;
      MatrixProblem plain{weight, weight, squared_distances(random_cloud(random, count), random_cloud(random, count))};
      MatrixProblem huge = plain, forbidden = plain;
      for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
          const auto place = static_cast<std::size_t>(i * count + j);
          if (i == j || below(random, 3) > 0) continue;
          plain.cost[place] = 1e5;
          huge.cost[place] = 1e25 * (1 + below(random, 3));
          forbidden.cost[place] = infinity;
        }
      }
      const TransportAnswer expected = solve_cold(method, plain);
      for (const MatrixProblem* problem : {&huge, &forbidden}) {
        const TransportAnswer answer = solve_cold(method, *problem);
        CHECK(answer.value == doctest::Approx(expected.value).epsilon(1e-12));
        check_proof(*problem, answer);
      }
    }
  }
}

TEST_CASE("a plan that has to cross forbidden pairs is refused, with how much mass") {
  for (const std::string& method : exact_methods()) {
    TransportComparison comparison = open_comparison(method);
    TransportAnswer answer;
    const Status status = solve_into(comparison, {{0.5, 0.5}, {0.25, 0.75}, {1.0, infinity, 1.0, 2.0}}, answer);
    CHECK(status.code == Code::invalid_input);
    CHECK(status.text.find("of the mass 1 at least 0.25 would have to cross forbidden pairs") != std::string::npos);
    CHECK(status.text.find("row 0 to column 1") != std::string::npos);
    const Status none = solve_into(comparison, {{1.0}, {1.0}, {infinity}}, answer);
    CHECK(none.code == Code::invalid_input);
    REQUIRE(solve_into(comparison, {{1.0}, {1.0}, {3.0}}, answer).ok());
    CHECK(answer.value == 3.0);
  }
}

TEST_CASE("refused are the problems whose plans cannot do without forbidden pairs, and no others") {
  std::mt19937 random(16);
  int refused = 0, solved = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const int rows = 1 + below(random, 7), columns = 1 + below(random, 7);
    MatrixProblem problem{
        uniform_weights(static_cast<std::size_t>(rows)), uniform_weights(static_cast<std::size_t>(columns)), {}};
    MatrixProblem crossings = problem;  // its value is the least mass on forbidden pairs
    for (int k = 0; k < rows * columns; ++k) {
      const bool forbid = below(random, 2) == 0;
      problem.cost.push_back(forbid ? infinity : uniform(random));
      crossings.cost.push_back(forbid ? 1.0 : 0.0);
    }
    for (const std::string& method : exact_methods()) {
      const double least = solve_cold(method, crossings).value;
      TransportComparison comparison = open_comparison(method);
      TransportAnswer answer;
      const Status status = solve_into(comparison, problem, answer);
      CHECK(status.ok() == (least < 1e-12));
      (status.ok() ? solved : refused) += 1;
      if (status.ok()) {
        check_proof(problem, answer);
      } else {
        char text[64];
        std::snprintf(text, sizeof text, "at least %.6g would", least);
        CHECK(status.text.find(text) != std::string::npos);
      }
    }
  }
  CHECK(refused > 50);
  CHECK(solved > 50);
}

TEST_CASE("what rounding of weights leaves over crosses no forbidden pair") {
  // Blocks whose sums agree only up to rounding: 0.1 + 0.2 is not 0.3.
  for (const std::string& method : exact_methods()) {
    const MatrixProblem problem{{0.1, 0.2, 0.7}, {0.3, 0.7}, {1.0, infinity, 2.0, infinity, infinity, 3.0}};
    const TransportAnswer answer = solve_cold(method, problem);
    CHECK(answer.value == doctest::Approx(0.1 + 0.4 + 2.1).epsilon(1e-14));
    CHECK(answer.plan.value.size() == 3);
  }
}

TEST_CASE("negative costs and a constant added to them") {
  std::mt19937 random(9);
  for (const std::string& method : exact_methods()) {
    MatrixProblem problem{random_weights(random, 15), random_weights(random, 11),
                          squared_distances(random_cloud(random, 15), random_cloud(random, 11))};
    const double value = solve_cold(method, problem).value;
    for (double& cost : problem.cost) cost -= 500.0;
    const TransportAnswer answer = solve_cold(method, problem);
    CHECK(answer.value == doctest::Approx(value - 500.0).epsilon(1e-12));
    check_proof(problem, answer);
  }
}

TEST_CASE("a square against itself turned by 45 degrees: both derivatives at the switch of plans") {
  // W2^2 = 2 - 2 cos of the angle to the nearest quarter turn, so that its slopes at 45 degrees are +sqrt 2 and
  // -sqrt 2.
  for (const std::string& method : exact_methods()) {
    TransportComparison comparison = open_comparison(method);
    Measure square{{1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0}, {}, uniform_weights(4)}, turned = square;
    std::vector<double> still(24, 0.0), turning(24, 0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      const double angle = (static_cast<double>(k) * 2.0 + 1.0) * std::acos(-1.0) / 4.0;
      turned.position[3 * k] = std::cos(angle);
      turned.position[3 * k + 1] = std::sin(angle);
      turning[6 * k + 3] = -std::sin(angle);
      turning[6 * k + 4] = std::cos(angle);
    }
    TransportResult result;
    REQUIRE(comparison.compare(square, turned, result).ok());
    CHECK(result.answer.value == doctest::Approx(2.0 - std::sqrt(2.0)));
    CHECK(result.answer.multiple);
    OneSidedDerivatives slopes;
    const Status status = one_sided_derivatives(comparison, square, turned, result, still, turning, slopes);
    REQUIRE_MESSAGE(status.ok(), status.text);
    CHECK(slopes.before == doctest::Approx(std::sqrt(2.0)));
    CHECK(slopes.after == doctest::Approx(-std::sqrt(2.0)));
  }
}
