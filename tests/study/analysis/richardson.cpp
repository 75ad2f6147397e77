#include "study/analysis/richardson.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using namespace bowstring::study;
using doctest::Approx;

std::vector<double> sequence(const std::vector<double>& n, double limit, double amount, double order) {
  std::vector<double> out;
  for (double x : n) out.push_back(limit + amount * std::pow(x, -order));
  return out;
}

TEST_CASE("the limit and order of a pure sequence, at even and uneven refinement, in any order") {
  for (const std::vector<double>& n : {std::vector<double>{20, 40, 80}, {160, 40, 60, 80}, {10, 37, 41}}) {
    for (double order : {0.5, 1.0, 2.0, 4.0}) {
      const Extrapolation out = extrapolate(n, sequence(n, 9.75, -30.0, order));
      REQUIRE_MESSAGE(out.ok(), out.refusal);
      CHECK(out.order == Approx(order).epsilon(1e-6));
      CHECK(out.limit == Approx(9.75).epsilon(1e-9));
      CHECK(out.error >= 0.0);
    }
  }
}

TEST_CASE("the error bounds what a second term of the error does") {
  std::vector<double> values;
  const std::vector<double> n{20, 40, 80, 160};
  for (double x : n) values.push_back(1.0 + 10.0 / (x * x) + 50.0 / (x * x * x));
  const Extrapolation four = extrapolate(n, values);
  REQUIRE(four.ok());
  CHECK(std::fabs(four.limit - 1.0) > 0.0);
  CHECK(std::fabs(four.limit - 1.0) < four.error);
  const Extrapolation three = extrapolate({n.begin() + 1, n.end()}, {values.begin() + 1, values.end()});
  CHECK(three.limit == four.limit);
  CHECK(three.error == Approx(std::fabs(three.limit - values.back())));
}

TEST_CASE("the published series of the planar case whose vessel has its whole stiffness") {
  const Extrapolation out = extrapolate({20, 40, 80, 160, 320, 640}, {9.4765, 9.6848, 9.7341, 9.7461, 9.7492, 9.7499});
  REQUIRE(out.ok());
  CHECK(out.order == Approx(std::log2(31.0 / 7.0)).epsilon(1e-6));
  CHECK(out.limit == Approx(9.7501).epsilon(1e-5));
}

TEST_CASE("values that are not there are left out") {
  const Extrapolation out = extrapolate({20, 40, 80, 160}, {1.0 + 1.0 / 20, 1.0 + 1.0 / 40, NAN, 1.0 + 1.0 / 160});
  REQUIRE(out.ok());
  CHECK(out.order == Approx(1.0));
}

TEST_CASE("equal finest values are the limit") {
  const Extrapolation out = extrapolate({1, 2, 4}, {3.0, 2.0, 2.0});
  REQUIRE(out.ok());
  CHECK(out.limit == 2.0);
  CHECK(std::isnan(out.order));
}

TEST_CASE("refusals say why") {
  CHECK(extrapolate({1, 2}, {1.0, 2.0}).refusal == "2 values: an extrapolation needs three");
  CHECK(extrapolate({1, 2, 2}, {1.0, 2.0, 3.0}).refusal == "two values at the same resolution, 2");
  CHECK(extrapolate({1, 2, 4}, {1.0, 2.0, 1.5}).refusal == "the three finest values, 1, 2, 1.5, are not monotone");
  CHECK(
      extrapolate({40, 80, 160}, {13.10, 9.97, 6.89}).refusal ==
      "the three finest values, 13.1, 9.97, 6.89, have order 0.023, outside 0.3…6: they do not settle as a refinement "
      "does");
  CHECK(extrapolate({1, 2, 4}, {1.0, 0.001, 0.0}).refusal.find("have order 10, outside") != std::string::npos);
}

}  // namespace
