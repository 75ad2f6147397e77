#include <doctest/doctest.h>

#include "tests/losses/transport/unbalanced/problems.hpp"

using namespace bowstring;
using namespace bowstring::testing;

TEST_CASE("derivatives by places and weights, against differences") {
  std::mt19937 random(1);
  const Measure a = random_cloud(random, 7), b = random_cloud(random, 9);
  for (const double rho : {0.05, 0.5, 20.0}) {
    for (const double epsilon : {0.0, 0.02, 0.5}) {
      CAPTURE(rho);
      CAPTURE(epsilon);
      TransportComparison transport = unbalanced("kl", rho, epsilon);
      check_place_gradients(transport, a, b, 1e-7);
      check_weight_gradients(transport, a, b, false, 1e-7);
    }
    CAPTURE(rho);
    TransportComparison transport = unbalanced("total-variation", rho);
    const TransportAnswer at = compare(transport, a, b).answer;
    REQUIRE_FALSE(at.multiple);
    REQUIRE(at.slack > 1e-3);
    check_place_gradients(transport, a, b, 1e-8);
    check_weight_gradients(transport, a, b, false, 1e-8);
  }
}

TEST_CASE("of frames the derivative is in the body, and the same in space") {
  std::mt19937 random(2);
  const Measure points = random_cloud(random, 6), b = random_cloud(random, 5), frames = with_frames(random, points);
  TransportComparison transport = unbalanced("kl", 0.3);
  const TransportResult of_points = compare(transport, points, b), of_frames = compare(transport, frames, b);
  REQUIRE(squared_norm(of_points.gradient_a.position) > 1e-3);
  CHECK(of_frames.gradient_a.frame.size() == 36);
  for (std::size_t k = 0; k < 18; ++k) {
    CHECK(of_frames.gradient_a.position[k] == doctest::Approx(of_points.gradient_a.position[k]).epsilon(1e-13));
  }
}
