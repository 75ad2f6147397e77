#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/lie/so3.hpp"
#include "tests/losses/transport/opened_transport.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

TransportComparison fused(double alpha, const Settings& more = {}) {
  Settings settings = {{"structure-weight", text(alpha)}};
  settings.insert(settings.end(), more.begin(), more.end());
  return open_transport("fused-gromov-wasserstein", settings);
}

double figure(const TransportAnswer& answer, const std::string& name) {
  for (const auto& [key, value] : answer.figures) {
    if (key == name) return value;
  }
  return -1.0;
}

Measure uniform_cloud(std::mt19937& random, std::size_t count) {
  Measure out = random_cloud(random, count);
  out.weight.assign(count, 1.0 / static_cast<double>(count));
  return out;
}

/// The same points turned, moved and in another order.
Measure moved_rigidly(const Measure& points) {
  const lie::Rotation turn = lie::exp(Vector3{0.7, -1.9, 0.4});
  Measure out;
  for (std::size_t i = points.count(); i-- > 0;) {
    double at[3];
    (turn * Vector3::load(&points.position[3 * i]) + Vector3{3.0, -1.0, 2.0}).store(at);
    out.position.insert(out.position.end(), at, at + 3);
    out.weight.push_back(points.weight[i]);
  }
  return out;
}

}  // namespace

TEST_CASE("two spaces of two points: (d1 - d2)^2 / 2") {
  for (const double first : {1e-6, 1.0, 3.0}) {
    for (const double second : {0.5, 1.0, 40.0}) {
      CAPTURE(first);
      CAPTURE(second);
      const Measure a{{0.0, 0.0, 0.0, first, 0.0, 0.0}, {}, {0.5, 0.5}};
      const Measure b{{9.0, 9.0, 9.0, 9.0, 9.0, 9.0 + second}, {}, {0.5, 0.5}};
      TransportComparison by_distance = fused(1.0), by_square = fused(1.0, {{"structure", "squared-distance"}});
      const double apart = first - second, squares = first * first - second * second;
      CHECK(compare(by_distance, a, b).answer.transport_cost > 1.0);
      CHECK(compare(by_distance, a, b).answer.value == doctest::Approx(0.5 * apart * apart).epsilon(1e-12));
      CHECK(compare(by_square, a, b).answer.value == doctest::Approx(0.5 * squares * squares).epsilon(1e-12));
    }
  }
}

TEST_CASE("without structure it is exact transport, with its derivatives") {
  std::mt19937 random(1);
  const Measure a = uniform_cloud(random, 12), b = uniform_cloud(random, 17);
  TransportComparison exact = open_transport("exact", {}), transport = fused(0.0);
  const TransportResult expected = compare(exact, a, b), found = compare(transport, a, b);
  CHECK(found.answer.value == doctest::Approx(expected.answer.value).epsilon(1e-13));
  CHECK(found.answer.transport_cost == doctest::Approx(found.answer.value).epsilon(1e-13));
  REQUIRE(squared_norm(expected.gradient_a.position) > 1e-6);
  for (std::size_t k = 0; k < found.gradient_a.position.size(); ++k) {
    CHECK(std::fabs(found.gradient_a.position[k] - expected.gradient_a.position[k]) <= 1e-13);
  }
}

TEST_CASE("a measure is at no distance from itself; shapes are at none wherever they lie") {
  std::mt19937 random(2);
  for (const std::size_t count : {1u, 2u, 6u, 20u}) {
    CAPTURE(count);
    const Measure cloud = uniform_cloud(random, count), elsewhere = moved_rigidly(cloud);
    TransportComparison both = fused(0.5), shape = fused(1.0, {{"starts", "50"}});
    CHECK(compare(both, cloud, cloud).answer.value <= 1e-16);
    const TransportAnswer answer = compare(shape, cloud, elsewhere).answer;
    CHECK(answer.value <= 1e-28);
    for (std::size_t k = 0; k < answer.plan.value.size(); ++k) {
      if (count > 2) CHECK(answer.plan.row[k] + answer.plan.column[k] == static_cast<int>(count) - 1);
    }
  }
}

TEST_CASE("what it says of its plan: stationary, in parts, with a value that more starts do not raise") {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Measure a = uniform_cloud(random, 4 + random() % 20), b = uniform_cloud(random, 4 + random() % 20);
    const double alpha = uniform(random);
    TransportComparison one = fused(alpha), many = fused(alpha, {{"starts", "8"}});
    const TransportAnswer answer = compare(one, a, b).answer, best = compare(many, a, b).answer;
    CHECK(answer.value ==
          doctest::Approx((1.0 - alpha) * answer.transport_cost + alpha * figure(answer, "structure_cost")));
    CHECK(figure(answer, "frank_wolfe_gap") <= 1e-9 * (answer.value + 1.0));
    CHECK(best.value <= answer.value * (1.0 + 1e-13));
    CHECK(figure(best, "starts_with_this_value") >= 1.0);
    CHECK(answer.plan.value.size() <= a.count() + b.count() - 1);
    CHECK_FALSE(answer.certified);
  }
}

TEST_CASE("the same input gives the same bits, whatever came before") {
  std::mt19937 random(4);
  const Measure a = uniform_cloud(random, 15), b = uniform_cloud(random, 15), c = uniform_cloud(random, 15);
  TransportComparison transport = fused(0.8, {{"starts", "4"}});
  const TransportAnswer first = compare(transport, a, b).answer;
  compare(transport, c, b);
  const TransportAnswer again = compare(transport, a, b).answer;
  CHECK_FALSE(again.warm);
  CHECK(first.value == again.value);
  CHECK(first.plan.value == again.plan.value);
  CHECK(first.dual_a == again.dual_a);
}

TEST_CASE("derivatives by places and weights, against differences") {
  std::mt19937 random(5);
  const Measure a = random_cloud(random, 8);
  Measure b = random_cloud(random, 6);
  double sum_a = 0.0, sum_b = 0.0;
  for (const double weight : a.weight) sum_a += weight;
  for (const double weight : b.weight) sum_b += weight;
  for (double& weight : b.weight) weight *= sum_a / sum_b;
  for (const double alpha : {0.0, 0.3, 1.0}) {
    for (const char* structure : {"distance", "squared-distance"}) {
      CAPTURE(alpha);
      CAPTURE(structure);
      TransportComparison transport = fused(alpha, {{"structure", structure}});
      check_place_gradients(transport, a, b, 1e-7);
      check_weight_gradients(transport, a, b, true, 1e-7);
    }
  }
}

TEST_CASE("with all weights the value grows as its parts do: the cost once, the structure twice") {
  std::mt19937 random(6);
  const Measure a = uniform_cloud(random, 9), b = uniform_cloud(random, 9);
  TransportComparison transport = fused(0.4);
  const TransportAnswer answer = compare(transport, a, b).answer;
  double along = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    along += a.weight[i] * answer.weight_gradient_a[i] + b.weight[i] * answer.weight_gradient_b[i];
  }
  CHECK(along == doctest::Approx(0.6 * answer.transport_cost + 2.0 * 0.4 * figure(answer, "structure_cost")));
}

TEST_CASE("places without mass change nothing") {
  std::mt19937 random(8);
  const Measure a = uniform_cloud(random, 7), b = uniform_cloud(random, 7);
  Measure more = a;
  more.position.insert(more.position.begin(), {0.3, 0.2, 5.0});
  more.weight.insert(more.weight.begin(), 0.0);
  TransportComparison transport = fused(0.5);
  const TransportAnswer without = compare(transport, a, b).answer, with = compare(transport, more, b).answer;
  CHECK(with.value == doctest::Approx(without.value).epsilon(1e-13));
  for (const int row : with.plan.row) CHECK(row != 0);
  CHECK(std::isfinite(with.weight_gradient_a[0]));
}

TEST_CASE("places on top of each other have a cone between them, which is counted") {
  std::mt19937 random(7);
  Measure a = uniform_cloud(random, 5);
  const Measure b = uniform_cloud(random, 5);
  std::copy(a.position.begin(), a.position.begin() + 3, a.position.begin() + 3);
  TransportComparison cone = fused(0.5), smooth = fused(0.5, {{"structure", "squared-distance"}});
  const TransportResult result = compare(cone, a, b);
  CHECK(figure(result.answer, "coincident_pairs") == 1.0);
  for (const double entry : result.gradient_a.position) CHECK(std::isfinite(entry));
  CHECK(figure(compare(smooth, a, b).answer, "coincident_pairs") == 0.0);
}
