#include "core/curve/spline_curve.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace {

using namespace bowstring;
using doctest::Approx;

struct Sample {
  std::vector<double> parameter, points;
};

/// A helix with a wobble that a smoothing spline has to leave.
Sample wobbly_helix(int count) {
  Sample sample;
  for (int i = 0; i < count; ++i) {
    const double t = i + 0.3 * std::sin(2.0 * i);
    sample.parameter.push_back(t);
    sample.points.push_back(30.0 * std::cos(0.12 * t) + 0.4 * std::sin(7.0 * i));
    sample.points.push_back(30.0 * std::sin(0.12 * t) + 0.4 * std::cos(5.0 * i));
    sample.points.push_back(2.0 * t + 0.4 * std::sin(11.0 * i));
  }
  return sample;
}

Sample polynomial(int degree) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0.3, 1.7);
  Sample sample;
  double t = 0.0;
  for (int i = 0; i < 30; ++i, t += step(random)) {
    sample.parameter.push_back(t);
    const double u = t / 15.0 - 1.0;
    sample.points.push_back(5.0 + 10.0 * std::pow(u, degree));
    sample.points.push_back(20.0 * u - 3.0 * u * u + 2.0 * std::pow(u, 3));
  }
  return sample;
}

double root_mean_square(const SplineCurve& curve, const Sample& sample) {
  const std::size_t d = static_cast<std::size_t>(curve.dimension());
  double sum = 0.0;
  for (std::size_t i = 0; i < sample.parameter.size(); ++i) {
    double point[3];
    curve.evaluate(sample.parameter[i], 0, point);
    for (std::size_t k = 0; k < d; ++k) sum += std::pow(point[k] - sample.points[i * d + k], 2);
  }
  return std::sqrt(sum / static_cast<double>(sample.parameter.size()));
}

SplineFit fitted(const Sample& sample, int dimension, int degree, double distance) {
  SplineFit fit;
  const Status status = fit_spline(sample.parameter, sample.points, dimension, degree, distance, fit);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return fit;
}

TEST_CASE("chord parameters have a mean step of 1") {
  CHECK(chord_parameters({0, 0, 3, 4, 3, 5}, 2) == std::vector<double>{0.0, 5.0 / 3.0, 2.0});
}

TEST_CASE("interpolation passes through every point") {
  const Sample sample = wobbly_helix(50);
  for (const int degree : {3, 5}) {
    const SplineFit fit = fitted(sample, 3, degree, 0.0);
    CAPTURE(degree);
    CHECK(root_mean_square(fit.curve, sample) < 1e-12);
    CHECK(fit.distance < 1e-12);
    CHECK(fit.curve.breaks().size() == 50 - static_cast<std::size_t>(degree) + 1);
  }
}

TEST_CASE("polynomials of the spline's degree are reproduced, interpolated or smoothed") {
  for (const int degree : {3, 5}) {
    const Sample sample = polynomial(degree);
    for (const double distance : {0.0, 0.1}) {
      const SplineFit fit = fitted(sample, 2, degree, distance);
      CAPTURE(degree);
      CAPTURE(distance);
      double largest = 0.0;
      for (double t = 0.0; t < sample.parameter.back(); t += 0.1) {
        double p[2];
        fit.curve.evaluate(t, 0, p);
        largest = std::max(largest, std::abs(p[0] - 5.0 - 10.0 * std::pow(t / 15.0 - 1.0, degree)));
      }
      CHECK(largest < 1e-9);
      CHECK(fit.distance < 1e-9);
    }
  }
}

TEST_CASE("smoothing leaves exactly the distance that it may") {
  const Sample sample = wobbly_helix(80);
  for (const int degree : {3, 5}) {
    for (const double distance : {0.02, 0.1, 0.3, 0.6, 2.0}) {
      const SplineFit fit = fitted(sample, 3, degree, distance);
      CAPTURE(degree);
      CHECK(fit.distance == distance);
      CHECK(root_mean_square(fit.curve, sample) == Approx(distance).epsilon(1e-8));
    }
  }
}

TEST_CASE("as the distance goes to 0 the smoothing spline becomes the interpolating one") {
  const Sample sample = wobbly_helix(40);
  const SplineFit through = fitted(sample, 3, 5, 0.0);
  double before = 1e300;
  for (const double distance : {1e-2, 1e-5, 1e-8}) {
    const SplineFit fit = fitted(sample, 3, 5, distance);
    double largest = 0.0;
    for (double t = 0.0; t < sample.parameter.back(); t += 0.1) {
      double a[3], b[3];
      through.curve.evaluate(t, 0, a);
      fit.curve.evaluate(t, 0, b);
      largest = std::max(largest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
    CAPTURE(distance);
    CHECK(largest < before);
    before = largest;
  }
  CHECK(before < 1e-6);
}

TEST_CASE("a distance beyond what one polynomial leaves gives that polynomial") {
  const SplineFit fit = fitted(wobbly_helix(80), 3, 5, 1000.0);
  CHECK(fit.curve.breaks().size() == 2);
  CHECK(fit.distance > 1.0);
  CHECK(fit.distance < 1000.0);
  CHECK(root_mean_square(fit.curve, wobbly_helix(80)) == Approx(fit.distance).epsilon(1e-10));
}

TEST_CASE("derivatives up to degree − 1 are continuous at knots and agree with differences") {
  const Sample sample = wobbly_helix(60);
  for (const int degree : {3, 5}) {
    const SplineCurve curve = fitted(sample, 3, degree, 0.3).curve;
    const std::vector<double> breaks = curve.breaks();
    REQUIRE(breaks.size() > 4);
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
      for (int order = 0; order < degree; ++order) {
        double left[3], right[3];
        curve.evaluate(std::nextafter(breaks[i], 0.0), order, left);
        curve.evaluate(breaks[i], order, right);
        for (int k = 0; k < 3; ++k) CHECK(std::abs(left[k] - right[k]) < 1e-9);
      }
    }
    const double h = 1e-4;
    for (double t = 0.5; t < sample.parameter.back() - 0.5; t += 0.77) {
      for (int order = 0; order < degree; ++order) {
        double ahead[3], behind[3], derivative[3];
        curve.evaluate(t + h, order, ahead);
        curve.evaluate(t - h, order, behind);
        curve.evaluate(t, order + 1, derivative);
        for (int k = 0; k < 3; ++k) {
          CHECK(std::abs((ahead[k] - behind[k]) / (2.0 * h) - derivative[k]) < 2e-2 * std::pow(10.0, order - 4));
        }
      }
    }
  }
}

TEST_CASE("speed, tangent and curvature of a helix") {
  Sample sample;
  for (int i = 0; i <= 100; ++i) {
    const double phase = 0.1 * i;
    sample.parameter.push_back(i);
    sample.points.insert(sample.points.end(), {4.0 * std::cos(phase), 4.0 * std::sin(phase), 3.0 * phase});
  }
  const SplineCurve curve = fitted(sample, 3, 5, 0.0).curve;
  CHECK(curve.speed(33.3) == Approx(0.5).epsilon(1e-9));
  CHECK(curve.curvature(33.3) == Approx(4.0 / 25.0).epsilon(1e-7));
  const std::vector<double> tangent = curve.tangent(33.3);
  CHECK(tangent[0] == Approx(-0.8 * std::sin(3.33)).epsilon(1e-8));
  CHECK(tangent[1] == Approx(0.8 * std::cos(3.33)).epsilon(1e-8));
  CHECK(tangent[2] == Approx(0.6).epsilon(1e-8));
  CHECK(curve.arc_length().total() == Approx(50.0).epsilon(1e-9));
}

/// Reference values: FITPACK's parcur, as SciPy 1.10 calls it (splprep with u = parameter, s = n distance²),
/// which meets n distance² to a thousandth only.
TEST_CASE("knots and curve are those of FITPACK") {
  struct Reference {
    int degree;
    double distance;
    std::vector<int> knot_points;
    double parameter[3];
    double point[3][3];
  };
  const Reference references[] = {{5,
                                   0.3,
                                   {5, 8, 9, 10, 12, 13, 15, 18, 20, 23, 25, 28, 30, 33, 35},
                                   {1.7, 13.37, 25.1},
                                   {{29.7384792, 5.87951766, 3.31467561},
                                    {-1.04490105, 29.88936971, 26.69443939},
                                    {-30.07405905, 4.06264027, 50.20497498}}},
                                  {3,
                                   0.3,
                                   {3, 5, 8, 10, 13, 15, 18, 20, 22, 23, 25, 28, 30, 32, 33, 35, 38},
                                   {1.7, 13.37, 25.1},
                                   {{29.73790932, 5.90782747, 3.28600728},
                                    {-1.04541659, 29.80947336, 26.6798921},
                                    {-30.07235532, 4.04548953, 50.11212949}}},
                                  {5,
                                   0.45,
                                   {10, 15, 20, 25, 30},
                                   {1.7, 13.37, 25.1},
                                   {{29.66369565, 6.02653787, 3.346831},
                                    {-0.94695142, 29.96106578, 26.74385694},
                                    {-29.70492988, 3.86050869, 50.21507547}}}};
  const Sample sample = wobbly_helix(41);
  for (const Reference& reference : references) {
    const SplineCurve curve = fitted(sample, 3, reference.degree, reference.distance).curve;
    const std::vector<double> breaks = curve.breaks();
    CAPTURE(reference.degree);
    CAPTURE(reference.distance);
    REQUIRE(breaks.size() == reference.knot_points.size() + 2);
    for (std::size_t i = 0; i < reference.knot_points.size(); ++i) {
      CHECK(breaks[i + 1] == sample.parameter[static_cast<std::size_t>(reference.knot_points[i])]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      double point[3];
      curve.evaluate(reference.parameter[i], 0, point);
      for (int k = 0; k < 3; ++k) CHECK(std::abs(point[k] - reference.point[i][k]) < 1e-3);
    }
  }
}

TEST_CASE("a distance that rounding hides is refused") {
  const Sample sample = wobbly_helix(40);
  SplineFit fit;
  const Status status = fit_spline(sample.parameter, sample.points, 3, 5, 1e-15, fit);
  CHECK(status.code == Code::invalid_input);
  CHECK(status.text.find("smoothing 1e-15 mm cannot be met to rounding; expected more, or points spaced evenly") == 0);
}

TEST_CASE("thousands of points are smoothed too") {
  const Sample sample = wobbly_helix(4000);
  const SplineFit fit = fitted(sample, 3, 5, 0.45);
  CHECK(root_mean_square(fit.curve, sample) == Approx(0.45).epsilon(1e-8));
}

}  // namespace
