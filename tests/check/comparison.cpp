#include "core/check/comparison.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "core/check/differences.hpp"

namespace bowstring::checking {

namespace {

/// One number f(t), whose derivative at 0 is claimed to be `value`.
Comparison compared(const std::function<double(double)>& f, double value, double size) {
  Claim claim{{value}, {size}, {1.0}, {0}};
  Comparison out(claim, 1e-6);
  for (const double step : {4e-3, 4e-4, 4e-5}) {
    std::vector<double> values[5];
    for (int k = 0; k < 5; ++k) values[k] = {f((k - 2) * step)};
    out.add(step, {&values[0], &values[1], &values[2], &values[3], &values[4]});
  }
  return out;
}

}  // namespace

TEST_CASE("differences of fourth order are exact for polynomials up to the fourth and the fifth degree") {
  const auto f = [](double t) { return 2.0 + t * (3.0 + t * (-1.0 + t * (4.0 + t * 5.0))); };
  CHECK(first_difference(f(-0.2), f(-0.1), f(0.1), f(0.2), 0.1) == doctest::Approx(3.0).epsilon(1e-14));
  CHECK(second_difference(f(-0.2), f(-0.1), f(0.0), f(0.1), f(0.2), 0.1) == doctest::Approx(-2.0).epsilon(1e-13));
}

TEST_CASE("a smooth function: its derivative agrees, a part in ten thousand off is wrong") {
  const auto f = [](double t) { return std::exp(2.0 * t); };
  const Comparison right = compared(f, 2.0, 2.0);
  CHECK(right.outcome(0) == Outcome::agrees);
  CHECK(right.settled());
  CHECK(right.error(0) < 1e-8);
  const Comparison wrong = compared(f, 2.0002, 2.0002);
  CHECK(wrong.outcome(0) == Outcome::wrong);
  CHECK(wrong.error(0) == doctest::Approx(1e-4).epsilon(0.01));
  CHECK_FALSE(right.vanishes());
}

TEST_CASE("a kink is told apart from a wrong derivative, whatever is claimed there") {
  for (const double claim : {0.0, 1.0, 3.0, 2.5}) {
    const auto f = [](double t) { return t > 0.0 ? 3.0 * t + t * t : t; };
    CAPTURE(claim);
    if (claim == 2.5) {
      CHECK(compared([](double t) { return 3.0 * t; }, claim, claim).outcome(0) == Outcome::wrong);
    }
    CHECK(compared(f, claim, claim).outcome(0) == Outcome::not_smooth);
  }
}

TEST_CASE("beside a kink of the second derivative the first one holds") {
  const auto f = [](double t) { return t > 0.0 ? 3.0 * t * t : t * t; };
  CHECK(compared(f, 0.0, 1.0).outcome(0) == Outcome::agrees);
  CHECK(compared(f, 0.1, 1.0).outcome(0) == Outcome::wrong);
}

TEST_CASE("a kink that lies beside the state is left behind by smaller steps") {
  const auto f = [](double t) { return t > 1e-3 ? 5.0 * t - 4e-3 : t; };
  CHECK(compared(f, 1.0, 1.0).outcome(0) == Outcome::agrees);
  CHECK(compared(f, 1.5, 1.5).outcome(0) == Outcome::wrong);
}

TEST_CASE("rounding of a large number is no error, and hides none that it could not explain") {
  const auto f = [](double t) { return 1e6 + t; };
  CHECK(compared(f, 1.0, 1.0).outcome(0) == Outcome::agrees);
  CHECK(compared(f, 1.001, 1.0).outcome(0) == Outcome::wrong);
}

TEST_CASE("what vanishes with its claim is known to vanish") {
  CHECK(compared([](double) { return 7.0; }, 0.0, 0.0).vanishes());
  const Comparison forgotten = compared([](double t) { return t; }, 0.0, 0.0);
  CHECK_FALSE(forgotten.vanishes());
  CHECK(forgotten.outcome(0) == Outcome::wrong);
  CHECK(forgotten.error(0) == doctest::Approx(1.0));
}

}  // namespace bowstring::checking
