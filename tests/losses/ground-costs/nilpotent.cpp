#include <doctest/doctest.h>

#include <cmath>

#include "frames.hpp"
#include "losses/ground-costs/geodesics/nilpotent_cost.hpp"
#include "losses/ground-costs/geodesics/nilpotent_distance.hpp"

using namespace ground_cost_test;
using namespace bowstring::geodesics;

namespace {

constexpr double pi = 3.14159265358979323846;

double dual_value(const NilpotentOffset& o, const Vector2& l) {
  const double t = 0.5 * norm(l), q = (1.0 - t / std::tan(t)) / (t * t), s = o.forward;
  return s * s + norm_squared(o.bend) + 2.0 * dot(l, o.lateral) -
         0.25 * q * (s * s * norm_squared(l) + dot(o.bend, l) * dot(o.bend, l));
}

NilpotentOffset random_offset(Random& random) {
  return {random.normal(), {{random.normal(), random.normal()}}, {{random.normal(), random.normal()}}};
}

}  // namespace

TEST_CASE("The dual maximum is above every value of the dual, and reached") {
  Random random(21);
  for (int k = 0; k < repeats(5, 100, 2000); ++k) {
    const NilpotentOffset offset = random_offset(random);
    const NilpotentSolution solution = nilpotent_distance(offset);
    CHECK(norm(solution.dual) < 2.0 * pi);
    CHECK(solution.squared == doctest::Approx(dual_value(offset, solution.dual)).epsilon(1e-12));
    for (int i = 0; i < 30; ++i) {
      const double radius = 2.0 * pi * std::sqrt(random.uniform()) * 0.9999, angle = 2.0 * pi * random.uniform();
      const Vector2 dual{{radius * std::cos(angle), radius * std::sin(angle)}};
      CHECK(dual_value(offset, dual) <= solution.squared * (1.0 + 1e-13));
    }
    CHECK(solution.squared <= offset.forward * offset.forward + norm_squared(offset.bend) +
                                  4.0 * pi * norm(offset.lateral) * (1.0 + 1e-13));
  }
}

TEST_CASE("The dual maximum is found in few steps from the middle to the edge of the disc") {
  Random random(22);
  for (int k = 0; k < repeats(100, 20000, 200000); ++k) {
    NilpotentOffset offset = random_offset(random);
    offset.forward *= std::pow(10.0, 15.0 * random.uniform() - 12.0);
    offset.bend *= std::pow(10.0, 15.0 * random.uniform() - 12.0);
    offset.lateral *= std::pow(10.0, 15.0 * random.uniform() - 12.0);
    const NilpotentSolution solution = nilpotent_distance(offset);
    REQUIRE(std::isfinite(solution.squared));
    CHECK(solution.iterations <= 20);
    CHECK(solution.squared >= (offset.forward * offset.forward + norm_squared(offset.bend)) * (1.0 - 1e-14));
  }
}

TEST_CASE("It scales by dilation, and derivatives are those of differences down to pure lateral motion") {
  Random random(23);
  for (int k = 0; k < repeats(3, 40, 400); ++k) {
    NilpotentOffset offset = random_offset(random);
    const double small = k % 4 == 0 ? 1.0 : std::pow(10.0, -2.0 * (k % 4));
    offset.forward *= small;
    offset.bend *= small;
    const NilpotentSolution solution = nilpotent_distance(offset);
    const NilpotentOffset larger{3.0 * offset.forward, 3.0 * offset.bend, 9.0 * offset.lateral};
    CHECK(nilpotent_distance(larger).squared == doctest::Approx(9.0 * solution.squared).epsilon(1e-13));

    const double h = 1e-3 * small;
    const auto along = [&](const auto& move, double step) {
      const auto at = [&](double share) {
        NilpotentOffset moved = offset;
        move(moved, share * step);
        return nilpotent_distance(moved).squared;
      };
      return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
    };
    const double scale = std::fabs(solution.by_forward) + norm(solution.by_bend);
    if (std::fabs(offset.forward) < 0.1 * small) continue;
    REQUIRE(scale > 0.0);
    const double by_forward = along([](NilpotentOffset& o, double x) { o.forward += x; }, h);
    CHECK(std::fabs(by_forward - solution.by_forward) < 1e-5 * scale);
    for (int i = 0; i < 2; ++i) {
      const double by_bend = along([i](NilpotentOffset& o, double x) { o.bend[i] += x; }, h);
      CHECK(std::fabs(by_bend - solution.by_bend[i]) < 1e-5 * scale);
      const double by_lateral = along([i](NilpotentOffset& o, double x) { o.lateral[i] += x; }, 1e-4);
      CHECK(by_lateral == doctest::Approx(2.0 * solution.dual[i]).epsilon(1e-6));
    }
  }
}

TEST_CASE("Pure lateral motion is exact, and its derivatives are limits") {
  for (const double lateral : {1e-12, 1e-3, 1.0, 50.0}) {
    const NilpotentSolution solution = nilpotent_distance({0.0, {}, {{0.6 * lateral, -0.8 * lateral}}});
    CHECK(solution.squared == doctest::Approx(4.0 * pi * lateral).epsilon(1e-15));
    CHECK(2.0 * solution.dual[0] == doctest::Approx(4.0 * pi * 0.6).epsilon(1e-12));
    CHECK(solution.by_forward == doctest::Approx(-2.0 * std::sqrt(4.0 * pi * lateral)).epsilon(1e-9));
  }
}

TEST_CASE("A stop at what is enough leaves a certain bound") {
  Random random(24);
  for (int k = 0; k < 200; ++k) {
    const NilpotentOffset offset = random_offset(random);
    const double exact = nilpotent_distance(offset).squared;
    const double stopped = nilpotent_distance(offset, 0.8 * exact).squared;
    CHECK(stopped > 0.8 * exact);
    CHECK(stopped <= exact * (1.0 + 1e-14));
  }
}
