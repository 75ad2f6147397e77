#include "core/lie/so3.hpp"

#include "tests/lie/reference.hpp"

namespace bowstring::lie {
namespace {

using reference::Real;
using reference::relative_error;
using reference::widen;

/// A number with its derivative along one direction.
struct Dual {
  double value = 0.0, rate = 0.0;
  Dual() = default;
  Dual(double v, double r = 0.0) : value(v), rate(r) {}
  friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.rate + b.rate}; }
  friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.rate - b.rate}; }
  friend Dual operator-(Dual a) { return {-a.value, -a.rate}; }
  friend Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.value * b.rate + a.rate * b.value}; }
  friend Dual operator/(Dual a, Dual b) { return {a.value / b.value, (a.rate - a.value / b.value * b.rate) / b.value}; }
  Dual& operator+=(Dual b) { return *this = *this + b; }
  Dual& operator*=(Dual b) { return *this = *this * b; }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend Dual sqrt(Dual a) { return {std::sqrt(a.value), 0.5 * a.rate / std::sqrt(a.value)}; }
  friend Dual sin(Dual a) { return {std::sin(a.value), std::cos(a.value) * a.rate}; }
  friend Dual cos(Dual a) { return {std::cos(a.value), -std::sin(a.value) * a.rate}; }
  friend Dual atan2(Dual y, Dual x) {
    const double r2 = x.value * x.value + y.value * y.value;
    return {std::atan2(y.value, x.value), (x.value * y.rate - y.value * x.rate) / r2};
  }
};

TEST_CASE("exp of a rotation vector agrees with the matrix exponential to 50 digits") {
  CHECK(exp(Vector3{}).matrix() == Matrix3::identity());
  std::vector<Vector3> vectors = reference::rotation_vectors(1);
  vectors.push_back({{3.0, -4.0, 2.0}});
  for (const Vector3& v : vectors) {
    CAPTURE(norm(v));
    const Matrix3 r = exp(v).matrix();
    const auto expected = reference::matrix_exponential(hat(widen(v)));
    CHECK(relative_error(r, expected) < 1e-15);
    // What differs from the identity, which the norm of the whole matrix hides near 0.
    CHECK(relative_error(vee(r), vee(expected)) * std::fabs(std::sin(norm(v))) < 1e-15 * std::fmin(1.0, norm(v)));
  }
}

TEST_CASE("log of a rotation agrees with the rotation vector of a 50-digit matrix exponential") {
  CHECK(log(Rotation::identity()) == Vector3{});
  for (const Vector3& v : reference::rotation_vectors(2)) {
    CAPTURE(norm(v));
    const Rotation r = reference::narrow(reference::quaternion(reference::matrix_exponential(hat(widen(v)))));
    CHECK(relative_error(log(r), widen(v)) < 1e-15);
    // The same rotation on the other cover.
    CHECK(log(Rotation{-r.w, -r.x, -r.y, -r.z}) == log(r));
  }
}

TEST_CASE("log is never longer than half a turn") {
  const Vector3 axis{{0.6, 0.0, -0.8}};
  const Vector3 beyond = log(exp(axis * (reference::pi + 1e-6)));
  CHECK(norm(beyond) == doctest::Approx(reference::pi - 1e-6).epsilon(1e-15));
  CHECK(dot(beyond, axis) < 0.0);
  CHECK(norm(log(Rotation{0.0, 0.6, 0.0, -0.8}) - reference::pi * axis) < 1e-15);
}

TEST_CASE("product, inverse and action agree with those of the matrices") {
  reference::Numbers numbers(3);
  for (int k = 0; k < 20; ++k) {
    const Rotation a = numbers.rotation(), b = numbers.rotation();
    const Vector3 v = numbers.vector<3>();
    CHECK(relative_error((a * b).matrix(), widen(a.matrix()) * widen(b.matrix())) < 2e-15);
    CHECK(relative_error(a.inverse().matrix(), widen(a.matrix().transpose())) < 1e-15);
    CHECK(relative_error(a * v, widen(a.matrix()) * widen(v)) < 2e-15);
    CHECK(a.first_axis() == a.matrix().column(0));
    double q[4];
    a.store(q);
    CHECK(q[0] == a.w);
    CHECK(Rotation::load(q).matrix() == a.matrix());
  }
}

TEST_CASE("from_matrix finds the rotation wherever the largest quaternion component is") {
  std::vector<Vector3> vectors = reference::rotation_vectors(4);
  for (int k = 0; k < 3; ++k) {
    vectors.push_back(reference::pi * Vector3::unit(k));
    vectors.push_back((reference::pi - 1e-9) * Vector3::unit(k));
  }
  for (const Vector3& v : vectors) {
    CAPTURE(norm(v));
    const Rotation r = exp(v);
    const Rotation found = from_matrix(r.matrix());
    CHECK(norm(log(r.inverse() * found)) < 1e-15);
  }
}

TEST_CASE("coefficients of the Jacobians hold full precision on both sides of where their formulas change") {
  for (const double angle : {1e-8, 1e-3, 0.1, 0.5, 1.0, 2.0, 3.0, reference::pi - 1e-7, 3.1622, 3.1623, 4.0, 5.5}) {
    CAPTURE(angle);
    const double squared = angle * angle;
    const Real t(squared), theta = sqrt(t), half = theta / 2;
    const Real a = (1 - cos(theta)) / t, b = (theta - sin(theta)) / (t * theta);
    const Real cotangent = cos(half) / sin(half);
    const Real c = 1 / t - cotangent / (2 * theta);
    const Real a_rate = (sin(theta) / theta - 2 * a) / t, b_rate = (a - 3 * b) / t;
    const Real c_rate = (-2 / (t * theta) + cotangent / (2 * t) + 1 / (4 * theta * sin(half) * sin(half))) / theta;
    const auto error = [](double found, const Real& expected) {
      return static_cast<double>(abs((found - expected) / expected));
    };
    const JacobianCoefficients k = jacobian_coefficients(squared);
    CHECK(error(k.a, a) < 1e-15);
    CHECK(error(k.b, b) < 1e-15);
    CHECK(error(k.a_rate, a_rate) < 2e-15);
    CHECK(error(k.b_rate, b_rate) < 2e-15);
    const InverseJacobianCoefficients inverse = inverse_jacobian_coefficients(squared);
    CHECK(error(inverse.c, c) < 1e-15);
    CHECK(error(inverse.c_rate, c_rate) < 4e-15);
  }
}

TEST_CASE("left and right Jacobian agree with differences of the matrix exponential") {
  std::vector<Vector3> vectors = reference::rotation_vectors(5);
  vectors.push_back({{2.0, -3.0, 2.5}});
  for (const Vector3& v : vectors) {
    CAPTURE(norm(v));
    const auto moved = [&](const Vector<3, Real>& h) { return reference::matrix_exponential(hat(widen(v) + h)); };
    const auto back = reference::matrix_exponential(-hat(widen(v)));
    const auto rates = reference::derivatives<3>(moved);
    Matrix<3, 3, Real> left, right;
    for (int j = 0; j < 3; ++j) {
      left.set_column(j, vee(rates[static_cast<std::size_t>(j)] * back));
      right.set_column(j, vee(back * rates[static_cast<std::size_t>(j)]));
    }
    CHECK(relative_error(left_jacobian(v), left) < 1e-15);
    CHECK(relative_error(right_jacobian(v), right) < 1e-15);
    const auto unit = Matrix<3, 3, Real>::identity();
    CHECK(relative_error(left_jacobian(v) * left_jacobian_inverse(v), unit) < 4e-15);
    CHECK(relative_error(right_jacobian(v) * right_jacobian_inverse(v), unit) < 4e-15);
  }
}

TEST_CASE("relative rotation and its derivatives in both body tangents") {
  reference::Numbers numbers(6);
  for (const Vector3& v : reference::rotation_vectors(7)) {
    CAPTURE(norm(v));
    const Rotation a = numbers.rotation();
    const Rotation b = a * exp(v);
    const RelativeRotation found = relative_rotation(a, b);
    const auto wide_a = widen(a), wide_b = widen(b);
    const auto zeta = [&](const Vector<3, Real>& da, const Vector<3, Real>& db) {
      return reference::log((wide_a * reference::exp(da)).inverse() * (wide_b * reference::exp(db)));
    };
    const auto by_a = reference::jacobian<3, 3>([&](const Vector<3, Real>& d) { return zeta(d, {}); });
    const auto by_b = reference::jacobian<3, 3>([&](const Vector<3, Real>& d) { return zeta({}, d); });
    // ζ itself carries the rounding of aᵀb, which is absolute.
    CHECK(reference::magnitude(widen(found.value) - zeta({}, {})) < 2e-15);
    CHECK(relative_error(found.by_a, by_a) < 4e-15);
    CHECK(relative_error(found.by_b, by_b) < 4e-15);
  }
}

TEST_CASE("curvature of the relative rotation agrees with second differences") {
  reference::Numbers numbers(8);
  for (const Vector3& zeta : reference::rotation_vectors(9)) {
    CAPTURE(norm(zeta));
    const Vector3 m = numbers.vector<3>();
    const auto turn = reference::exp(widen(zeta));
    const auto expected = reference::hessian<6>([&](const Vector<6, Real>& d) {
      const Vector<3, Real> da{{d[0], d[1], d[2]}}, db{{d[3], d[4], d[5]}};
      return dot(widen(m), reference::log(reference::exp(-da) * turn * reference::exp(db)));
    });
    const Matrix<6, 6> found = relative_rotation_curvature(relative_rotation(zeta), m);
    CHECK(relative_error(found, expected) < 1e-14);
    CHECK(found == found.transpose());
  }
}

TEST_CASE("curvature of the relative rotation vanishes within a body at identity") {
  // Log(Exp(−δa)Exp(δb)) = δb − δa − ½ δa×δb + …
  const Vector3 m{{0.3, -0.7, 1.1}};
  Matrix<6, 6> expected;
  expected.set_block(0, 3, 0.5 * hat(m));
  expected.set_block(3, 0, -0.5 * hat(m));
  CHECK(relative_error(relative_rotation_curvature(relative_rotation(Vector3{}), m), widen(expected)) < 1e-16);
}

TEST_CASE("derivatives of the chart base Exp(x)") {
  reference::Numbers numbers(10);
  for (const Vector3& x : reference::rotation_vectors(11)) {
    CAPTURE(norm(x));
    const Vector3 g = numbers.vector<3>();
    const auto back = reference::exp(widen(x)).inverse();
    const auto tangent = [&](const Vector<3, Real>& h) { return reference::log(back * reference::exp(widen(x) + h)); };
    CHECK(relative_error(exp_chart(x), reference::jacobian<3, 3>(tangent)) < 1e-15);
    const auto expected = reference::hessian<3>([&](const Vector<3, Real>& h) { return dot(widen(g), tangent(h)); });
    CHECK(relative_error(exp_chart_curvature(x, g), expected) < 1e-14);
  }
}

TEST_CASE("exp and log take forward-differentiation numbers, at identity too") {
  std::vector<Vector3> vectors = reference::rotation_vectors(12);
  vectors.push_back({});
  const Vector3 direction{{0.4, -1.2, 0.9}};
  for (const Vector3& v : vectors) {
    CAPTURE(norm(v));
    Vector<3, Dual> moving;
    for (int i = 0; i < 3; ++i) moving[i] = Dual(v[i], direction[i]);
    const BasicRotation<Dual> r = exp(moving);
    const Vector<3, Dual> body = log(BasicRotation<Dual>{r.w.value, r.x.value, r.y.value, r.z.value}.inverse() * r);
    const Vector<3, Dual> back = log(r);
    const Vector3 expected = right_jacobian(v) * direction;
    for (int i = 0; i < 3; ++i) {
      CHECK(body[i].rate == doctest::Approx(expected[i]).epsilon(1e-12));
      CHECK(back[i].rate == doctest::Approx(direction[i]).epsilon(1e-12));
    }
  }
}

}  // namespace
}  // namespace bowstring::lie
