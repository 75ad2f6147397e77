#include "core/contact/gap.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/contact/tubes.hpp"

namespace {

using namespace bowstring::contact;
using namespace bowstring::contact::testing;

constexpr GapForm all_forms[] = {GapForm::squared, GapForm::distance, GapForm::smooth_distance};
constexpr Interpolation both[] = {Interpolation::polyline, Interpolation::spline};

/// h as a function of z = (x, all nodes) of one row, with its derivatives spread over all of z.
struct Row {
  Tube tube;
  std::vector<double> x;
  GapShape shape;
  Interpolation interpolation;
  Window window;
  double start;

  int size() const { return static_cast<int>(x.size() + tube.points.size()); }
  double& unknown(int k) {
    const int dim = tube.dimension;
    return k < dim ? x[static_cast<std::size_t>(k)] : tube.points[static_cast<std::size_t>(k - dim)];
  }
  ClosestPoint closest() const {
    return bowstring::contact::closest(tube.view(interpolation), x.data(), shape, window, start);
  }
  double value() const { return closest().gap; }

  std::vector<double> gradient() const {
    const ClosestPoint at = closest();
    double local[3 * (1 + max_stencil)];
    const NodeRange nodes = gap_derivatives(tube.view(interpolation), x.data(), shape, at, local, 1.0, nullptr);
    std::vector<double> out(static_cast<std::size_t>(size()), 0.0);
    for (int k = 0; k < (1 + nodes.count) * tube.dimension; ++k) out[spread(k, nodes)] = local[k];
    return out;
  }

  /// weight·∇²h as a full matrix.
  std::vector<double> hessian(double weight) const {
    const ClosestPoint at = closest();
    std::vector<double> packed(3 * 7 * (3 * 7 + 1) / 2);
    const NodeRange nodes =
        gap_derivatives(tube.view(interpolation), x.data(), shape, at, nullptr, weight, packed.data());
    const std::size_t n = static_cast<std::size_t>(size());
    std::vector<double> out(n * n, 0.0);
    std::size_t entry = 0;
    for (int row = 0; row < (1 + nodes.count) * tube.dimension; ++row) {
      for (int column = 0; column <= row; ++column, ++entry) {
        const std::size_t i = spread(row, nodes), j = spread(column, nodes);
        out[i * n + j] = out[j * n + i] = packed[entry];
      }
    }
    return out;
  }

 private:
  std::size_t spread(int k, NodeRange nodes) const {
    const int dim = tube.dimension;
    return static_cast<std::size_t>(k < dim ? k : k + nodes.first * dim);
  }
};

double largest(const std::vector<double>& v) {
  double out = 0.0;
  for (const double a : v) out = std::max(out, std::abs(a));
  return out;
}

/// Largest error of gradient and Hessian against central differences, relative to their largest entries.
struct DerivativeErrors {
  double gradient, hessian, gradient_size, hessian_size;
};

DerivativeErrors derivative_errors(Row row) {
  const int n = row.size();
  const std::vector<double> gradient = row.gradient();
  const double weight = -1.7;
  const std::vector<double> hessian = row.hessian(weight);
  DerivativeErrors out{0.0, 0.0, largest(gradient), largest(hessian)};
  const double step = 2e-5;
  for (int k = 0; k < n; ++k) {
    double& unknown = row.unknown(k);
    const double kept = unknown;
    unknown = kept + step;
    const double high = row.value();
    const std::vector<double> gradient_high = row.gradient();
    unknown = kept - step;
    const double low = row.value();
    const std::vector<double> gradient_low = row.gradient();
    unknown = kept;
    const std::size_t column = static_cast<std::size_t>(k), m = static_cast<std::size_t>(n);
    out.gradient = std::max(out.gradient, std::abs((high - low) / (2.0 * step) - gradient[column]));
    for (std::size_t i = 0; i < m; ++i) {
      const double difference = weight * (gradient_high[i] - gradient_low[i]) / (2.0 * step);
      out.hessian = std::max(out.hessian, std::abs(difference - hessian[i * m + column]));
    }
  }
  out.gradient /= out.gradient_size;
  out.hessian /= out.hessian_size;
  return out;
}

/// A point off the curve at σ, across it, at `share` of the lumen radius.
std::vector<double> point_across(const Tube& tube, Interpolation interpolation, double sigma, double share,
                                 std::mt19937& random) {
  std::normal_distribution<double> normal;
  const int dim = tube.dimension;
  const CurvePoint q = evaluate(tube.view(interpolation), coordinate(sigma, tube.nodes()));
  double across[3] = {};
  for (int k = 0; k < dim; ++k) across[k] = normal(random);
  const double along = dot(across, q.slope, dim) / dot(q.slope, q.slope, dim);
  for (int k = 0; k < dim; ++k) across[k] -= along * q.slope[k];
  const double length = norm(across, dim);
  std::vector<double> x;
  for (int k = 0; k < dim; ++k) x.push_back(q.position[k] + share * q.radius * across[k] / length);
  return x;
}

void check_derivatives(const Row& row, double hessian_tolerance = 1e-7) {
  const DerivativeErrors errors = derivative_errors(row);
  REQUIRE(errors.gradient_size > 1e-3);
  REQUIRE(errors.hessian_size > 1e-3);
  CHECK(errors.gradient < 1e-8);
  CHECK(errors.hessian < hessian_tolerance);
}

}  // namespace

TEST_CASE("gap forms: derivatives in r and c") {
  for (const GapForm form : all_forms) {
    for (const double c : {0.7, 5.5}) {
      for (const double r : {0.3, 20.0}) {
        const double step = 1e-5;
        const GapFormValue f = gap_form(form, r, c);
        const GapFormValue r0 = gap_form(form, r - step, c), r1 = gap_form(form, r + step, c);
        const GapFormValue c0 = gap_form(form, r, c - step), c1 = gap_form(form, r, c + step);
        REQUIRE(std::abs(f.r) > 1e-3);
        REQUIRE(std::abs(f.c) > 1e-3);
        CHECK(f.r == doctest::Approx((r1.value - r0.value) / (2 * step)).epsilon(1e-8));
        CHECK(f.c == doctest::Approx((c1.value - c0.value) / (2 * step)).epsilon(1e-8));
        CHECK(f.rr == doctest::Approx((r1.r - r0.r) / (2 * step)).epsilon(1e-7));
        CHECK(f.rc == doctest::Approx((r1.c - r0.c) / (2 * step)).epsilon(1e-7));
        CHECK(f.rc == doctest::Approx((c1.r - c0.r) / (2 * step)).epsilon(1e-7));
        CHECK(f.cc == doctest::Approx((c1.c - c0.c) / (2 * step)).epsilon(1e-7));
      }
    }
  }
}

TEST_CASE("gap forms: one zero set, and the singular places") {
  CHECK(std::abs(gap_form(GapForm::squared, 25.0, 5.0).value) < 1e-15);
  CHECK(std::abs(gap_form(GapForm::distance, 25.0, 5.0).value) < 1e-15);
  CHECK(gap_form(GapForm::smooth_distance, 25.0, 5.0).value < 0.0);
  CHECK(gap_form(GapForm::smooth_distance, 25.0, 5.0).value > -gap_smoothing);
  CHECK(std::isnan(gap_form(GapForm::squared, 1.0, 0.0).value));
  CHECK(std::isnan(gap_form(GapForm::squared, 1.0, -1.0).value));
  CHECK(gap_form(GapForm::smooth_distance, 1.0, -1.0).value == doctest::Approx(2.0).epsilon(1e-3));
  CHECK(gap_form(GapForm::distance, 0.0, 5.0).value == -5.0);
  CHECK(gap_form(GapForm::distance, 0.0, 5.0).r == 0.0);
  CHECK(gap_form(GapForm::squared, 0.0, 5.0).value == -2.5);
}

TEST_CASE("gradient and Hessian of the gap agree with differences") {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int nodes = 9;
  for (const Interpolation interpolation : both) {
    for (const int dimension : {2, 3}) {
      for (const GapForm form : all_forms) {
        int tested = 0;
        for (int segment = 0; segment < nodes - 1; ++segment) {
          const Tube tube = crooked_tube(dimension, nodes, random);
          const double sigma = segment + 0.2 + 0.6 * uniform(random);
          Row row{tube,
                  point_across(tube, interpolation, sigma, 0.2 + 0.9 * uniform(random), random),
                  {form, 0.4445},
                  interpolation,
                  {0.0, nodes - 1.0},
                  sigma};
          const ClosestPoint at = row.closest();
          if (at.location != Location::interior) continue;
          if (interpolation == Interpolation::polyline && std::abs(at.at.u - 0.5) > 0.49) continue;
          CAPTURE(static_cast<int>(interpolation));
          CAPTURE(dimension);
          CAPTURE(static_cast<int>(form));
          CAPTURE(at.at.sigma());
          check_derivatives(row);
          ++tested;
        }
        CHECK(tested >= 4);
      }
    }
  }
}

TEST_CASE("derivatives at the curve's ends, at a knot, and on tiny curves") {
  std::mt19937 random(22);
  for (const int dimension : {2, 3}) {
    for (const GapForm form : all_forms) {
      CAPTURE(dimension);
      CAPTURE(static_cast<int>(form));
      for (const Interpolation interpolation : both) {
        const Tube tube = crooked_tube(dimension, 7, random);
        const Centerline curve = tube.view(interpolation);
        for (const double end : {0.0, 6.0}) {
          Row row{tube, point_across(tube, interpolation, end, 0.6, random), {form, 0.4}, interpolation, {0.0, 6.0},
                  end};
          const CurvePoint q = evaluate(curve, coordinate(end, 7));
          const double outward = (end > 0.0 ? 6.0 : -6.0) / norm(q.slope, 3);
          for (int k = 0; k < dimension; ++k) row.x[static_cast<std::size_t>(k)] += outward * q.slope[k];
          REQUIRE(row.closest().location == Location::curve_end);
          CHECK(row.closest().at.sigma() == end);
          check_derivatives(row);
        }
      }
      const Tube tube = crooked_tube(dimension, 7, random);
      Row at_knot{tube,        point_across(tube, Interpolation::spline, 3.0, 0.7, random),
                  {form, 0.4}, Interpolation::spline,
                  {0.0, 6.0},  3.0};
      std::fill(at_knot.tube.radius.begin(), at_knot.tube.radius.end(), 6.0);
      REQUIRE(std::abs(at_knot.closest().at.sigma() - 3.0) < 1e-9);
      // The Hessian is continuous at a knot but has a kink, which a central difference sees to first order.
      check_derivatives(at_knot, 1e-5);

      for (const int nodes : {3, 4}) {
        const Tube tiny = crooked_tube(dimension, nodes, random);
        Row row{tiny,
                point_across(tiny, Interpolation::spline, 1.3, 0.4, random),
                {form, 0.4},
                Interpolation::spline,
                {0.0, nodes - 1.0},
                1.0};
        if (row.closest().location == Location::interior) check_derivatives(row);
      }
    }
  }
}

TEST_CASE("a wire on the centerline: the squared gap is smooth there") {
  std::mt19937 random(23);
  for (const int dimension : {2, 3}) {
    const Tube tube = crooked_tube(dimension, 8, random);
    const CurvePoint q = evaluate(tube.view(Interpolation::spline), {3, 0.4});
    Row row{tube, {q.position, q.position + dimension}, {GapForm::squared, 0.0}, Interpolation::spline, {0.0, 7.0},
            3.4};
    check_derivatives(row);
    const ClosestPoint at = row.closest();
    CHECK(at.gap == doctest::Approx(-0.5 * at.clearance).epsilon(0.05));
    row.shape.form = GapForm::smooth_distance;
    CHECK(std::isfinite(largest(row.hessian(1.0))));
    row.shape.form = GapForm::distance;
    CHECK(std::isfinite(row.value()));
    CHECK(std::isfinite(largest(row.hessian(1.0))));
  }
}

TEST_CASE("the multiplier is the force: |∂h/∂x| = 1 at contact with a radius that varies") {
  std::mt19937 random(24);
  int tested = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Tube tube = crooked_tube(3, 12, random);
    const CurvePoint q = evaluate(tube.view(Interpolation::spline), {5, 0.3});
    const std::vector<double> outside = point_across(tube, Interpolation::spline, 5.3, 1.2, random);
    Row row{tube, outside, {GapForm::squared, 0.4}, Interpolation::spline, {0.0, 11.0}, 5.3};
    if (row.value() <= 0.0) continue;
    double inside = 0.0, beyond = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + beyond);
      for (std::size_t k = 0; k < 3; ++k) row.x[k] = (1.0 - middle) * q.position[k] + middle * outside[k];
      (row.value() < 0.0 ? inside : beyond) = middle;
    }
    const ClosestPoint at = row.closest();
    REQUIRE(std::abs(at.gap) < 1e-12);
    REQUIRE(at.location == Location::interior);
    CHECK(at.distance == doctest::Approx(at.clearance).epsilon(1e-12));
    CHECK(norm(row.gradient().data(), 3) == doctest::Approx(1.0).epsilon(1e-12));
    for (const GapForm form : {GapForm::distance, GapForm::smooth_distance}) {
      Row other = row;
      other.shape.form = form;
      CHECK(std::abs(other.value()) <= gap_smoothing);
    }
    ++tested;
  }
  CHECK(tested >= 10);
}

TEST_CASE("the force is objective: gradients over x and nodes sum to zero") {
  std::mt19937 random(25);
  const Tube tube = crooked_tube(3, 9, random);
  Row row{tube,
          point_across(tube, Interpolation::spline, 4.4, 0.9, random),
          {GapForm::squared, 0.4},
          Interpolation::spline,
          {0.0, 8.0},
          4.4};
  const std::vector<double> gradient = row.gradient();
  REQUIRE(largest(gradient) > 0.1);
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0.0;
    for (std::size_t i = k; i < gradient.size(); i += 3) sum += gradient[i];
    CHECK(std::abs(sum) < 1e-14);
  }
}

TEST_CASE("a straight vessel gives the exact answers") {
  const Tube straight = tube(line, 0.0, 50.0, 11, 6.0);
  for (const Interpolation interpolation : both) {
    const Centerline curve = straight.view(interpolation);
    const double x[] = {23.0, 4.0};
    const ClosestPoint at = closest(curve, x, {GapForm::squared, 0.5}, whole(curve), 4.0);
    CHECK(at.location == Location::interior);
    CHECK(at.at.sigma() == doctest::Approx(4.6).epsilon(1e-14));
    CHECK(at.distance == doctest::Approx(4.0).epsilon(1e-14));
    CHECK(at.gap == doctest::Approx((16.0 - 5.5 * 5.5) / 11.0).epsilon(1e-14));
    CHECK(closest(curve, x, {GapForm::distance, 0.5}, whole(curve), 4.0).gap == doctest::Approx(-1.5));

    const double beyond[] = {53.0, 4.0};
    const ClosestPoint end = closest(curve, beyond, {GapForm::distance, 0.0}, whole(curve), 8.0);
    CHECK(end.location == Location::curve_end);
    CHECK(end.at.sigma() == 10.0);
    CHECK(end.distance == doctest::Approx(5.0));
  }
}

TEST_CASE("a cone gives the exact distance to its wall") {
  // Envelope of the spheres of radius R₀ + a s: h = ρ √(1 − a²) − R₀ − a s_x.
  Tube cone = tube(line, 0.0, 50.0, 11, 0.0);
  const double a = 0.2;
  for (int i = 0; i < 11; ++i) cone.radius[static_cast<std::size_t>(i)] = 4.0 + a * 5.0 * i;
  for (const Interpolation interpolation : both) {
    const Centerline curve = cone.view(interpolation);
    const double x[] = {22.0, 7.0};
    const ClosestPoint at = closest(curve, x, {GapForm::distance, 0.0}, whole(curve), 4.0);
    CHECK(at.gap == doctest::Approx(7.0 * std::sqrt(1.0 - a * a) - 4.0 - a * 22.0).epsilon(1e-12));
    CHECK(5.0 * at.at.sigma() == doctest::Approx(22.0 + 7.0 * a / std::sqrt(1.0 - a * a)).epsilon(1e-12));

    const double wall[] = {22.0, (4.0 + a * 22.0) / std::sqrt(1.0 - a * a)};
    CHECK(std::abs(closest(curve, wall, {GapForm::squared, 0.0}, whole(curve), 4.0).gap) < 1e-13);
  }
}

TEST_CASE("σ* is exact to rounding from any start on its branch, far from the origin too") {
  std::mt19937 random(26);
  for (int trial = 0; trial < 20; ++trial) {
    Tube tube = crooked_tube(3, 40, random);
    for (double& coordinate : tube.points) coordinate += 500.0;
    const Centerline curve = tube.view(Interpolation::spline);
    const std::vector<double> x = point_across(tube, Interpolation::spline, 19.6, 0.7, random);
    for (const GapForm form : all_forms) {
      const GapShape shape{form, 0.4};
      const ClosestPoint reference = closest(curve, x.data(), shape, whole(curve), 19.6);
      REQUIRE(reference.location == Location::interior);
      for (const double start : {18.9, 19.0, 19.5, 20.0, 20.3}) {
        const ClosestPoint at = closest(curve, x.data(), shape, whole(curve), start);
        CHECK(std::abs(at.at.sigma() - reference.at.sigma()) < 1e-13);
      }
      // φ_σ, formed anew, vanishes beside its own terms.
      const CurvePoint q = segment_polynomial(curve, reference.at.segment, x.data()).at(reference.at.u);
      const GapFormValue f = gap_form(form, dot(q.position, q.position, 3), q.radius - 0.4);
      const double wall = f.c * q.radius_slope, line = 2.0 * f.r * dot(q.position, q.slope, 3);
      CHECK(std::abs(wall + line) < 1e-14 * 2.0 * f.r * norm(q.position, 3) * norm(q.slope, 3) + 1e-15);
    }
  }
}

TEST_CASE("the polyline's minimum over a window is exact") {
  std::mt19937 random(27);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int vertices = 0, interiors = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Tube tube = crooked_tube(2, 12, random);
    const Centerline curve = tube.view(Interpolation::polyline);
    const double x[] = {22.0 + 10.0 * uniform(random), 10.0 * uniform(random)};
    const GapShape shape{all_forms[trial % 3], 0.4};
    const ClosestPoint at = closest(curve, x, shape, whole(curve), 0.0);
    vertices += at.location == Location::vertex;
    interiors += at.location == Location::interior;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 11 * 1000; ++k) {
      const CurvePoint q = evaluate(curve, coordinate(k / 1000.0, 12));
      const double d[] = {x[0] - q.position[0], x[1] - q.position[1]};
      least = std::min(least, gap_form(shape.form, dot(d, d, 2), q.radius - 0.4).value);
    }
    CHECK(at.gap <= least + 1e-12);
    CHECK(std::abs(at.gap - least) < 3e-3);
    if (at.location == Location::vertex) CHECK(at.at.sigma() == std::round(at.at.sigma()));
  }
  CHECK(vertices > 4);
  CHECK(interiors > 100);
}

TEST_CASE("the spline's search follows its branch") {
  const Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0 + 8.0 * M_PI, 73, 6.0);
  const Centerline curve = vessel.view(Interpolation::spline);
  const double x[] = {30.0, 1.0};
  const GapShape shape{GapForm::squared, 0.0};
  const ClosestPoint upper = closest(curve, x, shape, whole(curve), 12.0);
  const ClosestPoint lower = closest(curve, x, shape, whole(curve), 60.0);
  CHECK(upper.distance == doctest::Approx(7.0));
  CHECK(lower.distance == doctest::Approx(9.0));
  CHECK(globally_closest(curve, x, shape).at.sigma() == doctest::Approx(upper.at.sigma()));
  const double other[] = {30.0, -1.0};
  CHECK(globally_closest(curve, other, shape).at.sigma() == doctest::Approx(lower.at.sigma()));
}

TEST_CASE("the spline's search never climbs and passes no minimum") {
  std::mt19937 random(30);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int nodes = 12, fine = 1000;
  int walked = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Tube tube = crooked_tube(2, nodes, random);
    for (double& coordinate : tube.points) coordinate += 2.5 * uniform(random);
    const Centerline curve = tube.view(Interpolation::spline);
    const double x[] = {22.0 + 15.0 * uniform(random), 10.0 * uniform(random)};
    const double start = 5.5 + 5.0 * uniform(random);
    const GapShape shape{GapForm::squared, 0.4};
    const ClosestPoint at = closest(curve, x, shape, whole(curve), start);
    const double length = at.at.sigma() - start;
    walked += std::abs(length) > 1.0;
    double last = std::numeric_limits<double>::infinity();
    bool falls = true;
    for (int k = 0; k <= fine; ++k) {
      const CurvePoint q = evaluate(curve, coordinate(start + length * k / fine, nodes));
      const double d[] = {x[0] - q.position[0], x[1] - q.position[1]};
      const double here = gap_form(shape.form, dot(d, d, 2), q.radius - 0.4).value;
      falls = falls && here <= last + 1e-12;
      last = here;
    }
    CHECK(falls);
  }
  CHECK(walked > 30);
}

TEST_CASE("a global search finds the least of many minima") {
  std::mt19937 random(28);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const Tube tube = crooked_tube(3, 15, random);
    const double x[] = {28.0 + 34.0 * uniform(random), 15.0 * uniform(random), 10.0 * uniform(random)};
    for (const Interpolation interpolation : both) {
      const Centerline curve = tube.view(interpolation);
      const ClosestPoint at = globally_closest(curve, x, {GapForm::squared, 0.0});
      double least = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= 14 * 200; ++k) {
        const CurvePoint q = evaluate(curve, coordinate(k / 200.0, 15));
        const double d[] = {x[0] - q.position[0], x[1] - q.position[1], x[2] - q.position[2]};
        least = std::min(least, gap_form(GapForm::squared, dot(d, d, 3), q.radius).value);
      }
      CHECK(at.gap <= least + 1e-12);
      CHECK(at.location != Location::window_edge);
    }
  }
}

TEST_CASE("a closest point that leaves its window says so and keeps to the window's nodes") {
  const Tube straight = tube(line, 0.0, 50.0, 21, 6.0);
  for (const Interpolation interpolation : both) {
    const Centerline curve = straight.view(interpolation);
    const Window window = window_around(10.4, 2, 21);
    CHECK(window.low == 8.0);
    CHECK(window.high == 13.0);
    const NodeRange nodes = window_nodes(interpolation, window, 21);
    CHECK(nodes.first == (interpolation == Interpolation::spline ? 6 : 8));
    CHECK(nodes.first + nodes.count == (interpolation == Interpolation::spline ? 16 : 14));
    for (const double along : {15.0, 21.0, 24.0, 26.0, 31.0, 40.0}) {
      const double x[] = {along, 3.0};
      const ClosestPoint at = closest(curve, x, {GapForm::squared, 0.0}, window, 10.4);
      const bool left = along / 2.5 < 8.0 || along / 2.5 > 13.0;
      CHECK((at.location == Location::window_edge) == left);
      CHECK(at.at.sigma() == doctest::Approx(std::clamp(along / 2.5, 8.0, 13.0)));
      const NodeRange used = gap_derivatives(curve, x, {GapForm::squared, 0.0}, at, nullptr, 0.0, nullptr);
      CHECK(used.first >= nodes.first);
      CHECK(used.first + used.count <= nodes.first + nodes.count);
    }
  }
  CHECK(window_around(0.3, 2, 21).low == 0.0);
  CHECK(window_around(20.0, 2, 21).high == 20.0);
}

TEST_CASE("NaN gives NaN and the search ends") {
  Tube vessel = tube(hairpin(60.0, 8.0), 0.0, 120.0, 40, 6.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double x[] = {nan, 1.0}, good[] = {3.0, 1.0};
  for (const Interpolation interpolation : both) {
    const Centerline curve = vessel.view(interpolation);
    for (const GapForm form : all_forms) {
      CHECK(std::isnan(closest(curve, x, {form, 0.0}, whole(curve), 5.0).gap));
      CHECK(std::isnan(globally_closest(curve, x, {form, 0.0}).gap));
      CHECK(std::isfinite(closest(curve, good, {form, 0.0}, {nan, nan}, nan).gap));
    }
  }
  vessel.radius[20] = -3.0;
  const Centerline curve = vessel.view(Interpolation::spline);
  CHECK(std::isnan(closest(curve, vessel.node(20), {GapForm::squared, 0.0}, whole(curve), 20.0).gap));
}

TEST_CASE("a wire binds monotone along the vessel, in either direction") {
  // Adjacent turns are 5 mm apart, the points up to 3.3 mm off along each axis: the nearest place is often on
  // the wrong turn.
  const auto turns = [](double angle) { return helix(angle, 15.0, 5.0); };
  const Tube vessel = tube(turns, 0.0, 6.0 * M_PI, 181, 3.0);
  std::mt19937 random(29);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int count = 91;
  Tube wire = tube(turns, 0.3, 6.0 * M_PI - 0.3, count, 0.0);
  for (double& coordinate : wire.points) coordinate += 3.3 * uniform(random);

  for (const Interpolation interpolation : both) {
    const Centerline curve = vessel.view(interpolation);
    std::vector<double> sigma(count), reversed(count);
    bind_along(curve, wire.points.data(), count, sigma.data());
    int wrong_turns = 0;
    for (int i = 0; i < count; ++i) {
      const double expected = 180.0 * (0.3 + (6.0 * M_PI - 0.6) * i / (count - 1)) / (6.0 * M_PI);
      const std::size_t k = static_cast<std::size_t>(i);
      CHECK(std::abs(sigma[k] - expected) < 6.0);
      if (i > 0) CHECK(sigma[k] >= sigma[k - 1]);
      const ClosestPoint nearest = globally_closest(curve, wire.node(i), {GapForm::squared, 0.0});
      wrong_turns += std::abs(nearest.at.sigma() - expected) > 20.0;
    }
    REQUIRE(wrong_turns > 0);

    std::vector<double> backward;
    for (int i = count - 1; i >= 0; --i) backward.insert(backward.end(), wire.node(i), wire.node(i) + 3);
    bind_along(curve, backward.data(), count, reversed.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      CHECK(reversed[k] == doctest::Approx(sigma[static_cast<std::size_t>(count) - 1 - k]).epsilon(1e-3));
    }
  }
}
