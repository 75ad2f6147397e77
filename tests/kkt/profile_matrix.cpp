#include "core/kkt/profile_matrix.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

using kkt::PivotReport;
using kkt::ProfileMatrix;

/// A random symmetric matrix within a profile, with this much on its diagonal.
struct Sample {
  ProfileMatrix matrix;
  Eigen::MatrixXd dense;
};

Sample sample(int size, int band, unsigned seed, const std::vector<double>& diagonal) {
  Sample out;
  const std::vector<double> widths = random_numbers(size, seed), entries = random_numbers(size * size, seed + 100);
  std::vector<int> last(at(size));
  for (int c = 0; c < size; ++c) {
    last[at(c)] = std::min(size - 1, c + static_cast<int>(0.5 * (1.0 + widths[at(c)]) * band));
  }
  out.matrix.shape(last);
  out.dense = Eigen::MatrixXd::Zero(size, size);
  for (int c = 0; c < size; ++c) {
    for (int r = c; r <= last[at(c)]; ++r) {
      const double value = r == c ? diagonal[at(c)] : entries[at(r * size + c)];
      out.dense(r, c) = out.dense(c, r) = value;
      out.matrix.values()[at(out.matrix.index(r, c))] = value;
    }
  }
  return out;
}

void check_solution(Sample& s, double tolerance) {
  const int size = s.matrix.size();
  std::vector<double> x = random_numbers(size, 5);
  const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(x.data(), size);
  x.resize(at(size + ProfileMatrix::padding), 0.0);
  s.matrix.solve(x.data());
  const Eigen::VectorXd expected = s.dense.fullPivLu().solve(right);
  REQUIRE(expected.cwiseAbs().maxCoeff() > 1e-3);
  const double off = (Eigen::Map<const Eigen::VectorXd>(x.data(), size) - expected).cwiseAbs().maxCoeff();
  CHECK(off <= tolerance * expected.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("profile matrix: the profile never narrows, and what is outside of it is not stored") {
  ProfileMatrix matrix;
  matrix.shape({2, 1, 2, 3});
  CHECK(matrix.size() == 4);
  CHECK(matrix.last(1) == 2);
  CHECK(matrix.index(2, 1) == matrix.begin(1) + 1);
  CHECK(matrix.index(3, 1) == -1);
  CHECK(matrix.index(3, 3) == matrix.begin(3));
}

TEST_CASE("profile matrix: factors and inertia are those of dense algebra") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    const int size = 3 + 4 * static_cast<int>(seed), band = 2 + static_cast<int>(seed) % 9;
    // Diagonally dominant with either sign: every leading part is regular.
    const std::vector<double> signs = random_numbers(size, 40 + seed);
    std::vector<double> diagonal(at(size));
    for (int c = 0; c < size; ++c) diagonal[at(c)] = (signs[at(c)] > -0.4 ? 1.0 : -1.0) * (2.0 * band + 1.0);
    Sample s = sample(size, band, seed, diagonal);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(s.dense);
    const PivotReport report = s.matrix.factor();
    CHECK(report.vanishing == 0);
    CHECK(report.first_vanishing == -1);
    CHECK(report.negative == (eigen.eigenvalues().array() < 0.0).count());
    CHECK(report.growth < 2.0);
    check_solution(s, 1e-12);
  }
}

TEST_CASE("profile matrix: quasi-definite, whatever the order") {
  // (H Aᵀ; A −D), H and D positive: it has a factor in any order.
  const int size = 24;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const std::vector<double> signs = random_numbers(size, seed), entries = random_numbers(size * size, seed + 1);
    Sample s;
    s.matrix.shape(std::vector<int>(at(size), size - 1));
    s.dense = Eigen::MatrixXd::Zero(size, size);
    int rows = 0;
    for (int c = 0; c < size; ++c) {
      rows += signs[at(c)] < 0.0 ? 1 : 0;
      for (int r = c; r < size; ++r) {
        const bool both = (signs[at(r)] < 0.0) == (signs[at(c)] < 0.0);
        const double value = r == c ? (signs[at(c)] < 0.0 ? -1e-3 : 1.0) : (both ? 0.0 : entries[at(r * size + c)]);
        s.dense(r, c) = s.dense(c, r) = value;
        s.matrix.values()[at(s.matrix.index(r, c))] = value;
      }
    }
    REQUIRE(rows > 3);
    const PivotReport report = s.matrix.factor();
    CHECK(report.vanishing == 0);
    CHECK(report.negative == rows);
    check_solution(s, 1e-9);
  }
}

TEST_CASE("profile matrix: a pivot that only rounding decides is told, with its place") {
  // The third row is the sum of the first two.
  ProfileMatrix matrix;
  matrix.shape({2, 2, 2, 3});
  const double entries[4][4] = {{2.0, 0.3, 2.3, 0.0}, {0.3, 5.0, 5.3, 0.0}, {2.3, 5.3, 7.6, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  for (int c = 0; c < 4; ++c) {
    for (int r = c; r <= matrix.last(c); ++r) matrix.values()[at(matrix.index(r, c))] = entries[r][c];
  }
  const PivotReport report = matrix.factor();
  CHECK(report.vanishing == 1);
  CHECK(report.first_vanishing == 2);
}

TEST_CASE("profile matrix: growth tells a factor that is not to be trusted") {
  for (const double pivot : {1.0, 1e-4, 1e-8}) {
    CAPTURE(pivot);
    ProfileMatrix matrix;
    matrix.shape({1, 1});
    matrix.values()[at(matrix.index(0, 0))] = pivot;
    matrix.values()[at(matrix.index(1, 0))] = 1.0;
    matrix.values()[at(matrix.index(1, 1))] = 1.0;
    CHECK(matrix.factor().growth == doctest::Approx(1.0 / pivot).epsilon(1e-12));
  }
}

}  // namespace bowstring::testing
