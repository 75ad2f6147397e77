#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/transport/check_measure.hpp"
#include "problems.hpp"

using namespace exact_test;

namespace {

std::vector<double> moved(std::vector<double> points, double x, double y, double z) {
  for (std::size_t k = 0; k < points.size(); k += 3) {
    points[k] += x;
    points[k + 1] += y;
    points[k + 2] += z;
  }
  return points;
}

/// W₂² in one dimension: the masses in order.
double by_sorting(std::vector<std::pair<double, double>> a, std::vector<std::pair<double, double>> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double sum = 0.0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double mass = std::min(a[i].second, b[j].second);
    sum += mass * (a[i].first - b[j].first) * (a[i].first - b[j].first);
    a[i].second -= mass;
    b[j].second -= mass;
    (a[i].second <= b[j].second ? i : j) += 1;
  }
  return sum;
}

}  // namespace

TEST_CASE("a translation costs the square of its length, whatever moves") {
  std::mt19937 random(1);
  for (const std::string& method : exact_methods()) {
    for (const double length : {0.0, 1e-8, 1e-3, 1.0, 100.0}) {
      CAPTURE(method);
      CAPTURE(length);
      TransportComparison comparison = open_comparison(method);
      Measure a{random_curve(random, 40), {}, random_weights(random, 40)};
      Measure b = a;
      b.position = moved(a.position, 0.6 * length, 0.0, 0.8 * length);
      TransportResult result;
      REQUIRE(comparison.compare(a, b, result).ok());
      // Coordinates of 30 mm are rounded to 4e-15 mm.
      CHECK(std::fabs(result.answer.value - length * length) <= 1e-12 * length * length + 1e-14 * length);
      CHECK(result.answer.plan.value.size() == 40);
      check_proof({a.weight, b.weight, squared_distances(a.position, b.position)}, result.answer);
    }
  }
}

TEST_CASE("in one dimension mass goes in order") {
  std::mt19937 random(2);
  for (const std::string& method : exact_methods()) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      const int rows = 2 + below(random, 30), columns = 2 + below(random, 30);
      MatrixProblem problem{random_weights(random, rows), random_weights(random, columns), {}};
      std::vector<std::pair<double, double>> a, b;
      for (const double weight : problem.a) a.emplace_back(10.0 * uniform(random), weight);
      for (const double weight : problem.b) b.emplace_back(10.0 * uniform(random), weight);
      for (const auto& [x, of_x] : a) {
        for (const auto& [y, of_y] : b) problem.cost.push_back((x - y) * (x - y));
      }
      CHECK(solve_cold(method, problem).value == doctest::Approx(by_sorting(a, b)).epsilon(1e-12));
    }
  }
}

TEST_CASE("as many places with like weights: a permutation, with exactly as many entries") {
  std::mt19937 random(3);
  for (const std::string& method : exact_methods()) {
    for (const int count : {1, 2, 7, 60}) {
      for (const bool curves : {false, true}) {
        const std::vector<double> weight = uniform_weights(static_cast<std::size_t>(count));
        const MatrixProblem problem{
            weight, weight,
            squared_distances(curves ? random_curve(random, count) : random_cloud(random, count),
                              curves ? random_curve(random, count) : random_cloud(random, count))};
        const TransportAnswer answer = solve_cold(method, problem);
        REQUIRE(answer.plan.value.size() == static_cast<std::size_t>(count));
        const std::set<int> rows(answer.plan.row.begin(), answer.plan.row.end());
        const std::set<int> columns(answer.plan.column.begin(), answer.plan.column.end());
        CHECK(rows.size() == static_cast<std::size_t>(count));
        CHECK(columns.size() == static_cast<std::size_t>(count));
        for (const double mass : answer.plan.value) CHECK(mass == doctest::Approx(1.0 / count).epsilon(1e-15));
        CHECK(answer.uniqueness_known);
        CHECK_FALSE(answer.multiple);
      }
    }
  }
}

TEST_CASE("a place that is split into several of the same weight changes nothing") {
  std::mt19937 random(4);
  for (const std::string& method : exact_methods()) {
    const std::vector<double> a = random_cloud(random, 9), b = random_cloud(random, 9);
    const double whole = solve_cold(method, {uniform_weights(9), uniform_weights(9), squared_distances(a, b)}).value;
    std::vector<double> split;
    for (std::size_t k = 0; k < a.size(); k += 3) {
      for (int copy = 0; copy < 3; ++copy) split.insert(split.end(), &a[k], &a[k] + 3);
    }
    const TransportAnswer answer =
        solve_cold(method, {uniform_weights(27), uniform_weights(9), squared_distances(split, b)});
    CHECK(answer.value == doctest::Approx(whole).epsilon(1e-13));
    CHECK(answer.plan.value.size() == 27);

    // Halves, quarters and an eighth of it, and a third against two thirds, whose doubles do not add up.
    const TransportAnswer parts =
        solve_cold(method, {{1.0 / 3.0, 2.0 / 3.0}, {1.0 / 3.0, 1.0 / 6.0, 0.5}, {0.0, 5.0, 5.0, 5.0, 1.0, 2.0}});
    CHECK(parts.value == doctest::Approx(1.0 / 6.0 + 1.0).epsilon(1e-14));
    CHECK(parts.plan.value.size() == 3);
  }
}

TEST_CASE("places without mass have duals: what a little mass there would cost") {
  for (const std::string& method : exact_methods()) {
    const MatrixProblem problem{{0.0, 1.0, 0.0}, {1.0, 0.0}, {4.0, 1.0, 2.0, 7.0, 0.5, 9.0}};
    const TransportAnswer answer = solve_cold(method, problem);
    CHECK(answer.value == doctest::Approx(2.0));
    CHECK(answer.plan.value.size() == 1);
    check_proof(problem, answer);
    for (const std::vector<double>* duals : {&answer.dual_a, &answer.dual_b}) {
      for (const double dual : *duals) CHECK(std::isfinite(dual));
    }
  }
}

TEST_CASE("the derivative with respect to weights, against differences") {
  std::mt19937 random(5);
  for (const std::string& method : exact_methods()) {
    const MatrixProblem problem{random_weights(random, 12), random_weights(random, 9),
                                squared_distances(random_cloud(random, 12), random_cloud(random, 9))};
    const TransportAnswer answer = solve_cold(method, problem);
    REQUIRE(answer.slack > 1e-6);
    double norm = 0.0;
    for (const double entry : answer.weight_gradient_a) norm += entry * entry;
    REQUIRE(norm > 1.0);
    constexpr double step = 1e-5;
    for (std::size_t i = 1; i < 12; ++i) {
      double value[2];
      for (const int side : {0, 1}) {
        MatrixProblem there = problem;  // mass goes from place 0 to place i
        const double by = side == 0 ? -step : step;
        there.a[0] -= by;
        there.a[i] += by;
        value[side] = solve_cold(method, there).value;
      }
      CHECK((value[1] - value[0]) / (2.0 * step) ==
            doctest::Approx(answer.weight_gradient_a[i] - answer.weight_gradient_a[0]).epsilon(1e-7));
    }
    MatrixProblem more = problem;  // of both, in proportion
    for (std::vector<double>* side : {&more.a, &more.b}) {
      for (double& weight : *side) weight *= 1.0 + step;
    }
    double along = 0.0;
    for (std::size_t i = 0; i < 12; ++i) along += problem.a[i] * answer.weight_gradient_a[i];
    for (std::size_t j = 0; j < 9; ++j) along += problem.b[j] * answer.weight_gradient_b[j];
    CHECK((solve_cold(method, more).value - answer.value) / step == doctest::Approx(along).epsilon(1e-9));
  }
}

TEST_CASE("a problem that is turned around has the same value and the transposed plan") {
  std::mt19937 random(6);
  for (const std::string& method : exact_methods()) {
    const std::vector<double> x = random_cloud(random, 20), y = random_cloud(random, 31);
    const std::vector<double> a = random_weights(random, 20), b = random_weights(random, 31);
    const TransportAnswer there = solve_cold(method, {a, b, squared_distances(x, y)});
    const TransportAnswer back = solve_cold(method, {b, a, squared_distances(y, x)});
    CHECK(there.value == doctest::Approx(back.value).epsilon(1e-13));
    std::set<std::pair<int, int>> pairs, swapped;
    for (std::size_t k = 0; k < there.plan.value.size(); ++k) pairs.emplace(there.plan.row[k], there.plan.column[k]);
    for (std::size_t k = 0; k < back.plan.value.size(); ++k) swapped.emplace(back.plan.column[k], back.plan.row[k]);
    CHECK(pairs == swapped);
  }
}

TEST_CASE("the same input gives the same bits") {
  std::mt19937 random(7);
  const MatrixProblem problem{random_weights(random, 50), random_weights(random, 40),
                              squared_distances(random_cloud(random, 50), random_cloud(random, 40))};
  for (const std::string& method : exact_methods()) {
    const TransportAnswer first = solve_cold(method, problem), second = solve_cold(method, problem);
    CHECK(first.value == second.value);
    CHECK(first.plan.value == second.plan.value);
    CHECK(first.dual_a == second.dual_a);
    CHECK(first.iterations == second.iterations);
  }
}
