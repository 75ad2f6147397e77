#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/model/component.hpp"
#include "core/transport/pair_costs.hpp"
#include "tests/losses/transport/opened_transport.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

/// Costs within two measures, which no points have, as a method gets them.
struct Spaces {
  std::vector<double> weight, between, within_a, within_b;

  explicit Spaces(std::mt19937& random, int count)
      : weight(static_cast<std::size_t>(count), 1.0 / count),
        between(random_numbers(random, weight.size() * weight.size(), 0.0, 1.0)),
        within_a(symmetric(random, count)),
        within_b(symmetric(random, count)) {}

  static std::vector<double> symmetric(std::mt19937& random, int count) {
    const auto size = static_cast<std::size_t>(count);
    std::vector<double> out(size * size, 0.0);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = i + 1; k < size; ++k) out[i * size + k] = out[k * size + i] = uniform(random);
    }
    return out;
  }
};

std::vector<double> squared_distances(const Measure& cloud) {
  std::vector<double> out;
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    for (std::size_t k = 0; k < cloud.count(); ++k) {
      double sum = 0.0;
      for (std::size_t e = 0; e < 3; ++e) {
        sum += std::pow(cloud.position[3 * i + e] - cloud.position[3 * k + e], 2);
      }
      out.push_back(sum);
    }
  }
  return out;
}

Status solve(Transport& method, Spaces& spaces, TransportAnswer& out) {
  const int count = static_cast<int>(spaces.weight.size());
  MatrixCosts between(spaces.between, count, count), within_a(spaces.within_a, count, count),
      within_b(spaces.within_b, count, count);
  TransportProblem problem;
  problem.weight_a = problem.weight_b = spaces.weight;
  problem.between = &between;
  problem.within_a = &within_a;
  problem.within_b = &within_b;
  return method.solve(problem, out);
}

Owned<Transport> method_of(const Settings& settings) {
  Status status;
  Owned<Transport> out =
      create<Transport>(open_transport("fused-gromov-wasserstein", settings).choice().method, status);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

}  // namespace

TEST_CASE("distances that no points have are taken too") {
  std::mt19937 random(1);
  Owned<Transport> method = method_of({{"structure-weight", "0.7"}});
  for (int repeat = 0; repeat < 20; ++repeat) {
    Spaces spaces(random, 10);
    TransportAnswer answer;
    const Status status = solve(*method, spaces, answer);
    REQUIRE_MESSAGE(status.ok(), status.text);
    CHECK(answer.gap <= 1e-9);
  }
}

TEST_CASE("where F is convex the plan is between vertices, and every start gives the least value") {
  std::mt19937 random(2);
  std::size_t least_size = 64;
  for (int repeat = 0; repeat < 5; ++repeat) {
    Spaces spaces(random, 8);
    spaces.within_a = squared_distances(random_cloud(random, 8));
    spaces.within_b = squared_distances(random_cloud(random, 8));
    for (double& cost : spaces.within_b) cost = -cost;  // as no distances are, but of the other curvature
    double value[3];
    for (const long starts : {1L, 2L, 3L}) {
      Owned<Transport> method = method_of({{"structure", "squared-distance"},
                                           {"structure-weight", "0.7"},
                                           {"starts", std::to_string(starts)},
                                           {"tolerance", "1e-12"}});
      TransportAnswer answer;
      const Status status = solve(*method, spaces, answer);
      REQUIRE_MESSAGE(status.ok(), status.text);
      value[starts - 1] = answer.value;
      CHECK(answer.gap <= 1e-11);
      least_size = std::min(least_size, answer.plan.value.size());
    }
    CHECK(value[1] == doctest::Approx(value[0]).epsilon(1e-11));
    CHECK(value[2] == doctest::Approx(value[0]).epsilon(1e-11));
  }
  CHECK(least_size > 8);  // what a vertex has
}

TEST_CASE("too few steps are a failure that says what to raise") {
  std::mt19937 random(3);
  Spaces spaces(random, 8);
  spaces.within_a = squared_distances(random_cloud(random, 8));
  spaces.within_b = squared_distances(random_cloud(random, 8));
  for (double& cost : spaces.within_b) cost = -cost;
  Owned<Transport> method = method_of({{"structure", "squared-distance"}, {"max-iterations", "1"}});
  TransportAnswer answer;
  const Status status = solve(*method, spaces, answer);
  CHECK(status.code == Code::failed);
  CHECK(status.text.find("raise max-iterations or tolerance") != std::string::npos);
}

TEST_CASE("a matrix of costs alone is refused, and settings out of their range") {
  TransportComparison transport = open_transport("fused-gromov-wasserstein", {});
  const std::vector<double> one = {1.0};
  TransportResult out;
  const Status status = transport.compare(one, one, std::vector<double>{1.0}, out);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text.find("give their places and a ground cost") != std::string::npos);
  CHECK(refusal_of("fused-gromov-wasserstein", {{"structure-weight", "1.5"}}).find("structure-weight") !=
        std::string::npos);
  CHECK(refusal_of("fused-gromov-wasserstein", {{"starts", "0"}}).find("starts") != std::string::npos);
  CHECK(refusal_of("fused-gromov-wasserstein", {{"structure", "angle"}}).find("squared-distance") != std::string::npos);
}
