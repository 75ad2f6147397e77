#include <doctest/doctest.h>

#include <cmath>

#include "frames.hpp"

using namespace ground_cost_test;
namespace se3 = bowstring::lie::se3;

TEST_CASE("The sub-Riemannian distance satisfies the triangle inequality") {
  const OpenCost cost("se3-subriemannian");
  Random random(31);
  double tightest = 0.0;
  for (int k = 0; k < repeats(5, 300, 10000); ++k) {
    const double size = 0.1 + random.uniform();
    const Se3 g, h = se3::exp(random.dilated(size)), f = h * se3::exp(random.dilated(size));
    const double sides = std::sqrt(cost(g, h)) + std::sqrt(cost(h, f)), direct = std::sqrt(cost(g, f));
    CHECK(direct <= sides * (1.0 + 1e-9));
    tightest = std::max(tightest, direct / sides);
  }
  CHECK(tightest > 0.5);
}

TEST_CASE("The nilpotent approximation is no metric") {
  const OpenCost nilpotent("se3-nilpotent"), exact("se3-subriemannian");
  const Se3 g, h = se3::exp({{-1.3, -1.8, 0.4, -1.8, -0.2, -1.8}}),
               f = h * se3::exp({{-0.5, 0.8, 1.4, -0.7, 1.0, -0.4}});
  const auto excess = [&](const OpenCost& cost) {
    return std::sqrt(cost(g, f)) - std::sqrt(cost(g, h)) - std::sqrt(cost(h, f));
  };
  CHECK(excess(nilpotent) == doctest::Approx(1.13914).epsilon(1e-4));
  CHECK(excess(exact) < 0.0);
}
