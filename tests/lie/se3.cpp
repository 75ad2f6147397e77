#include "core/lie/se3.hpp"

#include "tests/lie/reference.hpp"

namespace bowstring::lie {
namespace {

using reference::Real;
using reference::relative_error;
using reference::widen;
using se3::Twist;

/// [ω^ ν; 0 0], spelled out.
Matrix<4, 4, Real> wide_hat(const Vector<6, Real>& xi) {
  const Real o(0);
  return {{o, -xi[2], xi[1], xi[3], xi[2], o, -xi[0], xi[4], -xi[1], xi[0], o, xi[5], o, o, o, o}};
}
Vector<6, Real> wide_vee(const Matrix<4, 4, Real>& m) {
  return {{m(2, 1), m(0, 2), m(1, 0), m(0, 3), m(1, 3), m(2, 3)}};
}

/// Twists whose rotation angles are those of `reference::angles`.
std::vector<Twist> twists(unsigned seed) {
  reference::Numbers numbers(seed);
  std::vector<Twist> out;
  for (const Vector3& omega : reference::rotation_vectors(seed)) {
    out.push_back(se3::twist(omega, 2.0 * numbers.vector<3>()));
  }
  return out;
}

Se3 motion(reference::Numbers& numbers) {
  const Rotation r = numbers.rotation();
  return {r, 5.0 * numbers.vector<3>()};
}

TEST_CASE("SE(3) hat puts a twist into the Lie algebra") {
  const Twist xi{{1, 2, 3, 4, 5, 6}};
  CHECK(se3::hat(xi) == Matrix<4, 4>{{0, -3, 2, 4, 3, 0, -1, 5, -2, 1, 0, 6, 0, 0, 0, 0}});
}

TEST_CASE("SE(3) vee is the inverse of hat") {
  const Twist xi{{1, 2, 3, 4, 5, 6}};
  CHECK(se3::vee(se3::hat(xi)) == xi);
}

TEST_CASE("SE(3) exp agrees with the matrix exponential to 50 digits") {
  CHECK(se3::exp({}).matrix() == Matrix<4, 4>::identity());
  for (const Twist& xi : twists(1)) {
    CAPTURE(norm(se3::angular(xi)));
    const auto expected = reference::matrix_exponential(wide_hat(widen(xi)));
    const Se3 g = se3::exp(xi);
    CHECK(relative_error(g.matrix(), expected) < 1e-15);
    CHECK(relative_error(g.position, Vector<3, Real>{{expected(0, 3), expected(1, 3), expected(2, 3)}}) < 1e-15);
  }
}

TEST_CASE("SE(3) log agrees with the twist of a 50-digit matrix exponential") {
  CHECK(se3::log(Se3::identity()) == Twist{});
  for (const Twist& xi : twists(2)) {
    CAPTURE(norm(se3::angular(xi)));
    const auto wide = reference::matrix_exponential(wide_hat(widen(xi)));
    const Se3 g{reference::narrow(reference::quaternion(wide.block<3, 3>(0, 0))),
                reference::narrow(Vector<3, Real>{{wide(0, 3), wide(1, 3), wide(2, 3)}})};
    const Twist found = se3::log(g);
    CHECK(relative_error(se3::angular(found), widen(se3::angular(xi))) < 1e-15);
    CHECK(relative_error(se3::linear(found), widen(se3::linear(xi))) < 2e-15);
  }
}

TEST_CASE("SE(3) products and inverses stay in the group") {
  reference::Numbers numbers(3);
  for (int k = 0; k < 20; ++k) {
    const Se3 g = motion(numbers), h = motion(numbers);
    const Matrix<4, 4> product = (g * h).matrix();
    CHECK(relative_error(product, widen(g.matrix()) * widen(h.matrix())) < 1e-15);
    const Matrix3 r = product.block<3, 3>(0, 0);
    CHECK(relative_error(r.transpose() * r, Matrix<3, 3, Real>::identity()) < 2e-15);
    CHECK(dot(cross(r.column(0), r.column(1)), r.column(2)) == doctest::Approx(1.0).epsilon(2e-15));
    CHECK(product.row(3) == Vector<4>{{0, 0, 0, 1}});
    CHECK(relative_error((g * g.inverse()).matrix(), Matrix<4, 4, Real>::identity()) < 4e-15);
    const Vector3 point = numbers.vector<3>();
    CHECK(norm((g * h) * point - g * (h * point)) < 1e-14);
  }
}

TEST_CASE("SE(3) exp and log are inverses of each other") {
  for (const Twist& xi : twists(4)) {
    CAPTURE(norm(se3::angular(xi)));
    CHECK(relative_error(se3::log(se3::exp(xi)), widen(xi)) < 2e-15);
  }
  reference::Numbers numbers(5);
  for (int k = 0; k < 20; ++k) {
    const Se3 g = motion(numbers);
    CHECK(relative_error(se3::exp(se3::log(g)).matrix(), widen(g.matrix())) < 2e-15);
  }
}

TEST_CASE("SE(3) adjoint carries body twists from one frame to another") {
  reference::Numbers numbers(6);
  for (int k = 0; k < 10; ++k) {
    const Se3 g = motion(numbers);
    const Twist xi = numbers.vector<6>();
    const Matrix<4, 4> conjugated = g.matrix() * se3::hat(xi) * g.inverse().matrix();
    CHECK(relative_error(se3::hat(se3::adjoint(g) * xi), widen(conjugated)) < 4e-15);
    CHECK(relative_error(se3::exp(se3::adjoint(g) * xi).matrix(), widen((g * se3::exp(xi) * g.inverse()).matrix())) <
          4e-15);
  }
}

TEST_CASE("SE(3) left Jacobian agrees with differences of the matrix exponential") {
  std::vector<Twist> points = twists(7);
  points.push_back({{2.0, -3.0, 2.5, 1.0, 0.3, -0.7}});
  for (const Twist& xi : points) {
    CAPTURE(norm(se3::angular(xi)));
    const auto back = reference::matrix_exponential(wide_hat(-widen(xi)));
    const auto expected = reference::jacobian<6, 6>([&](const Vector<6, Real>& h) {
      return wide_vee(reference::matrix_exponential(wide_hat(widen(xi) + h)) * back);
    });
    const Matrix<6, 6> found = se3::left_jacobian(xi);
    CHECK(relative_error(found, expected) < 1e-15);
    CHECK(relative_error(found.block<3, 3>(3, 0), expected.block<3, 3>(3, 0)) < 4e-15);
  }
}

}  // namespace
}  // namespace bowstring::lie
