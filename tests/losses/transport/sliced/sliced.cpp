#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "tests/losses/transport/opened_transport.hpp"

using namespace bowstring;
using namespace bowstring::testing;

TEST_CASE("a shift by t has |t|^2/3, exactly with lines in threes") {
  TransportComparison sliced = open_transport("sliced");
  const Measure cloud = probability_cloud(17, 1);
  CHECK(value_of(sliced, cloud, cloud) == 0.0);
  CHECK(value_of(sliced, shifted(cloud, 1.0, -2.0, 2.0), cloud) == doctest::Approx(3.0).epsilon(1e-13));
  TransportComparison many = open_transport("sliced", {{"directions", "20000"}});
  CHECK(value_of(many, shifted(cloud, 1.0, -2.0, 2.0), cloud) == doctest::Approx(3.0).epsilon(1e-3));
}

TEST_CASE("points on a line are matched in their order") {
  // On a line through the points, and others, each projection is the same plan seen under an angle: mean of cos² = 1/3.
  TransportComparison sliced = open_transport("sliced");
  const Measure a{{0, 0, 0, 1, 0, 0, 5, 0, 0}, {}, {0.25, 0.5, 0.25}}, b{{2, 0, 0, 3, 0, 0}, {}, {0.5, 0.5}};
  const double exact = 0.25 * 4 + 0.25 * 1 + 0.25 * 4 + 0.25 * 4;
  CHECK(value_of(sliced, a, b) == doctest::Approx(exact / 3.0).epsilon(1e-13));
}

TEST_CASE("value, plan, potentials and derivatives belong together") {
  TransportComparison sliced = open_transport("sliced", {{"directions", "9"}, {"seed", "4"}});
  const Measure a = probability_cloud(7, 2), b = shifted(probability_cloud(5, 3), 0.7, 0.2, -0.3);
  const TransportResult result = compare(sliced, a, b);
  std::vector<double> rows(7, 0.0), columns(5, 0.0);
  for (std::size_t k = 0; k < result.answer.plan.value.size(); ++k) {
    rows[static_cast<std::size_t>(result.answer.plan.row[k])] += result.answer.plan.value[k];
    columns[static_cast<std::size_t>(result.answer.plan.column[k])] += result.answer.plan.value[k];
  }
  for (std::size_t i = 0; i < 7; ++i) CHECK(rows[i] == doctest::Approx(a.weight[i]).epsilon(1e-13));
  for (std::size_t j = 0; j < 5; ++j) CHECK(columns[j] == doctest::Approx(b.weight[j]).epsilon(1e-13));
  CHECK(std::fabs(result.answer.gap) < 1e-14);
  CHECK_FALSE(result.answer.certified);
  CHECK(result.answer.transport_cost >= 3.0 * result.answer.value * 0.999);
  check_place_gradients(sliced, a, b, 1e-7);
  check_weight_gradients(sliced, a, b, true, 1e-7);
}

TEST_CASE("places without weight, one place, many on one point") {
  TransportComparison sliced = open_transport("sliced");
  const Measure a{{0, 0, 0, 9, 9, 9}, {}, {1, 0}}, b{{3, 0, 0, 3, 0, 0, 3, 0, 0}, {}, {0.2, 0.3, 0.5}};
  const TransportResult result = compare(sliced, a, b);
  CHECK(result.answer.value == doctest::Approx(3.0).epsilon(1e-14));
  CHECK(result.answer.dual_a.size() == 2);
  CHECK(result.gradient_a.position[3] == 0.0);
}

TEST_CASE("the same seed gives the same lines, another gives others") {
  const Measure a = probability_cloud(6, 5), b = probability_cloud(6, 6);
  TransportComparison one = open_transport("sliced"), same = open_transport("sliced"),
                      other = open_transport("sliced", {{"seed", "2"}});
  CHECK(value_of(one, a, b) == value_of(same, a, b));
  CHECK(value_of(one, a, b) != value_of(other, a, b));
}

TEST_CASE("what it cannot project") {
  TransportComparison sliced = open_transport("sliced");
  TransportResult result;
  const std::vector<double> weight{1.0}, cost{2.0};
  const Status status = sliced.compare(weight, weight, cost, result);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text ==
        "transport 'sliced' projects points on lines, and was given a matrix of costs; expected two measures with "
        "ground cost 'euclidean'; choose it, or transport 'exact'");
}
