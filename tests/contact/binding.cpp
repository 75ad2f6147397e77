#include "core/contact/binding.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/contact/gap.hpp"
#include "tests/contact/tubes.hpp"

namespace bowstring::contact {

using namespace testing;

namespace {

constexpr double limb = 60.0, bend = 6.5;  // mm: two straight limbs that lie 13 mm apart

/// A hairpin by arc length.
std::vector<double> hairpin_at(double s) {
  const double turn = bend * M_PI;
  if (s < limb) return {s, 0.0};
  if (s > limb + turn) return {2.0 * limb + turn - s, 2.0 * bend};
  const double angle = (s - limb) / bend;
  return {limb + bend * std::sin(angle), bend * (1.0 - std::cos(angle))};
}

constexpr double hairpin_length = 2.0 * limb + bend * M_PI;

/// A wire of `nodes` nodes in the hairpin from `first` on, up to `inward` mm from the centerline toward the other limb,
/// most in the middle of each.
std::vector<double> wire_points(double first, int nodes, double inward, std::vector<double>& arc) {
  std::vector<double> points;
  const auto bulge = [&](double along) { return inward * std::pow(std::sin(M_PI * along / limb), 2); };
  for (int i = 0; i < nodes; ++i) {
    const double s = first + (hairpin_length - first) * i / (nodes - 1);
    std::vector<double> p = hairpin_at(s);
    if (s < limb) p[1] += bulge(s);
    if (s > hairpin_length - limb) p[1] -= bulge(hairpin_length - s);
    points.insert(points.end(), p.begin(), p.end());
    arc.push_back(s);
  }
  return points;
}

CurveView wire_of(int nodes, bool first_held, bool last_held) {
  CurveView wire;
  wire.dimension = 2;
  wire.nodes = nodes;
  for (bool& held : wire.end[0].position_held) held = first_held;
  for (bool& held : wire.end[1].position_held) held = last_held;
  return wire;
}

}  // namespace

TEST_CASE("places at a state are found along the vessel, where the nearest one would lie in another limb") {
  const Tube vessel = tube(testing::Curve(hairpin_at), 0.0, hairpin_length, 80, 6.0);
  const Centerline line = vessel.view(Interpolation::spline);
  const double per_segment = hairpin_length / 79;
  std::vector<double> arc;
  const int nodes = 90;
  const double inward = 7.5;  // beyond the middle between the limbs, 5.5 mm from the other one
  const std::vector<double> points = wire_points(0.0, nodes, inward, arc);
  const std::vector<double> first(nodes, 0.0);
  const std::vector<double> sigma = places_at(wire_of(nodes, true, true), line, points.data(), nullptr, first);
  int shortcuts = 0;
  for (int i = 0; i < nodes; ++i) {
    const auto node = static_cast<std::size_t>(i);
    CHECK(sigma[node] * per_segment == doctest::Approx(arc[node]).epsilon(0.02));
    const double nearest = globally_closest(line, points.data() + 2 * i, {GapForm::squared, 0.0}).at.sigma();
    shortcuts += std::fabs(nearest - sigma[node]) > 5.0 ? 1 : 0;
  }
  CHECK(shortcuts > 10);
}

TEST_CASE("places at a state are followed from the end that is held, however far the other one has slid") {
  const Tube vessel = tube(testing::Curve(hairpin_at), 0.0, hairpin_length, 80, 6.0);
  const Centerline line = vessel.view(Interpolation::spline);
  const double per_segment = hairpin_length / 79;
  std::vector<double> arc;
  const int nodes = 30;
  const std::vector<double> points = wire_points(100.0, nodes, 2.0, arc);  // its tip has been drawn into the last limb
  std::vector<double> first;
  for (int i = 0; i < nodes; ++i) first.push_back(79.0 * i / (nodes - 1));
  const std::vector<double> sigma = places_at(wire_of(nodes, false, true), line, points.data(), nullptr, first);
  CHECK(std::fabs(sigma[0] - first[0]) > 40.0);
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    CHECK(sigma[i] * per_segment == doctest::Approx(arc[i]).epsilon(0.02));
  }
}

}  // namespace bowstring::contact
