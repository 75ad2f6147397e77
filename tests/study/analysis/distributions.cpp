#include "study/analysis/distributions.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using doctest::Approx;

TEST_CASE("the shares of a linear function of independent parameters") {
  StudyData data = sample_of_two(40, {"q_mm"});  // too few for squares
  fill(data, 0, [](const StudyData& d, const RunData& run) { return 2.0 * number(d, run, 0) + number(d, run, 1); });
  const std::vector<Distribution> all = find_distributions(data);
  REQUIRE(all.size() == 1);
  CHECK(all[0].count == 40);
  REQUIRE(all[0].shares.size() == 2);
  CHECK(all[0].shares[0] == Approx(0.8).epsilon(0.05));
  CHECK(all[0].shares[1] == Approx(0.2).epsilon(0.15));
  CHECK(all[0].r_squared == Approx(1.0));
  CHECK(all[0].note.empty());
}

TEST_CASE("the shares of an additive function with squares are its Sobol' indices") {
  StudyData data = sample_of_two(1024, {"q_mm"});
  fill(data, 0, [](const StudyData& d, const RunData& run) {
    const double x = number(d, run, 0) - 2.0, y = number(d, run, 1) - 3.0;  // both uniform on −1 … 1
    return x + 2.0 * y * y;
  });
  const Distribution d = find_distributions(data).at(0);
  const double linear = 1.0 / 3.0, square = 4.0 * 4.0 / 45.0;
  REQUIRE(d.shares.size() == 2);
  CHECK(d.shares[0] == Approx(linear / (linear + square)).epsilon(0.02));
  CHECK(d.shares[1] == Approx(square / (linear + square)).epsilon(0.02));
  CHECK(d.r_squared == Approx(1.0));
}

TEST_CASE("moments and quantiles, failed runs counted apart") {
  StudyData data = sample_of_two(6, {"q_mm"});
  data.quantities[0].value = {5, 1, 3, 2, 4, 100};
  fail(data, 5);
  const Distribution d = find_distributions(data).at(0);
  CHECK(d.count == 5);
  CHECK(d.left_out == 1);
  CHECK(d.mean == 3.0);
  CHECK(d.deviation == Approx(std::sqrt(2.5)));
  CHECK(d.quantiles == std::array<double, 5>{1.2, 2.0, 3.0, 4.0, 4.8});
}

TEST_CASE("shares that do not add up say so") {
  StudyData data = sample_of_two(200, {"q_mm"});
  fill(data, 0,
       [](const StudyData& d, const RunData& run) { return (number(d, run, 0) - 2.0) * (number(d, run, 1) - 3.0); });
  const Distribution d = find_distributions(data).at(0);
  CHECK(d.r_squared < 0.1);
  CHECK(d.note.find("the shares do not add up") != std::string::npos);
}

TEST_CASE("a steep monotone function has shares of its ranks") {
  StudyData data = sample_of_two(200, {"q_mm"});
  fill(data, 0, [](const StudyData& d, const RunData& run) { return std::exp(20.0 * number(d, run, 0)); });
  const Distribution d = find_distributions(data).at(0);
  CHECK(d.note.rfind("shares of the variance of the ranks", 0) == 0);
  CHECK(d.r_squared == Approx(1.0));
  CHECK(d.shares[0] == Approx(1.0));
}

TEST_CASE("a distribution for each alternative of the other axes; none without a sample") {
  StudyData data = sample_of_two(8, {"q_mm"});
  data.axes.insert(data.axes.begin(), words_axis("contact", {"a", "b"}));
  data.runs.clear();
  data.quantities[0].value.clear();
  add_product(data);
  CHECK(data.runs.size() == 16);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return run.choice[0] + number(d, run, 1); });
  const std::vector<Distribution> all = find_distributions(data);
  REQUIRE(all.size() == 2);
  CHECK(all[1].label == "b");
  CHECK(all[1].mean == Approx(all[0].mean + 1.0));
  CHECK(find_distributions(anchoring_study()).empty());
}

}  // namespace
