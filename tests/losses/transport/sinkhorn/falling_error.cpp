#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/composition/tree.hpp"
#include "tests/losses/transport/opened_transport.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

struct Regularized {
  double value = 0.0, transport_cost = 0.0;
};

Regularized regularized(const Measure& a, const Measure& b, double epsilon, bool debiased) {
  TransportComparison sinkhorn = open_transport(
      "sinkhorn", {{"epsilon", decimal(epsilon)}, {"debiased", debiased ? "true" : "false"}, {"tolerance", "1e-11"}});
  const TransportAnswer answer = compare(sinkhorn, a, b).answer;
  return {answer.value, answer.transport_cost};
}

/// A normal distribution on a line, by the trapezoidal rule: to rounding, as long as its spacing is small beside both
/// deviations and √ε, and the tails are cut off where they are nothing.
Measure normal(double mean, double deviation) {
  Measure out;
  double sum = 0.0;
  for (int k = -112; k <= 112; ++k) {
    const double x = 0.125 * k;
    out.position.insert(out.position.end(), {x, 0.0, 0.0});
    sum += out.weight.emplace_back(std::exp(-0.5 * std::pow((x - mean) / deviation, 2)));
  }
  for (double& weight : out.weight) weight /= sum;
  return out;
}

/// ⟨C, P⟩ + ε KL(P | a bᵀ) between normal distributions on a line, and ⟨C, P⟩ (H. Janati, B. Muzellec, G. Peyré,
/// M. Cuturi, NeurIPS (2020), theorem 1, with 2σ² = ε).
Regularized between_normals(double apart, double deviation_a, double deviation_b, double epsilon) {
  const double a = deviation_a * deviation_a, b = deviation_b * deviation_b, s = 0.5 * epsilon;
  const double root = std::sqrt(4.0 * a * b + s * s);
  return {apart * apart + a + b - root + s * (1.0 - std::log(epsilon)) + s * std::log(root + s),
          apart * apart + a + b - (root - s)};
}

double squared_distance(const Measure& a, std::size_t i, const Measure& b, std::size_t j) {
  double sum = 0.0;
  for (std::size_t e = 0; e < 3; ++e) sum += std::pow(a.position[3 * i + e] - b.position[3 * j + e], 2);
  return sum;
}

/// What the cheapest exchange among the pairs of a permutation costs, per place that takes part: the least mean of a
/// cycle (R. Karp, Discrete Mathematics 23 (1978) 309).
double cheapest_exchange(const Measure& a, const Measure& b, const SparseEntries& permutation) {
  const std::size_t count = a.count();
  std::vector<std::size_t> partner(count);
  for (std::size_t k = 0; k < count; ++k) {
    partner[static_cast<std::size_t>(permutation.row[k])] = static_cast<std::size_t>(permutation.column[k]);
  }
  std::vector<std::vector<double>> walk(count + 1, std::vector<double>(count, 0.0));
  for (std::size_t steps = 1; steps <= count; ++steps) {
    for (std::size_t to = 0; to < count; ++to) {
      double& least = walk[steps][to] = HUGE_VAL;
      for (std::size_t from = 0; from < count; ++from) {
        if (from == to) continue;
        const double more = squared_distance(a, from, b, partner[to]) - squared_distance(a, from, b, partner[from]);
        least = std::min(least, walk[steps - 1][from] + more);
      }
    }
  }
  double least = HUGE_VAL;
  for (std::size_t place = 0; place < count; ++place) {
    double largest = -HUGE_VAL;
    for (std::size_t steps = 0; steps < count; ++steps) {
      const double mean = (walk[count][place] - walk[steps][place]) / static_cast<double>(count - steps);
      largest = std::max(largest, mean);
    }
    least = std::min(least, largest);
  }
  return least;
}

/// How often `coarse` halves as epsilon does once.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("normal distributions: value, divergence and cost in closed form") {
  const Measure a = normal(0.0, 1.0), b = normal(1.0, 1.5);
  for (const double epsilon : {4.0, 1.0, 0.25}) {
    const Regularized expected = between_normals(1.0, 1.0, 1.5, epsilon);
    const double within = between_normals(0.0, 1.0, 1.0, epsilon).value + between_normals(0.0, 1.5, 1.5, epsilon).value;
    const Regularized found = regularized(a, b, epsilon, false);
    CHECK(found.value == doctest::Approx(expected.value).epsilon(1e-12));
    CHECK(found.transport_cost == doctest::Approx(expected.transport_cost).epsilon(1e-9));
    CHECK(regularized(a, b, epsilon, true).value == doctest::Approx(expected.value - 0.5 * within).epsilon(1e-12));
  }
}

TEST_CASE("normal distributions: the divergence's error is of second order in epsilon, the cost's of first") {
  const Measure a = normal(0.0, 1.0), b = normal(1.0, 1.5);
  const double exact = 1.0 + 0.25;  // |means|² + (deviation − deviation)²
  std::vector<double> of_divergence, of_cost;
  for (const double epsilon : {1.0, 0.5, 0.25, 0.125}) {
    of_divergence.push_back(std::fabs(regularized(a, b, epsilon, true).value - exact));
    of_cost.push_back(regularized(a, b, epsilon, false).transport_cost - exact);
  }
  REQUIRE(of_divergence.back() > 1e-6);
  REQUIRE(of_cost.back() > 1e-3);
  for (std::size_t k = 0; k + 1 < of_cost.size(); ++k) {
    CHECK(std::fabs(order(of_divergence[k], of_divergence[k + 1]) - 2.0) < 0.05);
    CHECK(std::fabs(order(of_cost[k], of_cost[k + 1]) - 1.0) < 0.1);
  }
}

// Around a cycle of arcs that the best plan does not use, scaling leaves the product of exp(−c/ε), and so on each of
// them exp(−mean/ε): the cheapest exchange is the rate (R. Cominetti, J. San Martín, Mathematical Programming 67 (1994)
// 169: that there is such a rate).
TEST_CASE("places: the value comes down on the exact one as epsilon log n, the cost exponentially") {
  constexpr int count = 20;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Measure a = probability_cloud(count, 2 * seed, 10.0, true),
                  b = probability_cloud(count, 2 * seed + 1, 10.0, true);
    TransportComparison transport = open_transport("exact");
    const TransportAnswer best = compare(transport, a, b).answer;
    REQUIRE(best.plan.value.size() == count);
    const double rate = cheapest_exchange(a, b, best.plan);
    REQUIRE(rate > 0.0);
    double value_before = HUGE_VAL, cost_before = HUGE_VAL;
    for (const double part : {2.5, 5.0, 10.0}) {
      const double epsilon = rate / part;
      const Regularized found = regularized(a, b, epsilon, false);
      const double of_value = found.value - best.value, of_cost = found.transport_cost - best.value;
      CAPTURE(seed);
      CAPTURE(epsilon);
      // KL(P | a bᵀ) is never above log n, which a permutation has.
      CHECK(of_value > 0.0);
      CHECK(of_value <= epsilon * std::log(count) * (1.0 + 1e-6));
      CHECK(of_value < value_before);
      CHECK(of_cost < cost_before);
      if (part == 10.0) {
        CHECK(of_value == doctest::Approx(epsilon * std::log(count)).epsilon(1e-3));
        REQUIRE(of_cost > 1e-8);
        const double found_rate = std::log(cost_before / of_cost) / (0.5 / epsilon);
        CHECK(found_rate == doctest::Approx(rate).epsilon(0.1));
      }
      value_before = of_value;
      cost_before = of_cost;
    }
  }
}
