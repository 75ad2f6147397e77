#include "core/lie/se2.hpp"

#include "tests/lie/reference.hpp"

namespace bowstring::lie {
namespace {

using reference::Real;
using reference::relative_error;
using reference::widen;
using se2::Twist;

/// [ω^ ν; 0 0], spelled out.
Matrix<3, 3, Real> wide_hat(const Vector<3, Real>& xi) {
  const Real o(0);
  return {{o, -xi[0], xi[1], xi[0], o, xi[2], o, o, o}};
}
Vector<3, Real> wide_vee(const Matrix<3, 3, Real>& m) { return {{m(1, 0), m(0, 2), m(1, 2)}}; }

/// Twists whose angles are those of `reference::angles`, of both signs.
std::vector<Twist> twists(unsigned seed) {
  reference::Numbers numbers(seed);
  std::vector<Twist> out;
  for (const double angle : reference::angles()) {
    const Vector2 nu = 2.0 * numbers.vector<2>();
    out.push_back({{angle, nu[0], nu[1]}});
    out.push_back({{-angle, nu[0], nu[1]}});
  }
  return out;
}

Se2 motion(reference::Numbers& numbers) {
  const double angle = 3.0 * numbers.next();
  return {angle, 5.0 * numbers.vector<2>()};
}

TEST_CASE("SE(2) hat puts a twist into the Lie algebra") {
  CHECK(se2::hat({{1, 2, 3}}) == Matrix3{{0, -1, 2, 1, 0, 3, 0, 0, 0}});
}

TEST_CASE("SE(2) vee is the inverse of hat") { CHECK(se2::vee(se2::hat({{1, 2, 3}})) == Twist{{1, 2, 3}}); }

TEST_CASE("SE(2) exp agrees with the matrix exponential to 50 digits") {
  CHECK(se2::exp({}).matrix() == Matrix3::identity());
  for (const Twist& xi : twists(1)) {
    CAPTURE(xi[0]);
    const auto expected = reference::matrix_exponential(wide_hat(widen(xi)));
    const Se2 g = se2::exp(xi);
    CHECK(relative_error(g.matrix(), expected) < 1e-15);
    CHECK(relative_error(g.position, Vector<2, Real>{{expected(0, 2), expected(1, 2)}}) < 1e-15);
  }
}

TEST_CASE("SE(2) log agrees with the twist of a 50-digit matrix exponential") {
  CHECK(se2::log(Se2::identity()) == Twist{});
  for (const Twist& xi : twists(2)) {
    CAPTURE(xi[0]);
    const auto wide = reference::matrix_exponential(wide_hat(widen(xi)));
    const Vector2 position = reference::narrow(Vector<2, Real>{{wide(0, 2), wide(1, 2)}});
    CHECK(relative_error(se2::log({xi[0], position}), widen(xi)) < 1e-15);
    CHECK(relative_error(se2::log({xi[0] + 2.0 * reference::pi, position}), widen(xi)) < 2e-15);
  }
}

TEST_CASE("SE(2) products and inverses stay in the group") {
  reference::Numbers numbers(3);
  for (int k = 0; k < 20; ++k) {
    const Se2 g = motion(numbers), h = motion(numbers);
    const Matrix3 product = (g * h).matrix();
    CHECK(relative_error(product, widen(g.matrix()) * widen(h.matrix())) < 1e-15);
    const Matrix2 r = product.block<2, 2>(0, 0);
    CHECK(relative_error(r.transpose() * r, Matrix<2, 2, Real>::identity()) < 1e-15);
    CHECK(cross(r.column(0), r.column(1)) == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(product.row(2) == Vector3{{0, 0, 1}});
    CHECK(relative_error((g * g.inverse()).matrix(), Matrix<3, 3, Real>::identity()) < 2e-15);
    const Vector2 point = numbers.vector<2>();
    CHECK(norm((g * h) * point - g * (h * point)) < 1e-14);
  }
}

TEST_CASE("SE(2) exp and log are inverses of each other") {
  for (const Twist& xi : twists(4)) {
    CAPTURE(xi[0]);
    CHECK(relative_error(se2::log(se2::exp(xi)), widen(xi)) < 1e-15);
  }
  reference::Numbers numbers(5);
  for (int k = 0; k < 20; ++k) {
    const Se2 g = motion(numbers);
    CHECK(relative_error(se2::exp(se2::log(g)).matrix(), widen(g.matrix())) < 1e-15);
  }
}

TEST_CASE("SE(2) adjoint carries body twists from one frame to another") {
  reference::Numbers numbers(6);
  for (int k = 0; k < 10; ++k) {
    const Se2 g = motion(numbers);
    const Twist xi = numbers.vector<3>();
    const Matrix3 conjugated = g.matrix() * se2::hat(xi) * g.inverse().matrix();
    CHECK(relative_error(se2::hat(se2::adjoint(g) * xi), widen(conjugated)) < 4e-15);
  }
}

TEST_CASE("SE(2) left Jacobian agrees with differences of the matrix exponential") {
  std::vector<Twist> points = twists(7);
  points.push_back({{-4.6, 1.0, 0.3}});
  for (const Twist& xi : points) {
    CAPTURE(xi[0]);
    const auto back = reference::matrix_exponential(wide_hat(-widen(xi)));
    const auto expected = reference::jacobian<3, 3>([&](const Vector<3, Real>& h) {
      return wide_vee(reference::matrix_exponential(wide_hat(widen(xi) + h)) * back);
    });
    CHECK(relative_error(se2::left_jacobian(xi), expected) < 1e-15);
  }
}

}  // namespace
}  // namespace bowstring::lie
