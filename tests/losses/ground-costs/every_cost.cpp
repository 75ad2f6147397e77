#include <doctest/doctest.h>

#include <cmath>

#include "frames.hpp"

using namespace ground_cost_test;
namespace se3 = bowstring::lie::se3;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Each cost with equal weights, and with weights that are all different.
const std::vector<std::pair<const char*, std::vector<std::pair<std::string, std::string>>>>& costs() {
  static const std::vector<std::pair<const char*, std::vector<std::pair<std::string, std::string>>>> out{
      {"euclidean", {}},
      {"se3-riemannian", {}},
      {"se3-riemannian",
       {{"forward-weight", "\"0.5 1/mm\""},
        {"lateral-weight", "\"2 1/mm\""},
        {"bend-weight", "1.5"},
        {"roll-weight", "1.2"}}},
      {"se3-nilpotent", {}},
      {"se3-nilpotent", {{"forward-weight", "\"0.5 1/mm\""}, {"bend-weight", "1.5"}, {"roll-weight", "1.2"}}},
      {"se3-subriemannian", {}},
      {"se3-subriemannian", {{"forward-weight", "\"0.5 1/mm\""}, {"bend-weight", "1.5"}, {"roll-weight", "1.2"}}},
  };
  return out;
}

/// Pairs of all kinds: near, far, and turned by nearly half a turn.
std::vector<Se3> offsets(Random& random, int count) {
  std::vector<Se3> out;
  for (int k = 0; k < count; ++k) {
    out.push_back(se3::exp(random.dilated(0.3)));
    out.push_back(se3::exp(random.dilated(0.8)));
    out.push_back({random.frame(1.0).rotation, 20.0 * random.frame(1.0).position});
    const Vector3 axis = normalized(Vector3{{random.normal(), random.normal(), random.normal()}});
    out.push_back({lie::exp((pi - 0.02) * axis), random.frame(1.0).position});
  }
  return out;
}

/// The difference quotient of fourth order along each body axis of g, steps of `step` with lateral motion `lateral`.
Vector<6> differences(const OpenCost& cost, const Se3& g, const Se3& h, double step, double lateral) {
  Vector<6> out;
  for (int k = 0; k < 6; ++k) {
    const double length = k < 4 ? step : lateral;
    const auto at = [&](double share) { return cost(g * se3::exp(share * length * Twist::unit(k)), h); };
    out[k] = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * length);
  }
  return out;
}

}  // namespace

TEST_CASE("A motion of both frames changes nothing, nor does their order") {
  for (const auto& [name, settings] : costs()) {
    CAPTURE(name);
    const OpenCost cost(name, settings);
    Random random(1);
    for (const Se3& offset : offsets(random, repeats(1, 6, 60))) {
      const Se3 g = random.frame(0.5), motion = random.frame(0.5), h = g * offset;
      const double value = cost(g, h);
      REQUIRE(value > 0.0);
      CHECK(cost(motion * g, motion * h) == doctest::Approx(value).epsilon(1e-12));
      CHECK(cost(h, g) == doctest::Approx(value).epsilon(1e-12));
    }
  }
}

TEST_CASE("Gradients are those of differences") {
  int pairs = 0, jumps = 0;
  for (const auto& [name, settings] : costs()) {
    CAPTURE(name);
    const OpenCost cost(name, settings);
    Random random(2);
    for (const Se3& offset : offsets(random, repeats(1, 4, 40))) {
      const Se3 g = random.frame(1.0), h = g * offset;
      const Vector<6> gradient = cost.gradient(g, h);
      REQUIRE(norm(gradient) > 1e-3);
      const Vector<6> expected = differences(cost, g, h, 2e-4, 2e-4);
      ++pairs;
      if (norm(expected) > 2.0 * norm(gradient)) {
        ++jumps;
      } else {
        CHECK(norm(expected - gradient) < 1e-6 * norm(gradient));
      }
    }
  }
  // A search that misses the shortest geodesic on one side of a pair makes the value jump: 2 pairs of the whole grid.
  CHECK(200 * jumps <= pairs);
}

TEST_CASE("Gradients of offsets of 1e-8 are those of differences") {
  for (const auto& [name, settings] : costs()) {
    CAPTURE(name);
    const OpenCost cost(name, settings);
    const bool squares = std::string(name) == "euclidean" || std::string(name) == "se3-riemannian";
    Random random(3);
    for (int k = 0; k < repeats(1, 4, 20); ++k) {
      const Se3 g, h = se3::exp(squares ? 1e-8 * random.twist() : random.dilated(1e-8));
      const Vector<6> gradient = cost.gradient(g, h);
      const Vector<6> expected = differences(cost, g, h, 1e-11, squares ? 1e-11 : 1e-19);
      REQUIRE(norm(gradient) > 1e-9);
      for (int i = 0; i < 6; ++i) {
        CHECK(std::fabs(gradient[i] - expected[i]) <
              1e-4 * std::fabs(gradient[i]) + 1e-6 * (i < 4 || squares ? 1e-8 : 1.0));
      }
    }
  }
}

TEST_CASE("Equal frames cost nothing and pull nowhere") {
  for (const auto& [name, settings] : costs()) {
    const OpenCost cost(name, settings);
    Random random(4);
    const Se3 g = random.frame(3.0);
    CHECK(cost(Se3(), Se3()) == 0.0);
    CHECK(norm(cost.gradient(Se3(), Se3())) == 0.0);
    CHECK(cost(g, g) < 1e-14);
  }
}

TEST_CASE("Pure forward motion and pure turns are exact, and lateral motion costs more") {
  for (const char* name : {"se3-riemannian", "se3-nilpotent", "se3-subriemannian"}) {
    CAPTURE(name);
    std::vector<std::pair<std::string, std::string>> settings{
        {"forward-weight", "\"0.1 1/mm\""}, {"bend-weight", "2"}, {"roll-weight", "1.5"}};
    if (std::string(name) == "se3-riemannian") settings.push_back({"lateral-weight", "\"0.4 1/mm\""});
    const OpenCost cost(name, settings);
    for (const double length : {1e-12, 1e-8, 1e-3, 1.0, 5.0, 50.0, 700.0}) {
      CAPTURE(length);
      const double forward = cost(Se3(), {{}, {{length, 0.0, 0.0}}});
      CHECK(forward == doctest::Approx(0.01 * length * length).epsilon(1e-11));
      CHECK(cost(Se3(), {{}, {{-length, 0.0, 0.0}}}) == doctest::Approx(forward).epsilon(1e-11));
      const double lateral = cost(Se3(), {{}, {{0.0, 0.6 * length, 0.8 * length}}});
      CHECK(std::isfinite(lateral));
      // Both costs of the nilpotent approximation are 4π w₁β l and (w₁l)²: what holds nearby ends at l = 4πβ/w₁.
      const bool nearby = length < 80.0 * pi;
      if (nearby || std::string(name) != "se3-nilpotent") CHECK(lateral > forward);
    }
    for (const double angle : {1e-12, 1e-8, 0.1, 1.0, 3.0, pi}) {
      CAPTURE(angle);
      const double bend = cost(Se3(), {lie::exp(Vector3{{0.0, 0.0, angle}}), {}});
      const double roll = cost(Se3(), {lie::exp(Vector3{{angle, 0.0, 0.0}}), {}});
      // The quaternion of half a turn is the same to rounding from both sides.
      CHECK(bend == doctest::Approx(4.0 * angle * angle).epsilon(1e-11));
      CHECK(roll == doctest::Approx(2.25 * angle * angle).epsilon(1e-11));
    }
  }
}

TEST_CASE("A frame turned by half a turn has one cost, whatever the sign of its quaternion") {
  for (const char* name : {"se3-riemannian", "se3-nilpotent", "se3-subriemannian"}) {
    CAPTURE(name);
    const OpenCost cost(name);
    Random random(5);
    for (int k = 0; k < repeats(1, 5, 50); ++k) {
      const Vector3 axis = normalized(Vector3{{random.normal(), random.normal(), random.normal()}});
      const Vector3 place = random.frame(1.0).position;
      const Se3 h{{0.0, axis[0], axis[1], axis[2]}, place}, other{{-0.0, -axis[0], -axis[1], -axis[2]}, place};
      const double value = cost(Se3(), h);
      CHECK(value >= 0.999 * pi * pi);
      CHECK(std::fabs(cost(Se3(), other) - value) < 1e-12 * value);
      // and it is continuous there
      for (const double beside : {-1e-9, 1e-9}) {
        CHECK(cost(Se3(), {lie::exp((pi + beside) * axis), place}) == doctest::Approx(value).epsilon(1e-7));
      }
    }
  }
}

TEST_CASE("Rows are evaluations, and bounds lie below them") {
  for (const auto& [name, settings] : costs()) {
    CAPTURE(name);
    const OpenCost cost(name, settings);
    Random random(6);
    std::vector<Se3> first, second;
    const int count = repeats(2, 6, 20);
    for (int k = 0; k < count; ++k) {
      first.push_back(se3::exp(random.dilated(0.7)));
      second.push_back(se3::exp(random.dilated(0.7)));
    }
    const Measure a = measure_of(first), b = measure_of(second);
    const auto columns = static_cast<std::size_t>(count);
    std::vector<double> value((columns - 1) * columns), lower(value.size());
    REQUIRE(cost->rows(a, b, 1, count, value).ok());
    const bool bounds = cost->dear();
    if (bounds) REQUIRE(cost->lower_bounds(a, b, 1, count, lower).ok());
    for (std::size_t i = 1; i < columns; ++i) {
      for (std::size_t j = 0; j < columns; ++j) {
        CHECK(value[(i - 1) * columns + j] == cost(first[i], second[j]));
        if (!bounds) continue;
        CHECK(lower[(i - 1) * columns + j] <= value[(i - 1) * columns + j]);
        CHECK(lower[(i - 1) * columns + j] > 0.0);
      }
    }
  }
}

TEST_CASE("Settings carry their units") {
  const OpenCost by_mm("se3-riemannian", {{"forward-weight", "0.1 1/mm"}, {"lateral-weight", "\"0.1 1/mm\""}});
  const OpenCost by_cm("se3-riemannian", {{"forward-weight", "\"1 1/cm\""}, {"lateral-weight", "\"1 1/cm\""}});
  const Se3 h = se3::exp(Twist{{0.3, 0.1, 0.2, 5.0, 2.0, 1.0}});
  const double expected = 0.01 * norm_squared(h.position) + 0.14;
  CHECK(by_mm(Se3(), h) == doctest::Approx(expected).epsilon(1e-13));
  CHECK(by_cm(Se3(), h) == doctest::Approx(expected).epsilon(1e-13));
}
