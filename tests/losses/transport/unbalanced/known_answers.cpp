#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/losses/transport/unbalanced/problems.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

TEST_CASE("two points under KL: the mass is sqrt(ab) exp(-c / 2 rho)") {
  for (const double a : {1e-3, 1.0, 7.0}) {
    for (const double b : {0.5, 1.0, 200.0}) {
      for (const double cost : {0.0, 1e-9, 0.3, 5.0, 60.0}) {
        for (const double rho : {0.7, 1.0, 1e4}) {
          CAPTURE(a);
          CAPTURE(b);
          CAPTURE(cost);
          CAPTURE(rho);
          TransportComparison transport = unbalanced("kl", rho);
          const TransportAnswer answer = compare(transport, {a}, {b}, {cost});
          const double moved = cost < 80.0 * rho ? std::sqrt(a * b) * std::exp(-0.5 * cost / rho) : 0.0;
          // a + b − 2√(ab) e^{−c/2ρ} without its cancellation.
          const double root = std::sqrt(a) - std::sqrt(b);
          const double value = rho * (root * root - 2.0 * std::sqrt(a * b) * std::expm1(-0.5 * cost / rho));
          CHECK(std::fabs(answer.value - value) <= 1e-13 * (value + cost * moved + 1e-3 * rho * (a + b)));
          CHECK(std::fabs(figure(answer, "mass") - moved) <= 1e-12 * moved + 1e-15 * std::sqrt(a * b));
          CHECK(answer.weight_gradient_a[0] == doctest::Approx(rho * (1.0 - moved / a)).epsilon(1e-9));
          CHECK(answer.weight_gradient_b[0] == doctest::Approx(rho * (1.0 - moved / b)).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_CASE("two points under KL with entropy: the stationary mass in closed form") {
  for (const double epsilon : {1e-3, 0.2, 3.0}) {
    const double a = 2.0, b = 0.7, cost = 0.9, rho = 1.3;
    TransportComparison transport = unbalanced("kl", rho, epsilon);
    const TransportAnswer answer = compare(transport, {a}, {b}, {cost});
    // c + ε log(m/ab) + ρ log(m/a) + ρ log(m/b) = 0
    const double moved = std::exp(((epsilon + rho) * std::log(a * b) - cost) / (epsilon + 2.0 * rho));
    CHECK(figure(answer, "mass") == doctest::Approx(moved).epsilon(1e-13));
    const auto divergence = [](double x, double y) { return x * std::log(x / y) - x + y; };
    CHECK(answer.value == doctest::Approx(cost * moved + epsilon * divergence(moved, a * b) +
                                          rho * (divergence(moved, a) + divergence(moved, b)))
                              .epsilon(1e-13));
  }
}

TEST_CASE("two points under total variation: rho |a - b| + min(c, 2 rho) min(a, b)") {
  for (const double a : {1e-3, 1.0, 7.0}) {
    for (const double b : {0.5, 1.0, 200.0}) {
      for (const double cost : {0.0, 0.3, 1.9, 2.1, 1e32}) {
        CAPTURE(a);
        CAPTURE(b);
        CAPTURE(cost);
        const double rho = 1.0;
        TransportComparison transport = unbalanced("total-variation", rho);
        const TransportAnswer answer = compare(transport, {a}, {b}, {cost});
        CHECK(answer.value ==
              doctest::Approx(rho * std::fabs(a - b) + std::min(cost, 2.0 * rho) * std::min(a, b)).epsilon(1e-14));
        CHECK(figure(answer, "mass") == doctest::Approx(cost < 2.0 * rho ? std::min(a, b) : 0.0));
        CHECK(answer.value ==
              doctest::Approx(answer.transport_cost + figure(answer, "penalty_a") + figure(answer, "penalty_b")));
      }
    }
  }
}

TEST_CASE("a measure is at no distance from itself") {
  std::mt19937 random(1);
  const Measure cloud = random_cloud(random, 12);
  for (const char* penalty : {"kl", "total-variation"}) {
    TransportComparison transport = unbalanced(penalty, 0.3);
    const TransportAnswer answer = compare(transport, cloud, cloud).answer;
    CHECK(std::fabs(answer.value) <= 1e-14);
    CHECK(answer.plan.value.size() == 12);
    CHECK(figure(answer, "mass") == doctest::Approx(sum(cloud.weight)).epsilon(1e-12));
  }
}

TEST_CASE("with a large marginal weight and equal sums both penalties give exact transport") {
  std::mt19937 random(2);
  Measure a = random_cloud(random, 9), b = random_cloud(random, 14);
  for (Measure* measure : {&a, &b}) {
    const double total = sum(measure->weight);
    for (double& weight : measure->weight) weight /= total;
  }
  TransportComparison exact = open_transport("exact", {});
  const double balanced = compare(exact, a, b).answer.value;
  TransportComparison total_variation = unbalanced("total-variation", 1e3);
  CHECK(compare(total_variation, a, b).answer.value == doctest::Approx(balanced).epsilon(1e-12));
  // Of KL the difference is Σ a u² / 2ρ and the same of b, to first order: a tenth with ten times the weight.
  double apart[3];
  for (int k = 0; k < 3; ++k) {
    TransportComparison transport = unbalanced("kl", 1e4 * std::pow(10.0, k));
    apart[k] = balanced - compare(transport, a, b).answer.value;
    CHECK(apart[k] > 0.0);
  }
  CHECK(apart[1] == doctest::Approx(apart[0] / 10.0).epsilon(1e-2));
  CHECK(apart[2] == doctest::Approx(apart[1] / 10.0).epsilon(1e-2));
}

TEST_CASE("with less and less entropy the value comes down to the one without") {
  std::mt19937 random(3);
  const Measure a = random_cloud(random, 20), b = random_cloud(random, 15);
  TransportComparison without = unbalanced("kl", 0.2);
  const double limit = compare(without, a, b).answer.transport_cost;
  double before = infinity;
  for (const double epsilon : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    TransportComparison transport = unbalanced("kl", 0.2, epsilon);
    const double apart = std::fabs(compare(transport, a, b).answer.transport_cost - limit);
    CHECK(apart < before);
    before = apart;
  }
  CHECK(before <= 1e-4 * limit);
}

TEST_CASE("what is far apart stays where it is, whatever is forbidden") {
  const double rho = 0.5;
  const std::vector<double> a = {1.0, 2.0}, b = {3.0};
  for (const double cost : {200.0, 1e32, infinity}) {
    CAPTURE(cost);
    for (const double epsilon : {0.0, 0.1}) {
      TransportComparison transport = unbalanced("kl", rho, epsilon);
      const TransportAnswer answer = compare(transport, a, b, {cost, cost});
      CHECK(answer.value == doctest::Approx(rho * 6.0 + epsilon * 9.0));
      for (const std::vector<double>* gradient : {&answer.weight_gradient_a, &answer.weight_gradient_b}) {
        for (const double entry : *gradient) CHECK(entry == doctest::Approx(rho + 3.0 * epsilon));
      }
    }
    TransportComparison transport = unbalanced("total-variation", rho);
    const TransportAnswer answer = compare(transport, a, b, {cost, cost});
    CHECK(answer.value == doctest::Approx(rho * 6.0));
    CHECK(answer.plan.value.empty());
  }
}

TEST_CASE("forbidden and huge pairs leave the others alone") {
  const double rho = 2.0;
  for (const double barred : {1e32, infinity}) {
    TransportComparison transport = unbalanced("kl", rho);
    const TransportAnswer answer = compare(transport, {1.0, 2.0}, {1.5, 0.5}, {0.4, barred, barred, 0.9});
    const double first = std::sqrt(1.5) * std::exp(-0.1), second = std::exp(-0.225);
    CHECK(figure(answer, "mass") == doctest::Approx(first + second).epsilon(1e-12));
    CHECK(answer.value == doctest::Approx(rho * (2.5 - 2.0 * first + 2.5 - 2.0 * second)).epsilon(1e-12));
    CHECK(answer.plan.value.size() == 2);
  }
}

TEST_CASE("places without mass change nothing, and have the derivative of a little mass") {
  std::mt19937 random(4);
  Measure a = random_cloud(random, 7), b = random_cloud(random, 6);
  const Measure all_a = a, all_b = b;
  a.weight[2] = 0.0;
  b.weight[0] = 0.0;
  for (const char* penalty : {"kl", "total-variation", "entropy"}) {
    CAPTURE(penalty);
    const bool entropy = std::string(penalty) == "entropy";
    TransportComparison transport = unbalanced(entropy ? "kl" : penalty, 0.3, entropy ? 0.05 : 0.0);
    const TransportAnswer answer = compare(transport, a, b).answer;
    for (std::size_t k = 0; k < answer.plan.value.size(); ++k) {
      CHECK(answer.plan.row[k] != 2);
      CHECK(answer.plan.column[k] != 0);
    }
    for (const bool of_first : {true, false}) {
      Measure more_a = a, more_b = b;
      (of_first ? more_a.weight[2] : more_b.weight[0]) = 1e-7;
      const double gain = (compare(transport, more_a, more_b).answer.value - answer.value) / 1e-7;
      CHECK((of_first ? answer.weight_gradient_a[2] : answer.weight_gradient_b[0]) ==
            doctest::Approx(gain).epsilon(1e-5));
    }
  }
}
