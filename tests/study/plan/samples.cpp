#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "study/plan/samples.hpp"

namespace bowstring::study {
namespace {

std::vector<double> coordinate(const std::vector<double>& points, int dimension, int k) {
  std::vector<double> out;
  for (std::size_t i = static_cast<std::size_t>(k); i < points.size(); i += static_cast<std::size_t>(dimension)) {
    out.push_back(points[i]);
  }
  return out;
}

/// The number of points in each of `cells` equal strata.
std::vector<int> strata(const std::vector<double>& values, int cells) {
  std::vector<int> out(static_cast<std::size_t>(cells), 0);
  for (const double value : values) ++out[static_cast<std::size_t>(value * cells)];
  return out;
}

}  // namespace

TEST_CASE("a Sobol sample is balanced in every coordinate and in pairs of them, shifted or not") {
  for (const std::uint64_t seed : {0, 1, 2024}) {
    const int count = 64, dimension = 5;
    const std::vector<double> points = sobol_points(count, dimension, seed);
    REQUIRE(points.size() == static_cast<std::size_t>(count * dimension));
    CHECK(*std::min_element(points.begin(), points.end()) > 0.0);
    CHECK(*std::max_element(points.begin(), points.end()) < 1.0);
    for (int k = 0; k < dimension; ++k) {
      CHECK(strata(coordinate(points, dimension, k), count) == std::vector<int>(64, 1));
    }
    std::vector<int> cells(64, 0);  // the first two: a (0, m, 2)-net, one point in each of 8 × 8 cells
    for (int i = 0; i < count; ++i) {
      const double x = points[static_cast<std::size_t>(i * dimension)];
      const double y = points[static_cast<std::size_t>(i * dimension + 1)];
      ++cells[static_cast<std::size_t>(8 * static_cast<int>(8 * x) + static_cast<int>(8 * y))];
    }
    CHECK(cells == std::vector<int>(64, 1));
  }
  CHECK(sobol_points(8, 3, 1) != sobol_points(8, 3, 2));
  CHECK(sobol_points(8, 3, 1) == sobol_points(8, 3, 1));
}

TEST_CASE("a Latin hypercube has one point in every stratum") {
  for (const int count : {1, 7, 100}) {
    const std::vector<double> points = latin_hypercube_points(count, 3, 5);
    for (int k = 0; k < 3; ++k) {
      CHECK(strata(coordinate(points, 3, k), count) == std::vector<int>(static_cast<std::size_t>(count), 1));
    }
  }
  CHECK(latin_hypercube_points(9, 2, 1) != latin_hypercube_points(9, 2, 2));
}

TEST_CASE("samples have the bits that they had") {
  CHECK(sobol_points(2, 1, 1) == std::vector<double>{sobol_points(4, 1, 1)[0], sobol_points(4, 1, 1)[1]});
  const std::vector<double> point = latin_hypercube_points(1, 1, 1);
  // The second word of mt19937_64 seeded with 1 is drawn after no swap: the first is 2469588189546311528.
  CHECK(point[0] == (static_cast<double>(2469588189546311528ULL >> 11) + 0.5) / 9007199254740992.0);
}

}  // namespace bowstring::study
