#include <doctest/doctest.h>

#include <random>

#include "core/contact/crossing.hpp"
#include "core/contact/gap.hpp"
#include "tests/allocations.hpp"
#include "tests/contact/tubes.hpp"

TEST_CASE("searches, derivatives and checks allocate nothing") {
  using namespace bowstring::contact;
  using bowstring::testing::allocations;
  std::mt19937 random(31);
  const testing::Tube tube = testing::crooked_tube(3, 30, random);
  const double x[] = {50.0, 3.0, 2.0};
  double gradient[3 * (1 + max_stencil)];
  double hessian[sizeof(gradient) / sizeof(double) * (3 * (1 + max_stencil) + 1) / 2];
  const WirePolyline wire{30, tube.points.data(), nullptr};

  const long before = allocations;
  double sum = 0.0;
  for (const Interpolation interpolation : {Interpolation::polyline, Interpolation::spline}) {
    const Centerline curve = tube.view(interpolation);
    for (const GapForm form : {GapForm::squared, GapForm::distance, GapForm::smooth_distance}) {
      const GapShape shape{form, 0.4};
      const ClosestPoint at = closest(curve, x, shape, window_around(12.0, 2, 30), 12.0);
      gap_derivatives(curve, x, shape, at, gradient, 1.0, hessian);
      sum += at.gap + globally_closest(curve, x, shape).gap + gradient[0] + hessian[0];
    }
    sum += check_wall(curve, wire).dense.depth + tube_folds(curve).value;
  }
  const long after = allocations;
  REQUIRE(sum != 0.0);
  REQUIRE(before > 0);
  CHECK(after == before);
}
