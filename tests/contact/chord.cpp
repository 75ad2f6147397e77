#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/contact/gap.hpp"
#include "tests/contact/tubes.hpp"

namespace {

using namespace bowstring::contact;
using namespace bowstring::contact::testing;

constexpr Interpolation spline = Interpolation::spline;

/// A chord of a wire in a tube; the unknowns are its two nodes and the tube's.
struct Chord {
  Tube tube;
  std::vector<double> ends;
  double radius[2] = {0.4, 0.7};
  GapForm form = GapForm::squared;
  double sign = 1.0;
  double start = 0.0;

  int size() const { return static_cast<int>(ends.size() + tube.points.size()); }
  double& unknown(int k) {
    const auto own = static_cast<int>(ends.size());
    return k < own ? ends[static_cast<std::size_t>(k)] : tube.points[static_cast<std::size_t>(k - own)];
  }
  WirePoint point() const {
    WirePoint out;
    out.nodes = 2;
    out.points = ends.data();
    std::copy_n(radius, 2, out.radius);
    return out;
  }
  double gap(double t) const {
    WirePoint at = point();
    at.t = t;
    double x[3] = {};
    at.position(tube.dimension, x);
    return closest(tube.view(spline), x, at.shape(form), whole(tube.view(spline)), start).gap;
  }
  ChordExtremum extremum() const {
    return chord_extremum(tube.view(spline), point(), form, sign, whole(tube.view(spline)), start);
  }
  double value() const { return extremum().closest.gap; }

  /// Gradient, and weight·∇²h as a full matrix.
  void derivatives(double weight, std::vector<double>& gradient, std::vector<double>& hessian) const {
    const ChordExtremum at = extremum();
    WirePoint where = point();
    where.t = at.t;
    where.extremal = at.interior;
    const auto n = static_cast<std::size_t>(size());
    const int dim = tube.dimension;
    double local[3 * (2 + max_stencil)];
    std::vector<double> packed(24 * 25 / 2);
    const NodeRange nodes = gap_derivatives(tube.view(spline), where, form, at.closest, local, weight, packed.data());
    const auto spread = [&](int k) { return static_cast<std::size_t>(k < 2 * dim ? k : k + nodes.first * dim); };
    gradient.assign(n, 0.0);
    hessian.assign(n * n, 0.0);
    std::size_t entry = 0;
    for (int row = 0; row < (2 + nodes.count) * dim; ++row) {
      gradient[spread(row)] = local[row];
      for (int column = 0; column <= row; ++column, ++entry) {
        hessian[spread(row) * n + spread(column)] = hessian[spread(column) * n + spread(row)] = packed[entry];
      }
    }
  }
};

/// Ends at `share` of the lumen radius on the inner side of the tube's bends or on the outer one (share < 0).
Chord chord_near_wall(int dimension, double share, double sigma, double length, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  Chord out;
  out.tube = crooked_tube(dimension, 10, random);
  out.start = sigma;
  for (const double place : {sigma, sigma + length}) {
    const CurvePoint q = evaluate(out.tube.view(spline), coordinate(place, 10));
    double across[3] = {};
    const double along = dot(q.second, q.slope, dimension) / dot(q.slope, q.slope, dimension);
    for (int k = 0; k < dimension; ++k) across[k] = q.second[k] - along * q.slope[k];
    const double norm_of = norm(across, dimension);
    for (int k = 0; k < dimension; ++k) {
      out.ends.push_back(q.position[k] + (share + uniform(random) * 0.2) * q.radius * across[k] / norm_of);
    }
  }
  return out;
}

TEST_CASE("the extremum along a chord is that of dense samples") {
  std::mt19937 random(5);
  int interior = 0, at_end = 0;
  for (const int dimension : {2, 3}) {
    for (const double sign : {1.0, -1.0}) {
      for (int trial = 0; trial < 40; ++trial) {
        Chord chord = chord_near_wall(dimension, trial % 2 == 0 ? 0.8 : -0.8, 1.5 + 0.13 * trial, 0.8, random);
        chord.sign = sign;
        const ChordExtremum found = chord.extremum();
        REQUIRE(found.closest.location == Location::interior);
        double best = -1e300;
        for (int k = 0; k <= 400; ++k) best = std::max(best, sign * chord.gap(k / 400.0));
        CHECK(sign * found.closest.gap >= best - 1e-12);
        CHECK(sign * found.closest.gap <= best + 1e-4);
        CHECK(chord.gap(found.t) == doctest::Approx(found.closest.gap).epsilon(1e-12));
        if (found.interior) CHECK(found.bend <= 0.0);
        ++(found.interior ? interior : at_end);
      }
    }
  }
  CHECK(interior > 20);
  CHECK(at_end > 20);
}

/// A tube in the plane whose centerline is a wave of that length about the x axis, and a chord along its upper wall.
Chord chord_along_wave(double wave_length, double shift, double tilt) {
  constexpr double amplitude = 0.15, lumen = 3.0, from = -10.0, to = 30.0, begin = 6.0, length = 8.0;
  constexpr int nodes = 81;
  Chord out;
  out.tube = tube(
      [&](double x) -> std::vector<double> {
        return {x, amplitude * std::sin(2.0 * M_PI * (x + shift) / wave_length)};
      },
      from, to, nodes, lumen);
  out.radius[0] = out.radius[1] = 0.4;
  out.ends = {begin, lumen - 0.4 - tilt, begin + length, lumen - 0.4 + tilt};
  out.start = (begin - from) / (to - from) * (nodes - 1);
  return out;
}

TEST_CASE("a largest gap between the ends of a chord is found where the slopes at both ends hide it") {
  int same_way = 0, from_both = 0;
  for (const double wave_length : {8.0, 6.5}) {
    for (const double shift : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}) {
      for (const double tilt : {0.0, 0.05, 0.1, -0.05, -0.1}) {
        const Chord chord = chord_along_wave(wave_length, shift, tilt);
        constexpr int samples = 400;
        double gap[samples + 1], best = -1e300;
        int maxima = 0;
        for (int k = 0; k <= samples; ++k) gap[k] = chord.gap(static_cast<double>(k) / samples);
        for (int k = 1; k < samples; ++k) {
          if (gap[k] <= gap[k - 1] || gap[k] < gap[k + 1]) continue;
          ++maxima;
          best = std::max(best, gap[k]);
        }
        const double first = gap[1] - gap[0], last = gap[samples] - gap[samples - 1];
        if (maxima != 1 || (first > 0.0 && last < 0.0)) continue;
        const double rise = best - std::min(gap[0], gap[samples]);
        if (std::max(gap[0], gap[samples]) < -0.2 || rise < 1e-3) continue;
        ++(first * last > 0.0 ? same_way : from_both);
        CAPTURE(wave_length);
        CAPTURE(tilt);
        CAPTURE(shift);
        const ChordExtremum found = chord.extremum();
        CHECK(found.interior);
        CHECK(found.closest.gap == doctest::Approx(best).epsilon(1e-4));
      }
    }
  }
  CHECK(same_way > 5);
  CHECK(from_both > 0);
}

TEST_CASE("a row whose largest gap vanishes between the ends keeps its place, and one by an end goes there") {
  std::mt19937 random(5);
  int kept = 0, left = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Chord chord = chord_near_wall(3, trial % 2 == 0 ? 0.8 : -0.8, 1.5 + 0.1 * trial, 0.8, random);
    if (chord.extremum().interior) continue;
    const bool first_is_larger = chord.gap(0.0) >= chord.gap(1.0);
    for (const double t : {0.2, 0.8}) {
      WirePoint standing = chord.point();
      standing.t = t;
      const ChordExtremum found = chord_extremum(chord.tube.view(spline), standing, chord.form, 1.0,
                                                 whole(chord.tube.view(spline)), chord.start);
      const bool nearer = first_is_larger == (t < 0.5);
      CHECK(found.t == (nearer ? (first_is_larger ? 0.0 : 1.0) : t));
      CHECK_FALSE(found.interior);
      ++(nearer ? left : kept);
    }
  }
  CHECK(kept > 10);
  CHECK(left > 10);
}

TEST_CASE("the largest gap of a part of a chord lies in it, and the largest of all parts is the chord's") {
  std::mt19937 random(17);
  int interior = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Chord chord = chord_near_wall(trial % 2 == 0 ? 2 : 3, 0.8, 2.0 + 0.02 * trial, 0.8, random);
    const ChordExtremum whole_chord = chord.extremum();
    if (!whole_chord.interior) continue;
    REQUIRE(whole_chord.closest.gap != 0.0);
    double largest = std::max(chord.gap(0.0), chord.gap(1.0));
    for (int k = 0; k < 4; ++k) {
      const ChordPart part{0.25 * k, 0.25 * (k + 1)};
      WirePoint point = chord.point();
      point.t = part.middle();
      const ChordExtremum found = chord_extremum(chord.tube.view(spline), point, chord.form, 1.0,
                                                 whole(chord.tube.view(spline)), chord.start, part);
      CHECK(found.t >= part.low);
      CHECK(found.t <= part.high);
      CHECK(found.interior == (whole_chord.t > part.low && whole_chord.t < part.high));
      largest = std::max({largest, chord.gap(part.low), found.closest.gap});
      interior += found.interior ? 1 : 0;
    }
    CHECK(largest == doctest::Approx(whole_chord.closest.gap).epsilon(1e-10));
  }
  CHECK(interior > 10);
}

TEST_CASE("gradient and Hessian of a chord's extreme gap agree with differences") {
  std::mt19937 random(11);
  int interior = 0, at_end = 0;
  for (const int dimension : {2, 3}) {
    for (const GapForm form : {GapForm::squared, GapForm::distance, GapForm::smooth_distance}) {
      for (int trial = 0; trial < 16; ++trial) {
        Chord chord = chord_near_wall(dimension, trial % 2 == 0 ? 0.8 : -0.8, 2.0 + 0.3 * trial, 0.8, random);
        chord.form = form;
        chord.sign = trial % 4 < 2 ? 1.0 : -1.0;
        const ChordExtremum at = chord.extremum();
        if (at.closest.location != Location::interior || at.closest.distance < 0.5) continue;
        if (at.interior && std::abs(at.t - 0.5) > 0.45) continue;  // about to stop at an end
        ++(at.interior ? interior : at_end);
        const double weight = -1.7, step = 1e-5;
        std::vector<double> gradient, hessian, high_gradient, low_gradient, ignored;
        chord.derivatives(weight, gradient, hessian);
        double size = 0.0, hessian_size = 0.0, error = 0.0, hessian_error = 0.0;
        const auto n = static_cast<std::size_t>(chord.size());
        for (std::size_t k = 0; k < n; ++k) {
          double& unknown = chord.unknown(static_cast<int>(k));
          const double kept = unknown;
          unknown = kept + step;
          const double high = chord.value();
          chord.derivatives(weight, high_gradient, ignored);
          unknown = kept - step;
          const double low = chord.value();
          chord.derivatives(weight, low_gradient, ignored);
          unknown = kept;
          size = std::max(size, std::abs(gradient[k]));
          error = std::max(error, std::abs((high - low) / (2.0 * step) - gradient[k]));
          for (std::size_t i = 0; i < n; ++i) {
            hessian_size = std::max(hessian_size, std::abs(hessian[i * n + k]));
            const double difference = weight * (high_gradient[i] - low_gradient[i]) / (2.0 * step);
            hessian_error = std::max(hessian_error, std::abs(difference - hessian[i * n + k]));
          }
        }
        CAPTURE(dimension);
        CAPTURE(static_cast<int>(form));
        CAPTURE(at.interior);
        CAPTURE(at.t);
        REQUIRE(size > 1e-3);
        REQUIRE(hessian_size > 1e-3);
        CHECK(error < 1e-7 * size);
        CHECK(hessian_error < 1e-5 * hessian_size);
      }
    }
  }
  CHECK(interior > 15);
  CHECK(at_end > 15);
}

TEST_CASE("a chord whose wall point leaves the window says so") {
  std::mt19937 random(3);
  const Chord chord = chord_near_wall(3, 0.8, 4.0, 0.8, random);
  const ChordExtremum found =
      chord_extremum(chord.tube.view(spline), chord.point(), chord.form, 1.0, {1.0, 3.0}, chord.start);
  CHECK(found.closest.location == Location::window_edge);
}

TEST_CASE("a given place is taken as it is") {
  std::mt19937 random(3);
  const Tube tube = crooked_tube(3, 8, random);
  const double x[3] = {9.0, 1.0, 2.0};
  const ClosestPoint at = gap_at(tube.view(spline), x, {GapForm::squared, 0.4}, coordinate(3.0, 8));
  CHECK(at.at.sigma() == 3.0);
  CHECK(at.location == Location::vertex);
  const CurvePoint q = evaluate(tube.view(spline), at.at);
  const double r[3] = {x[0] - q.position[0], x[1] - q.position[1], x[2] - q.position[2]};
  CHECK(at.distance == doctest::Approx(norm(r, 3)));
  CHECK(at.clearance == doctest::Approx(q.radius - 0.4));
}

}  // namespace
