#include "core/lie/s2.hpp"

#include "tests/lie/reference.hpp"

namespace bowstring::lie {
namespace {

using reference::Real;
using reference::relative_error;
using reference::widen;

Vector3 twist_free(const Vector2& x) { return {{0.0, x[0], x[1]}}; }
Vector<3, Real> twist_free(const Vector<2, Real>& x) { return {{Real(0), x[0], x[1]}}; }

Vector<2, Real> wide_direction_log(const Vector<3, Real>& e) {
  const Real sine = sqrt(e[1] * e[1] + e[2] * e[2]);
  if (sine == 0) return {};
  return Vector<2, Real>{{-e[2], e[1]}} * Real(atan2(sine, e[0]) / sine);
}

/// Turns across the first axis by the angles of `reference::angles`.
std::vector<Vector2> turns(unsigned seed) {
  reference::Numbers numbers(seed);
  std::vector<Vector2> out;
  for (const double angle : reference::angles()) out.push_back(angle * normalized(numbers.vector<2>()));
  return out;
}

TEST_CASE("direction_log finds the turn that carries e1 to a direction") {
  CHECK(direction_log({{1.0, 0.0, 0.0}}) == Vector2{});
  CHECK(direction_log({{-1.0, 0.0, 0.0}}) == Vector2{{0.0, std::acos(-1.0)}});
  for (const Vector2& x : turns(1)) {
    CAPTURE(norm(x));
    const Vector<3, Real> u = reference::exp(twist_free(widen(x))).first_axis();
    const Vector2 found = direction_log(reference::narrow(u));
    CHECK(std::fabs(norm(found) - norm(x)) < 1e-15 * norm(x));
    // Rounding of u itself turns the axis by the rounding over the sine.
    CHECK(norm(found - x) <= 4e-16 * norm(x) / std::sin(norm(x)));
  }
}

TEST_CASE("relative turn and its derivatives in the tangents of both directions") {
  reference::Numbers numbers(2);
  for (const Vector2& x : turns(3)) {
    const double angle = norm(x);
    CAPTURE(angle);
    const Rotation a = numbers.rotation();
    const Rotation b = a * exp(twist_free(x)) * exp(Vector3{{numbers.next(), 0.0, 0.0}});
    const auto wide_a = widen(a), wide_b = widen(b);
    const auto zeta = [&](const Vector<2, Real>& alpha, const Vector<2, Real>& beta) {
      const auto turned = wide_b * reference::exp(twist_free(beta));
      return wide_direction_log(((wide_a * reference::exp(twist_free(alpha))).inverse() * turned).first_axis());
    };
    const RelativeTurn found = relative_turn(a, b);
    // The rounding of aᵀb, amplified by 1/sin θ toward opposite directions as every formula must.
    const double rounding = 1e-15 * std::fmax(1.0, 1.0 / std::sin(angle));
    CHECK(reference::magnitude(widen(found.value) - zeta({}, {})) < (angle < 2.0 ? 1e-15 : 4.0 * rounding));
    const double tolerance = angle < 2.0 ? 4e-15 : 4.0 * rounding;
    CHECK(relative_error(found.by_a, reference::jacobian<2, 2>([&](const auto& d) { return zeta(d, {}); })) <
          tolerance);
    CHECK(relative_error(found.by_b, reference::jacobian<2, 2>([&](const auto& d) { return zeta({}, d); })) <
          tolerance);

    const Vector2 m = numbers.vector<2>();
    const auto expected = reference::hessian<4>([&](const Vector<4, Real>& d) {
      return dot(widen(m), zeta({{d[0], d[1]}}, {{d[2], d[3]}}));
    });
    const Matrix<4, 4> curvature = relative_turn_curvature(found, m);
    // It is of the order of the angle, the rounding of u is not.
    CHECK(relative_error(curvature, expected) < (angle < 2.0 ? 2e-14 + 4e-16 / angle : 10.0 * rounding));
    CHECK(relative_error(curvature, widen(curvature.transpose())) < 1e-15);
  }
}

TEST_CASE("relative turn does not depend on the second direction's twist, and its size not on the first's") {
  reference::Numbers numbers(4);
  const Rotation a = numbers.rotation(), b = numbers.rotation(), twist = exp(Vector3{{0.8, 0.0, 0.0}});
  const Vector2 turn = relative_turn(a, b).value;
  REQUIRE(norm(turn) > 0.1);
  CHECK(norm(relative_turn(a, b * twist).value - turn) < 2e-15);
  CHECK(norm(relative_turn(a * twist, b).value) == doctest::Approx(norm(turn)).epsilon(1e-15));
  CHECK(norm(relative_turn(a * twist, b).value - turn) > 0.01);
}

TEST_CASE("relative turn of opposite directions is finite") {
  const Rotation a = Rotation::identity(), b{0.0, 0.0, 0.0, 1.0};
  const RelativeTurn turn = relative_turn(a, b);
  CHECK(norm(turn.value) == std::acos(-1.0));
  const Matrix<4, 4> curvature = relative_turn_curvature(turn, {{1.0, 2.0}});
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) CHECK(std::isfinite(turn.by_a(i, j) + turn.by_b(i, j)));
  }
  for (const double entry : curvature.data) CHECK(std::isfinite(entry));
}

TEST_CASE("derivatives of the chart base Exp((0, x)) of directions") {
  reference::Numbers numbers(5);
  std::vector<Vector2> points = turns(6);
  points.push_back({{2.5, -2.5}});
  for (const Vector2& x : points) {
    CAPTURE(norm(x));
    const Vector2 g = numbers.vector<2>();
    const auto back = reference::exp(twist_free(widen(x))).inverse();
    const auto tangent = [&](const Vector<2, Real>& h) {
      return wide_direction_log((back * reference::exp(twist_free(widen(x) + h))).first_axis());
    };
    CHECK(relative_error(direction_chart(x), reference::jacobian<2, 2>(tangent)) < 2e-15);
    const auto expected = reference::hessian<2>([&](const Vector<2, Real>& h) { return dot(widen(g), tangent(h)); });
    CHECK(relative_error(direction_chart_curvature(x, g), expected) < 1e-14);
  }
}

TEST_CASE("derivatives of the direction of an edge") {
  const double length = 3.7;
  const Vector2 g{{0.8, -1.3}};
  const auto turn = [&](const Vector<3, Real>& h) {
    return wide_direction_log(widen(Vector3{{length, 0.0, 0.0}}) + h);
  };
  CHECK(relative_error(edge_direction(length), reference::jacobian<2, 3>(turn)) < 1e-15);
  const auto expected = reference::hessian<3>([&](const Vector<3, Real>& h) { return dot(widen(g), turn(h)); });
  CHECK(relative_error(edge_direction_curvature(length, g), expected) < 1e-15);
}

TEST_CASE("frame_from_tangent has the tangent as its first axis") {
  CHECK(frame_from_tangent({{1.0, 0.0, 0.0}}).matrix() == Matrix3::identity());
  CHECK(frame_from_tangent({{-1.0, 0.0, 0.0}}).first_axis() == Vector3{{-1.0, 0.0, 0.0}});
  for (const Vector2& x : turns(7)) {
    CAPTURE(norm(x));
    const Vector3 t = reference::narrow(reference::exp(twist_free(widen(x))).first_axis());
    CHECK(norm(frame_from_tangent(t).first_axis() - t) < 1e-15);
  }
}

TEST_CASE("parallel transport turns by the least rotation") {
  reference::Numbers numbers(8);
  for (const Vector2& x : turns(9)) {
    CAPTURE(norm(x));
    const Rotation r = numbers.rotation();
    const Vector3 t = r * reference::narrow(reference::exp(twist_free(widen(x))).first_axis());
    const Rotation transported = transport(r, t);
    CHECK(norm(transported.first_axis() - t) < 2e-15);
    const Vector3 turn = log(r.inverse() * transported);
    CHECK(std::fabs(turn[0]) < 1e-15);
    CHECK(norm(turn) == doctest::Approx(norm(x)).epsilon(1e-15).scale(1.0));
  }
}

TEST_CASE("parallel transport to the opposite direction is half a turn") {
  reference::Numbers numbers(10);
  for (int k = 0; k < 20; ++k) {
    const Rotation r = numbers.rotation();
    const Vector3 t = -r.first_axis();
    const Rotation transported = transport(r, t);
    CHECK(norm(transported.first_axis() - t) < 1e-15);
    CHECK(norm(log(r.inverse() * transported)) == doctest::Approx(reference::pi).epsilon(1e-14));
    CHECK(transport(r, t).matrix() == transported.matrix());
  }
}

}  // namespace
}  // namespace bowstring::lie
