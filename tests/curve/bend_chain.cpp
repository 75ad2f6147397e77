#include "core/curve/bend_chain.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace {

using namespace bowstring;
using doctest::Approx;

const double pi = std::acos(-1.0);

std::vector<BendSegment> tortuous() {
  return {{60.0, 0.0, 0.0}, {40.0, 1.2, 0.5}, {35.0, -2.9, 2.0}, {15.0, 0.0, 0.0}, {50.0, 3.3, -1.1}, {20.0, 0.7, 3.0}};
}

TEST_CASE("a chain is as long as its segments and begins at the origin along +x") {
  const BendChain chain(tortuous());
  CHECK(chain.length() == Approx(220.0).epsilon(1e-15));
  CHECK(norm(chain.position(0.0)) == 0.0);
  CHECK(chain.tangent(0.0) == Vector3{{1.0, 0.0, 0.0}});
  const Vector3 end_of_straight = chain.position(60.0);
  CHECK(end_of_straight[0] == Approx(60.0).epsilon(1e-14));
  CHECK(std::hypot(end_of_straight[1], end_of_straight[2]) == 0.0);
}

TEST_CASE("a bend turns its tangent by its angle, toward the direction of its plane") {
  const double bend = 1.1;
  for (const double plane : {0.0, 0.4, pi / 2.0, pi, -2.0}) {
    const Vector3 tangent = BendChain({{30.0, bend, plane}}).tangent(30.0);
    CAPTURE(plane);
    CHECK(tangent[0] == Approx(std::cos(bend)));
    CHECK(std::abs(tangent[1] - std::sin(bend) * std::cos(plane)) < 1e-15);
    CHECK(std::abs(tangent[2] - std::sin(bend) * std::sin(plane)) < 1e-15);
  }
}

TEST_CASE("the planes of later bends are carried along without twist") {
  const double quarter = pi / 2.0;
  // +x to +y; the transported normals are then -x and +z: a bend at a quarter goes to +z.
  const Vector3 up = BendChain({{10.0, quarter, 0.0}, {10.0, quarter, quarter}}).tangent(20.0);
  CHECK(norm(up - Vector3{{0.0, 0.0, 1.0}}) < 1e-15);
  // From there the normals are -x and -y: a third bend at a quarter goes to -y.
  const Vector3 back =
      BendChain({{10.0, quarter, 0.0}, {10.0, quarter, quarter}, {10.0, quarter, quarter}}).tangent(30.0);
  CHECK(norm(back - Vector3{{0.0, -1.0, 0.0}}) < 1e-15);
}

TEST_CASE("tangent and curvature are the derivatives of position") {
  const BendChain chain(tortuous());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0.1, 219.9);
  const double h = 1e-4;
  double largest = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const double s = anywhere(random);
    CAPTURE(s);
    const Vector3 ahead = chain.position(s + h);
    const Vector3 behind = chain.position(s - h);
    const Vector3 slope = (ahead - behind) / (2.0 * h);
    const Vector3 tangent = chain.tangent(s);
    CHECK(norm(tangent) == Approx(1.0).epsilon(1e-14));
    CHECK(norm(slope - tangent) < 1e-9);
    const Vector3 turn = (chain.tangent(s + h) - chain.tangent(s - h)) / (2.0 * h);
    const Vector3 curvature = chain.curvature_vector(s);
    CHECK(norm(turn - curvature) < 1e-8);
    CHECK(std::abs(dot(curvature, tangent)) < 1e-14);
    largest = std::max(largest, norm(curvature));
  }
  CHECK(largest > 0.1);
}

TEST_CASE("curvature is continuous with its derivative at every joint and peaks at twice its mean") {
  const BendChain chain(tortuous());
  for (const double joint : {60.0, 100.0, 135.0, 150.0, 200.0}) {
    CAPTURE(joint);
    for (const double step : {-1e-3, 1e-3}) {
      // κ = (β/l)(1 − cos 2πs/l) ≈ (β/l)·½(2πs/l)² near the joint.
      CHECK(norm(chain.curvature_vector(joint + step)) < 2.0 * 2.9 / 35.0 * std::pow(2.0 * pi * 1e-3 / 20.0, 2));
    }
  }
  CHECK(norm(chain.curvature_vector(117.5)) == Approx(2.0 * 2.9 / 35.0).epsilon(1e-14));
}

TEST_CASE("joints do not tear the curve and segments are told apart") {
  const BendChain chain(tortuous());
  const double joints[] = {60.0, 100.0, 135.0, 150.0, 200.0};
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(norm(chain.position(joints[i]) - chain.position(std::nextafter(joints[i], 0.0))) < 1e-12);
    CHECK(chain.segment_at(std::nextafter(joints[i], 0.0)) == i);
    CHECK(chain.segment_at(joints[i]) == i + 1);
  }
  CHECK(chain.segment_at(220.0) == 5);
}

TEST_CASE("a planar bend ends where Simpson's rule with fine steps says") {
  const double length = 40.0;
  const double bend = 5.0;
  const int steps = 20000;
  double x = 0.0;
  double y = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double u = 2.0 * pi * i / steps;
    const double angle = bend * (u - std::sin(u)) / (2.0 * pi);
    const double weight = (i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * length / steps / 3.0;
    x += weight * std::cos(angle);
    y += weight * std::sin(angle);
  }
  const Vector3 end = BendChain({{length, bend, 0.0}}).position(length);
  CHECK(std::abs(end[0] - x) < 1e-11);
  CHECK(std::abs(end[1] - y) < 1e-11);
  CHECK(end[2] == 0.0);
}

}  // namespace
