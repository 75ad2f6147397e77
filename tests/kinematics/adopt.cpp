#include <cmath>

#include "core/curve_kinematics/sample.hpp"
#include "kinematics/edge-frames/edge_frames.hpp"
#include "kinematics/nodes/nodes.hpp"
#include "tests/kinematics/curve_cases.hpp"
#include "tests/kinematics/declared_curve.hpp"
#include "tests/kinematics/differences.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::testing;

/// A shape that owns its numbers.
struct OwnedShape {
  std::vector<double> position, orientation;
  CurveShape view() const { return {position, orientation}; }
};

template <class Declared>
OwnedShape sampled(const Declared& curve, const std::vector<double>& q) {
  const int nodes = curve.curve.nodes();
  std::vector<double> at_nodes, at_middles;
  for (int i = 0; i < nodes; ++i) at_nodes.push_back(i);
  for (int i = 0; i + 1 < nodes; ++i) at_middles.push_back(i + 0.5);
  CurveSample points, frames;
  REQUIRE(curve.kinematics.sample(q, at_nodes, points).ok());
  REQUIRE(curve.kinematics.sample(q, at_middles, frames).ok());
  return {points.position, frames.orientation};
}

template <class Declared>
std::vector<double> adopted(const Declared& curve, const OwnedShape& shape) {
  std::vector<double> q(curve.start().size(), 1e300);
  const Status status = curve.kinematics.adopt(shape.view(), q);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return q;
}

/// ζ of every station, without the lengths of a curve that slides.
template <class Declared>
std::vector<double> strains(const Declared& curve, const std::vector<double>& q) {
  const SiteDeclaration& site = curve.site(Site::station);
  const std::vector<double> y = curve.values(Site::station, q);
  std::vector<double> out;
  const int own = site.values - (site.lengths_vary ? 2 : 0);
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (static_cast<int>(i) % site.values < own) out.push_back(y[i]);
  }
  return out;
}

/// Sizes of strain vectors: their basis may be the kinematics' own.
template <class Declared>
std::vector<double> turns(const Declared& curve, const std::vector<double>& q) {
  const SiteDeclaration& site = curve.site(Site::station);
  const int own = site.values - (site.lengths_vary ? 2 : 0);
  const std::vector<double> zeta = strains(curve, q);
  std::vector<double> out;
  for (std::size_t i = 0; i < zeta.size(); i += at(own)) {
    double squared = 0.0;
    for (int k = 0; k < own; ++k) squared += zeta[i + at(k)] * zeta[i + at(k)];
    out.push_back(std::sqrt(squared));
  }
  return out;
}

template <class SomeKinematics>
void check_round_trip(const Case& c, TestCurve curve, double size, unsigned seed) {
  CAPTURE(c.text());
  const DeclaredCurve<SomeKinematics> declared(c.dressed(std::move(curve)), c.needs());
  std::vector<double> q = perturbed(declared, size, seed);
  // What is held stays with the start, in a state as in what is adopted.
  if (declared.has_field("held-tangent")) {
    const std::vector<double>& held = declared.field("held-tangent").start;
    std::copy(held.begin(), held.end(), q.begin() + declared.coordinate_begin("held-tangent"));
  }
  const OwnedShape shape = sampled(declared, q);
  const std::vector<double> back = adopted(declared, shape);
  const int positions = declared.curve.nodes() * declared.curve.dimension;
  const std::vector<double> start = declared.start();
  REQUIRE(largest_difference({q.begin(), q.begin() + positions}, {start.begin(), start.begin() + positions}) > 1e-3);
  CHECK(std::equal(q.begin(), q.begin() + positions, back.begin()));
  const bool own_basis = c.dimension == 3 && !c.material_frames;
  const std::vector<double> before = own_basis ? turns(declared, q) : strains(declared, q);
  const std::vector<double> after = own_basis ? turns(declared, back) : strains(declared, back);
  REQUIRE(largest(before) > 0.1);
  CHECK(largest_difference(before, after) < 1e-11 * std::max(1.0, largest(before)));
  // The shape of what was adopted is the shape.
  const OwnedShape again = sampled(declared, back);
  CHECK(again.position == shape.position);
  for (std::size_t i = 0; i < shape.orientation.size(); i += 4) {
    const lie::Rotation a = lie::Rotation::load(shape.orientation.data() + i),
                        b = lie::Rotation::load(again.orientation.data() + i);
    CHECK(norm(a.first_axis() - b.first_axis()) < 1e-12);
    if (c.material_frames) CHECK(norm(lie::log(a.inverse() * b)) < 1e-7);
  }
}

}  // namespace

TEST_CASE("a curve's own shape gives back its positions to the bit and its strains to rounding") {
  for (const Case& c : all_cases()) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      check_round_trip<EdgeFrames>(c, crooked_curve(c.dimension, 9, seed), 0.3, seed);
      check_round_trip<Nodes>(c, crooked_curve(c.dimension, 9, seed), 0.3, seed);
      check_round_trip<EdgeFrames>(c, zigzag(c.dimension, 9, 2.6, seed), 0.05, seed);
      check_round_trip<Nodes>(c, zigzag(c.dimension, 9, 2.6, seed), 0.05, seed);
    }
  }
}

TEST_CASE("either kinematics takes the other's shape, and gives it back") {
  for (const Case& c : all_cases()) {
    CAPTURE(c.text());
    TestCurve curve = crooked_curve(c.dimension, 11, 5);
    curve.start = crooked_curve(c.dimension, 11, 6).reference;
    const DeclaredCurve<Nodes> nodes(c.dressed(curve), c.needs());
    const DeclaredCurve<EdgeFrames> frames(c.dressed(curve), c.needs());
    std::vector<double> q = nodes.start();
    if (c.material_frames) {  // a twist that no centerline tells
      for (int i = 0; i < 10; ++i) q[at(nodes.coordinate_begin("angle") + i)] += 0.4 * i;
    }
    const std::vector<double> there = adopted(frames, sampled(nodes, q));
    const std::vector<double> back = adopted(nodes, sampled(frames, there));
    REQUIRE(largest(turns(nodes, q)) > 0.1);
    CHECK(largest_difference(turns(nodes, q), turns(frames, there)) < 1e-11);
    CHECK(largest_difference(turns(nodes, q), turns(nodes, back)) < 1e-11);
    CHECK(std::equal(q.begin(), q.begin() + 11 * c.dimension, back.begin()));
    if (!c.material_frames) continue;
    const auto angle = nodes.coordinate_begin("angle");
    for (int i = 0; i < 10; ++i) CHECK(back[at(angle + i)] == doctest::Approx(q[at(angle + i)]).epsilon(1e-10));
  }
}

TEST_CASE("whole turns are counted along the curve, from the end that holds them") {
  for (const int held_end : {-1, 0, 1}) {
    CAPTURE(held_end);
    TestCurve curve = straight_curve(2, 41, 80.0);
    curve.extension = Extension::fixed;
    if (held_end >= 0) {
      curve.clamp(held_end, {0.8, 0.6});
      curve.end[held_end].turn[2] = held_end == 0 ? 0.0 : 6.0 * M_PI;
    }
    const DeclaredCurve<EdgeFrames> declared(curve);
    std::vector<double> q = declared.start();
    const int begin = declared.coordinate_begin("orientation");
    for (int i = 0; i < 40; ++i) q[at(begin + i)] += 6.0 * M_PI * (i + 0.5) / 40.0;
    const std::vector<double> back = adopted(declared, sampled(declared, q));
    for (int i = 0; i < 40; ++i) CHECK(back[at(begin + i)] == doctest::Approx(q[at(begin + i)]).epsilon(1e-13));
  }
}

TEST_CASE("lengths are those of the shape") {
  TestCurve curve = straight_curve(3, 6, 10.0);
  curve.extension = Extension::sliding;
  curve.hold_edge(0);
  curve.hold_position(1);
  TestCurve longer = straight_curve(3, 6, 15.0);
  const DeclaredCurve<Nodes> shape_of(longer);
  const OwnedShape shape = sampled(shape_of, shape_of.start());
  const DeclaredCurve<Nodes> nodes(curve);
  CHECK(adopted(nodes, shape)[at(nodes.coordinate_begin("length"))] == doctest::Approx(12.0));
  const DeclaredCurve<EdgeFrames> vessel(straight_curve(3, 6, 10.0));
  const std::vector<double> q = adopted(vessel, shape);
  for (int i = 0; i < 5; ++i) CHECK(q[at(vessel.coordinate_begin("edge-length") + i)] == doctest::Approx(3.0));
}

TEST_CASE("what is no shape of the curve is refused with the place") {
  const DeclaredCurve<EdgeFrames> frames(straight_curve(3, 4, 9.0));
  Needs needs;
  needs.material_frames = true;
  needs.reason = "a test";
  const DeclaredCurve<Nodes> nodes(straight_curve(3, 4, 9.0), needs);
  const OwnedShape good = sampled(frames, frames.start());
  const auto said = [&](const OwnedShape& shape) {
    std::vector<double> q(frames.start().size()), other(nodes.start().size());
    const Status status = frames.kinematics.adopt(shape.view(), q);
    CHECK(status.code == Code::invalid_input);
    CHECK(nodes.kinematics.adopt(shape.view(), other).text == status.text);
    return status.text;
  };
  OwnedShape shape = good;
  shape.position.resize(9);
  CHECK(said(shape) == "a shape of 'test' with 9 coordinates and 12 numbers of orientations; expected 12 and 12");
  shape = good;
  shape.position[4] = std::nan("");
  CHECK(said(shape) == "a shape of 'test' with a coordinate at node 1 that is no finite number");
  shape = good;
  std::copy_n(shape.position.begin() + 3, 3, shape.position.begin() + 6);
  CHECK(said(shape) == "a shape of 'test' with edge 1 of length zero");
  shape = good;
  shape.orientation[8] += 0.1;
  CHECK(said(shape) == "a shape of 'test' with an orientation of edge 2 that is no unit quaternion");
  shape = good;
  for (double& x : shape.position) x = -x;
  std::vector<double> q(nodes.start().size());
  const Status against = nodes.kinematics.adopt(shape.view(), q);
  CHECK(against.code == Code::failed);
  CHECK(against.text.find("edge 0 of 'test' (nodes 0 and 1) points against its direction in State 1") == 0);
  std::vector<double> taken(frames.start().size());
  CHECK(frames.kinematics.adopt(shape.view(), taken).ok());
}
