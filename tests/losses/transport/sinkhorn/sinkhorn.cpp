#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/losses/transport/opened_transport.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

Settings with_epsilon(double epsilon, bool debiased = true) {
  return {{"epsilon", std::to_string(epsilon)}, {"debiased", debiased ? "true" : "false"}};
}

/// Σ of what the plan carries between two places.
double mass_between(const TransportAnswer& answer, int row, int column) {
  double mass = 0.0;
  for (std::size_t k = 0; k < answer.plan.value.size(); ++k) {
    if (answer.plan.row[k] == row && answer.plan.column[k] == column) mass += answer.plan.value[k];
  }
  return mass;
}

}  // namespace

TEST_CASE("two places and two: the plan in closed form") {
  // C = [[0, c], [c, 0]] and halves: P12 = 1/(2 (1 + exp(c/epsilon))).
  const Measure pair{{0, 0, 0, 1.5, 0, 0}, {}, {0.5, 0.5}};
  for (const double epsilon : {4.0, 1.0, 0.25, 0.125}) {
    TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(epsilon, false));
    const TransportResult result = compare(sinkhorn, pair, pair);
    const double expected = 0.5 / (1.0 + std::exp(2.25 / epsilon));
    CHECK(mass_between(result.answer, 0, 1) == doctest::Approx(expected).epsilon(1e-9));
    CHECK(result.answer.transport_cost == doctest::Approx(2.0 * 2.25 * expected).epsilon(1e-9));
    // OT = −ε log((1 + exp(−c/ε))/2) there: both potentials are half of it.
    CHECK(result.answer.value ==
          doctest::Approx(-epsilon * std::log(0.5 * (1.0 + std::exp(-2.25 / epsilon)))).epsilon(1e-12));
    CHECK(std::fabs(result.answer.gap) < 1e-9);
  }
}

TEST_CASE("the divergence is zero for equal measures, and |t|^2 for a shift") {
  const Measure cloud = probability_cloud(20, 1);
  for (const double epsilon : {1.0, 0.1, 0.01}) {
    TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(epsilon));
    CHECK(std::fabs(value_of(sinkhorn, cloud, cloud)) < 1e-12);
    // The entropic plan of a shift is that of no shift: costs change by what depends on each place alone.
    CHECK(value_of(sinkhorn, shifted(cloud, 1.0, -2.0, 2.0), cloud) == doctest::Approx(9.0).epsilon(1e-9));
  }
}

TEST_CASE("gap, marginals and derivatives") {
  const Measure a = probability_cloud(6, 2), b = shifted(probability_cloud(5, 3), 0.5, 0.1, -0.4);
  for (const bool debiased : {false, true}) {
    TransportComparison sinkhorn = open_transport(
        "sinkhorn", {{"epsilon", "0.1"}, {"debiased", debiased ? "true" : "false"}, {"tolerance", "1e-12"}});
    const TransportResult result = compare(sinkhorn, a, b);
    CHECK(result.answer.gap >= -1e-14);
    CHECK(result.answer.gap < 1e-10);
    check_place_gradients(sinkhorn, a, b, 1e-6);
    check_weight_gradients(sinkhorn, a, b, true, 1e-6);
  }
}

TEST_CASE("small epsilon: the bias falls with it as it must, and nothing overflows") {
  const Measure a = probability_cloud(12, 4, 10.0), b = shifted(probability_cloud(12, 5, 10.0), 1.0, 0.0, 0.0);
  TransportComparison exact = open_transport("exact");
  const TransportResult best = compare(exact, a, b);
  // ⟨C, P⟩ + ε KL(P) ≤ ⟨C, P*⟩ + ε KL(P*), and KL(P) is not negative.
  double divergence = 0.0;
  for (std::size_t k = 0; k < best.answer.plan.value.size(); ++k) {
    const double mass = best.answer.plan.value[k];
    divergence += mass * std::log(mass / (a.weight[static_cast<std::size_t>(best.answer.plan.row[k])] *
                                          b.weight[static_cast<std::size_t>(best.answer.plan.column[k])]));
  }
  REQUIRE(divergence > 0.5);
  double before = HUGE_VAL;
  for (const double epsilon : {100.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.03}) {
    TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(epsilon, false));
    const TransportResult result = compare(sinkhorn, a, b);
    const double bias = result.answer.transport_cost - best.answer.value;
    CHECK(bias > 0.0);
    CHECK(bias < before);
    CHECK(bias <= epsilon * divergence);
    before = bias;
  }
  CHECK(before < 1e-3 * best.answer.value);
}

TEST_CASE("it goes on from the potentials of the call before") {
  const Measure a = probability_cloud(30, 6), b = probability_cloud(30, 7);
  TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(0.02, false));
  const long cold = compare(sinkhorn, a, b).answer.iterations;
  const Measure moved = shifted(a, 1e-3, 0.0, 0.0);
  const TransportResult warm = compare(sinkhorn, moved, b);
  CHECK(warm.answer.warm);
  CHECK(warm.answer.iterations < cold);
  sinkhorn.forget();
  const TransportResult again = compare(sinkhorn, moved, b);
  CHECK_FALSE(again.answer.warm);
  CHECK(again.answer.value == doctest::Approx(warm.answer.value).epsilon(1e-10));
}

TEST_CASE("few places and many, either way round, where scaling alone would be at it for long") {
  const Measure few = probability_cloud(12, 31, 10.0), many = probability_cloud(60, 32, 10.0);
  TransportComparison exact = open_transport("exact"), sinkhorn = open_transport("sinkhorn", with_epsilon(0.01, false));
  const TransportResult one = compare(sinkhorn, few, many), other = compare(sinkhorn, many, few);
  CHECK(one.answer.value == doctest::Approx(other.answer.value).epsilon(1e-10));
  CHECK(one.answer.iterations < 5000);
  CHECK(other.answer.iterations < 5000);
  const double least = value_of(exact, few, many);
  CHECK(one.answer.transport_cost >= least * (1.0 - 1e-9));
  CHECK(one.answer.transport_cost == doctest::Approx(least).epsilon(1e-3));
}

TEST_CASE("ordered curves at small epsilon: few iterations, and no wrong end") {
  // Pairs of next to no mass connect what each place of a curve exchanges with its neighbours.
  Measure a, b;
  constexpr int count = 80;
  constexpr double dearest = 60.0 * 60.0 + 60.0 * 60.0;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count;
    for (Measure* measure : {&a, &b}) {
      const double angle = 25.0 * t + (measure == &a ? 0.0 : 0.4);
      measure->position.insert(measure->position.end(), {30.0 * std::cos(angle), 30.0 * std::sin(angle), 60.0 * t});
      measure->weight.push_back(1.0 / count);
    }
  }
  TransportComparison exact = open_transport("exact");
  const double least = value_of(exact, a, b);
  for (const double share : {1e-1, 1e-2, 1e-3}) {
    TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(share * least, false));
    const TransportResult result = compare(sinkhorn, a, b);
    CHECK(result.answer.iterations < 5000);
    // What rounding moves, twice the tolerance of the marginals, costs no more than the dearest pair.
    CHECK(result.answer.gap >= -1e-12 * least);
    CHECK(result.answer.gap <= 2.0 * 1e-9 * dearest);
    CHECK(result.answer.value >= least);
    CHECK(result.answer.value <= least + share * least * std::log(count) * (1.0 + 1e-6));
  }
}

TEST_CASE("what has not converged is no answer, and says how to mend it") {
  const Measure a = probability_cloud(30, 33, 10.0), b = probability_cloud(30, 34, 10.0);
  TransportComparison sinkhorn =
      open_transport("sinkhorn", {{"epsilon", "0.01"}, {"debiased", "false"}, {"max-iterations", "1"}});
  TransportResult result;
  const Status status = sinkhorn.compare(a, b, result);
  CHECK(status.code == Code::failed);
  CHECK(status.text.find("the marginals are off by") != std::string::npos);
  CHECK(status.text.find("expected 1e-09; raise max-iterations, tolerance or epsilon") != std::string::npos);
}

TEST_CASE("weights of any sum, places without weight, forbidden pairs") {
  TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(0.5, false));
  Measure a = probability_cloud(6, 8), b = probability_cloud(5, 9);
  a.weight = {0.3, 0.0, 0.2, 0.1, 0.2, 0.2};
  const double one = value_of(sinkhorn, a, b);
  for (double& weight : a.weight) weight *= 3.0;
  for (double& weight : b.weight) weight *= 3.0;
  sinkhorn.forget();
  CHECK(value_of(sinkhorn, a, b) == doctest::Approx(3.0 * one).epsilon(1e-10));
  const std::vector<double> halves{0.5, 0.5}, forbidden{1.0, HUGE_VAL, 1.0, 2.0};
  TransportResult result;
  const Status status = sinkhorn.compare(halves, halves, forbidden, result);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text ==
        "the pair of row 0 and column 1 is forbidden, and transport 'sinkhorn' gives every pair some mass; expected "
        "finite costs; choose transport 'exact', or a large cost");
}

TEST_CASE("a matrix of costs has no costs within measures") {
  TransportComparison sinkhorn = open_transport("sinkhorn", with_epsilon(1.0));
  const std::vector<double> weight{1.0}, cost{2.0};
  TransportResult result;
  CHECK(sinkhorn.compare(weight, weight, cost, result).text ==
        "transport 'sinkhorn' takes off the costs within each measure, and was given a matrix of costs between them "
        "alone; expected two measures; give them, or set debiased = false");
}
