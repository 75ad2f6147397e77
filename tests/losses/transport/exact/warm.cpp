#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/transport/check_measure.hpp"
#include "problems.hpp"

using namespace exact_test;

namespace {

int steps() { return std::getenv("BOWSTRING_TEST_SHORT") != nullptr ? 20 : 150; }

void wander(std::mt19937& random, std::vector<double>& points, double step) {
  for (double& x : points) x += step * (uniform(random) - 0.5);
}

}  // namespace

TEST_CASE("along a walk of the points the kept tree leads to the values of cold solves, with fewer pivots") {
  std::mt19937 random(11);
  for (const bool curves : {false, true}) {
    for (const bool weighted : {false, true}) {
      CAPTURE(curves);
      CAPTURE(weighted);
      std::vector<double> x = curves ? random_curve(random, 50) : random_cloud(random, 50);
      std::vector<double> y = curves ? random_curve(random, 60) : random_cloud(random, 60);
      MatrixProblem problem{weighted ? random_weights(random, 50) : uniform_weights(50),
                            weighted ? random_weights(random, 60) : uniform_weights(60),
                            {}};
      TransportComparison kept = open_comparison("exact");
      long warm_pivots = 0, cold_pivots = 0;
      for (int step = 0; step < steps(); ++step) {
        wander(random, x, 1.0);
        wander(random, y, 1.0);
        problem.cost = squared_distances(x, y);
        TransportAnswer warm;
        REQUIRE(solve_into(kept, problem, warm).ok());
        const TransportAnswer cold = solve_cold("exact", problem);
        CHECK(warm.warm == (step > 0));
        CHECK(warm.value == doctest::Approx(cold.value).epsilon(1e-12));
        check_proof(problem, warm);
        warm_pivots += warm.iterations;
        cold_pivots += cold.iterations;
      }
      CHECK(cold_pivots > 0);
      CHECK(3 * warm_pivots < cold_pivots);
    }
  }
}

TEST_CASE("weights that change as well: the tree is kept where it carries them, and never lies") {
  std::mt19937 random(12);
  std::vector<double> x = random_cloud(random, 40), y = random_cloud(random, 30);
  MatrixProblem problem{random_weights(random, 40), random_weights(random, 30), {}};
  TransportComparison kept = open_comparison("exact");
  int warm_ones = 0;
  for (int step = 0; step < 2 * steps(); ++step) {
    wander(random, x, 0.5);
    for (std::vector<double>* side : {&problem.a, &problem.b}) {
      for (double& weight : *side) weight *= 1.0 + (step % 10 == 0 ? 0.3 : 1e-4) * (uniform(random) - 0.5);
      if (step % 25 == 24) (*side)[static_cast<std::size_t>(below(random, 30))] = 0.0;
      const double sum = std::accumulate(side->begin(), side->end(), 0.0);
      for (double& weight : *side) weight /= sum;
    }
    problem.cost = squared_distances(x, y);
    TransportAnswer answer;
    REQUIRE(solve_into(kept, problem, answer).ok());
    warm_ones += answer.warm ? 1 : 0;
    CHECK(answer.value == doctest::Approx(solve_cold("exact", problem).value).epsilon(1e-12));
    check_proof(problem, answer);
  }
  CHECK(warm_ones > steps() / 2);
}

TEST_CASE("a problem of another size, a refusal and `forget` start cold") {
  std::mt19937 random(13);
  const auto problem_of = [&](int rows, int columns) {
    return MatrixProblem{uniform_weights(static_cast<std::size_t>(rows)),
                         uniform_weights(static_cast<std::size_t>(columns)),
                         squared_distances(random_cloud(random, rows), random_cloud(random, columns))};
  };
  const MatrixProblem first = problem_of(12, 12), other = problem_of(9, 14);
  TransportComparison kept = open_comparison("exact");
  TransportAnswer answer;
  const auto warm = [&](const MatrixProblem& problem) {
    REQUIRE(solve_into(kept, problem, answer).ok());
    CHECK(answer.value == doctest::Approx(solve_cold("exact", problem).value).epsilon(1e-12));
    return answer.warm;
  };
  CHECK_FALSE(warm(first));
  CHECK(warm(first));
  CHECK(answer.iterations == 0);
  CHECK_FALSE(warm(other));
  CHECK_FALSE(warm(first));
  kept.forget();
  CHECK_FALSE(warm(first));
  MatrixProblem closed = first;
  for (std::size_t j = 0; j < 12; ++j) closed.cost[j] = HUGE_VAL;
  CHECK_FALSE(solve_into(kept, closed, answer).ok());
  CHECK_FALSE(warm(first));
}
