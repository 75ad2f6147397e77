#include <doctest/doctest.h>

#include <cmath>

#include "frames.hpp"
#include "losses/ground-costs/geodesics/first_guesses.hpp"
#include "losses/ground-costs/geodesics/geodesic_distance.hpp"
#include "losses/ground-costs/geodesics/nilpotent_distance.hpp"

using namespace ground_cost_test;
using namespace bowstring::geodesics;
namespace se3 = bowstring::lie::se3;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The distance, which has to be found.
double distance(const Se3& target, const Weights& weights = {}) {
  const GeodesicDistance found = geodesic_distance(target, weights);
  REQUIRE_MESSAGE(found.found, found.failure);
  return std::sqrt(found.squared);
}

}  // namespace

TEST_CASE("Along a geodesic stays what has to stay") {
  Random random(11);
  for (const double compliance : {0.0, 0.3, 2.5}) {
    for (int k = 0; k < repeats(2, 20, 100); ++k) {
      const Weights weights{0.5 + random.uniform(), compliance};
      const Covector start = 2.0 * random.twist();
      const double scale = norm(start), energy = squared_length(start, weights);
      for (const double time : {0.3, 1.0}) {
        const GeodesicEnd end = follow_geodesic(start, time, weights, Accuracy::fine);
        const Vector3 m = moment(end.covector), p = force(end.covector);
        const Vector3 p_in_space = end.pose.rotation * p;
        const Vector3 m_in_space = end.pose.rotation * m + cross(end.pose.position, p_in_space);
        CHECK(squared_length(end.covector, weights) == doctest::Approx(energy).epsilon(1e-11));
        CHECK(norm(p) == doctest::Approx(norm(force(start))).epsilon(1e-11));
        CHECK(std::fabs(dot(p, m) - dot(force(start), moment(start))) < 1e-11 * scale * scale);
        CHECK(norm(p_in_space - force(start)) < 1e-11 * scale);
        CHECK(norm(m_in_space - moment(start)) < 1e-11 * scale);
        CHECK(std::fabs(m[0] - start[0]) < 1e-11 * scale);
      }
    }
  }
}

TEST_CASE("A geodesic obeys Hamilton's equations, with its velocity from its covector") {
  Random random(12);
  for (const double compliance : {0.0, 0.3}) {
    const Weights weights{0.7, compliance};
    const Covector start = 1.5 * random.twist();
    const double h = 1e-3;
    const auto at = [&](double time) { return follow_geodesic(start, time, weights, Accuracy::fine); };
    const GeodesicEnd now = at(0.5);
    const auto offset = [&](double time) { return se3::log(now.pose.inverse() * at(time).pose); };
    const Twist velocity =
        (8.0 * (offset(0.5 + h) - offset(0.5 - h)) - (offset(0.5 + 2.0 * h) - offset(0.5 - 2.0 * h))) / (12.0 * h);
    const Vector3 m = moment(now.covector), p = force(now.covector);
    const Vector3 omega{{m[0] / weights.roll_squared, m[1], m[2]}};
    const Vector3 nu{{p[0], compliance * p[1], compliance * p[2]}};
    CHECK(norm(velocity - se3::twist(omega, nu)) < 1e-9 * norm(velocity));
    const Covector rate = (8.0 * (at(0.5 + h).covector - at(0.5 - h).covector) -
                           (at(0.5 + 2.0 * h).covector - at(0.5 - 2.0 * h).covector)) /
                          (12.0 * h);
    REQUIRE(norm(rate) > 0.1);
    CHECK(norm(rate - se3::twist(cross(m, omega) + cross(p, nu), cross(p, omega))) < 1e-9 * norm(rate));
  }
}

TEST_CASE("Sensitivities are those of differences") {
  Random random(13);
  for (int k = 0; k < repeats(1, 10, 50); ++k) {
    const Weights weights{0.5 + random.uniform(), k % 2 == 0 ? 0.0 : 0.4};
    const Covector start = random.twist();
    const GeodesicEnd end = follow_geodesic(start, 0.8, weights, Accuracy::fine);
    const Matrix<6, 6> by_start = covector_by_start(end);
    for (int j = 0; j < 6; ++j) {
      const double h = 1e-3;
      const auto at = [&](double s) {
        return follow_geodesic(start + s * h * Covector::unit(j), 0.8, weights, Accuracy::fine);
      };
      const auto offset = [&](double s) { return se3::log(end.pose.inverse() * at(s).pose); };
      const Twist motion = (8.0 * (offset(1.0) - offset(-1.0)) - (offset(2.0) - offset(-2.0))) / (12.0 * h);
      const Covector change =
          (8.0 * (at(1.0).covector - at(-1.0).covector) - (at(2.0).covector - at(-2.0).covector)) / (12.0 * h);
      REQUIRE(norm(motion) > 0.01);
      REQUIRE(norm(change) > 0.01);
      CHECK(norm(motion - end.by_start.column(j)) < 1e-8 * (1.0 + norm(motion)));
      CHECK(norm(change - by_start.column(j)) < 1e-8 * (1.0 + norm(change)));
    }
  }
}

TEST_CASE("Known distances at unit weights") {
  const double known[][2] = {{0.01, 0.3542791}, {0.1, 1.1142679}, {1.0, 3.3403830}, {5.0, 7.3744999}};
  for (const auto& [lateral, expected] : known) {
    CHECK(distance({{}, {{0.0, lateral, 0.0}}}) == doctest::Approx(expected).epsilon(1e-7));
    CHECK(distance({{}, {{0.0, 0.6 * lateral, -0.8 * lateral}}}) == doctest::Approx(expected).epsilon(1e-7));
  }
  CHECK(distance(se3::exp({{0.3, 0.4, -0.2, 0.5, 0.2, -0.15}})) == doctest::Approx(1.44279264).epsilon(1e-8));
}

TEST_CASE("Tiny lateral offsets follow 4 pi |z|, and large ones their asymptote") {
  for (const double lateral : {1e-12, 1e-10, 1e-8, 1e-6}) {
    const double squared = std::pow(distance({{}, {{0.0, lateral, 0.0}}}), 2);
    CHECK(squared == doctest::Approx(4.0 * pi * lateral).epsilon(2.0 * std::sqrt(lateral) + 1e-9));
  }
  // |x - 2 e_1| + 2, less what falls like exp(-d)
  for (const double lateral : {10.0, 20.0, 50.0, 300.0}) {
    const double asymptote = std::hypot(lateral, 2.0) + 2.0;
    CHECK(distance({{}, {{0.0, lateral, 0.0}}}) ==
          doctest::Approx(asymptote).epsilon(20.0 * std::exp(-asymptote) + 1e-12));
  }
}

TEST_CASE("The far field tells long geodesics up to what falls exponentially, with roll and bends") {
  Random random(14);
  int compared = 0, shorter = 0;
  for (int k = 0; k < repeats(3, 30, 200); ++k) {
    const double compliance = k % 3 == 0 ? 0.3 : 0.0;
    const Weights weights{0.5 + random.uniform(), compliance};
    const Se3 target{random.frame(1.0).rotation, 14.0 * normalized(se3::linear(random.twist()))};
    const FarField forward = far_field(target, weights, false, 0), backward = far_field(target, weights, true, 0);
    REQUIRE((forward.exists && backward.exists));
    const double asymptote = std::sqrt(std::min(forward.squared, backward.squared));
    const double found = distance(target, weights);
    // Nearly half a turn of roll may go the other way round.
    if (std::fabs(forward.roll) > 2.6 || std::fabs(backward.roll) > 2.6) continue;
    ++compared;
    const double bound = 60.0 * std::exp(-std::sqrt(1.0 - compliance) * asymptote);
    CHECK(found < asymptote + bound);
    shorter += found < asymptote - bound;
  }
  CHECK(compared > 1);
  // Another way round may be a little shorter than both: of 1 pair in the whole run, by 5e-3.
  CHECK(100 * shorter <= compared);
}

TEST_CASE("The nilpotent distance is the limit of the exact one, with an error of first order") {
  Random random(15);
  double sum = 0.0;
  const int count = repeats(3, 15, 60);
  for (int k = 0; k < count; ++k) {
    Twist c = random.twist();
    c *= 0.8;
    double error[2];
    const double sizes[] = {0.04, 0.01};
    for (int i = 0; i < 2; ++i) {
      Twist scaled = sizes[i] * c;
      scaled[4] *= sizes[i], scaled[5] *= sizes[i];
      const NilpotentOffset offset{scaled[3], {{scaled[2], -scaled[1]}}, {{scaled[4], scaled[5]}}};
      const double nilpotent = nilpotent_distance(offset).squared + scaled[0] * scaled[0];
      error[i] = std::pow(distance(se3::exp(scaled)), 2) / nilpotent - 1.0;
      CHECK(std::fabs(error[i]) < 3.0 * sizes[i]);
    }
    REQUIRE(std::fabs(error[0]) > 1e-9);
    sum += std::log(std::fabs(error[0] / error[1])) / std::log(4.0);
  }
  // Odd orders vanish for some offsets, so that the mean may exceed one.
  MESSAGE("fitted order " << sum / count);
  CHECK(sum / count > 0.8);
  CHECK(sum / count < 2.2);
}

TEST_CASE("The Riemannian distance grows to the sub-Riemannian one as lateral motion gets dear") {
  Random random(16);
  for (int k = 0; k < repeats(1, 6, 30); ++k) {
    const Se3 target = se3::exp(random.dilated(0.6));
    double last = std::sqrt(isotropic_distance(target).squared);
    const double limit = distance(target);
    for (const double lateral : {2.0, 5.0, 20.0, 100.0, 1000.0}) {
      CAPTURE(lateral);
      const double now = distance(target, {1.0, 1.0 / (lateral * lateral)});
      CHECK(now >= last * (1.0 - 1e-10));
      CHECK(now <= limit * (1.0 + 1e-10));
      last = now;
    }
    CHECK(last == doctest::Approx(limit).epsilon(1e-3));
  }
}

TEST_CASE("Distances lie between their certified bounds") {
  Random random(17);
  double share = 0.0;
  int count = 0;
  for (int k = 0; k < repeats(5, 60, 1000); ++k) {
    const Weights weights{k % 2 == 0 ? 1.0 : 0.3 + random.uniform(), k % 3 == 0 ? 0.1 * random.uniform() : 0.0};
    const Se3 target = k % 4 == 0 ? random.frame(4.0) : se3::exp(random.dilated(0.2 + random.uniform()));
    const DistanceBounds bounds = distance_bounds(target, weights);
    const double d = distance(target, weights);
    CHECK(bounds.lower > 0.0);
    CHECK(bounds.lower <= d * (1.0 + 1e-9));
    CHECK(bounds.upper >= d * (1.0 - 1e-9));
    if (weights.lateral_compliance == 0.0) share += bounds.lower / d, ++count;
  }
  MESSAGE("without lateral motion the lower bound is " << share / count << " of the distance on average");
}
