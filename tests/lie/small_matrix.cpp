#include "core/lie/small_matrix.hpp"

#include <doctest/doctest.h>

namespace bowstring {
namespace {

static_assert(dot(Vector3{{1, 2, 3}}, Vector3{{4, 5, 6}}) == 32.0);
static_assert(cross(Vector3{{1, 0, 0}}, Vector3{{0, 1, 0}}) == Vector3{{0, 0, 1}});
static_assert(cross(Vector2{{1, 0}}, Vector2{{0, 1}}) == 1.0);

TEST_CASE("vectors add, scale, load and store") {
  const double numbers[3] = {3.0, 0.0, -4.0};
  const Vector3 v = Vector3::load(numbers);
  CHECK(norm(v) == 5.0);
  CHECK(2 * v - v / 2 == Vector3{{4.5, 0.0, -6.0}});
  CHECK(normalized(v) == Vector3{{0.6, 0.0, -0.8}});
  double stored[3];
  (-v).store(stored);
  CHECK(Vector3::load(stored) == Vector3{{-3.0, 0.0, 4.0}});
}

TEST_CASE("a matrix is stored row by row") {
  const Matrix<2, 3> m{{1, 2, 3, 4, 5, 6}};
  CHECK(m(0, 2) == 3.0);
  CHECK(m.row(1) == Vector3{{4, 5, 6}});
  CHECK(m.column(1) == Vector2{{2, 5}});
  CHECK(m.transpose() == Matrix<3, 2>{{1, 4, 2, 5, 3, 6}});
  CHECK(m.block<1, 2>(1, 1) == Matrix<1, 2>{{5, 6}});
}

TEST_CASE("products of matrices and vectors") {
  const Matrix<2, 3> m{{1, 2, 3, 4, 5, 6}};
  CHECK(m * Vector3{{1, 0, -1}} == Vector2{{-2, -2}});
  CHECK(m * m.transpose() == Matrix2{{14, 32, 32, 77}});
  CHECK(Matrix2::identity() * m == m);
  CHECK(outer(Vector2{{1, 2}}, Vector3{{3, 4, 5}}) == Matrix<2, 3>{{3, 4, 5, 6, 8, 10}});
  CHECK(symmetric_part(Matrix2{{1, 2, 4, 5}}) == Matrix2{{1, 3, 3, 5}});
}

TEST_CASE("hat is the matrix of the cross product and vee its inverse") {
  const Vector3 v{{1, 2, 3}}, x{{-2, 5, 7}};
  CHECK(hat(v) * x == cross(v, x));
  CHECK(vee(hat(v)) == v);
}

}  // namespace
}  // namespace bowstring
