#include "study/analysis/statistics.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using namespace bowstring::study;
using doctest::Approx;

TEST_CASE("Student's factor is the table's") {
  CHECK(student_factor(1) == Approx(12.706).epsilon(1e-4));
  CHECK(student_factor(4) == Approx(2.776).epsilon(1e-3));
  CHECK(std::isinf(student_factor(0)));
}

TEST_CASE("an interval of a mean") {
  const MeanInterval interval = mean_interval({1, 2, 3, 4, 5});
  CHECK(interval.mean == 3.0);
  CHECK(interval.high - interval.mean == Approx(2.7764 * std::sqrt(2.5 / 5.0)).epsilon(1e-4));
  CHECK(interval.mean - interval.low == Approx(interval.high - interval.mean));
  CHECK(std::isnan(mean_interval({1}).low));
  CHECK(mean_interval({1}).mean == 1.0);
  CHECK(std::isnan(mean_interval({}).mean));
}

TEST_CASE("quantiles are of type 7") {
  CHECK(quantile({1, 2, 3, 4}, 0.25) == 1.75);
  CHECK(quantile({1, 2, 3, 4}, 0.5) == 2.5);
  CHECK(quantile({7}, 0.95) == 7.0);
  CHECK(quantile({1, 2}, 1.0) == 2.0);
}

TEST_CASE("equal values share their rank") { CHECK(ranks({3, 1, 3, 2}) == std::vector<double>{3.5, 1, 3.5, 2}); }

TEST_CASE("a regression finds a plane, and refuses what does not tell its coefficients") {
  const std::vector<double> a{1, 2, 3, 4, 5, 6}, b{2, 1, 4, 3, 6, 9};
  std::vector<double> y;
  for (std::size_t i = 0; i < a.size(); ++i) y.push_back(5.0 + 2.0 * a[i] - 0.5 * b[i]);
  const Regression fit = regress({a, b}, y);
  REQUIRE(fit.coefficient.size() == 2);
  CHECK(fit.coefficient[0] == Approx(2.0));
  CHECK(fit.coefficient[1] == Approx(-0.5));
  CHECK(fit.r_squared == Approx(1.0));
  CHECK(regress({a, a}, y).coefficient.empty());
  CHECK(regress({a, {1, 1, 1, 1, 1, 1}}, y).coefficient.empty());
  CHECK(regress({a, b}, {1, 1, 1, 1, 1, 1}).coefficient.empty());
  CHECK(regress({{1, 2}}, {1, 2}).coefficient.empty());
}

}  // namespace
