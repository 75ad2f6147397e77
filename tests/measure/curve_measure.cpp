#include "core/measure/curve_measure.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/lie/so3.hpp"

using namespace bowstring;

namespace {

/// A helix about the x axis whose nodes are not evenly spaced.
NodalCurve helix(int nodes) {
  NodalCurve out;
  for (int i = 0; i < nodes; ++i) {
    const double t = std::pow(static_cast<double>(i) / (nodes - 1), 1.3) * 9.0;
    out.points.insert(out.points.end(), {4.0 * t, 10.0 * std::cos(t), 10.0 * std::sin(t)});
    out.radius.push_back(3.0 + 0.2 * t);
  }
  return out;
}

CurveMeasure measured(const NodalCurve& curve, const CurveSampling& sampling) {
  CurveMeasure out;
  const Status status = measure_of_curve(curve, sampling, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

double sum(const std::vector<double>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

std::string refusal(const NodalCurve& curve, const CurveSampling& sampling = {}) {
  CurveMeasure ignored;
  const Status status = measure_of_curve(curve, sampling, ignored);
  CHECK(status.code == Code::invalid_input);
  return status.text;
}

}  // namespace

TEST_CASE("weights of the nodes of a curve") {
  NodalCurve line{{0, 0, 0, 1, 0, 0, 4, 0, 0}, {1, 2, 1}};
  CHECK(measured(line, {}).measure.weight == std::vector<double>(3, 1.0 / 3.0));
  const std::vector<double> by_arc = measured(line, {0, CurveWeights::arc_length, {}}).measure.weight;
  const double expected_arc[] = {0.5 / 4, 2.0 / 4, 1.5 / 4}, expected_volume[] = {0.5 / 10, 8.0 / 10, 1.5 / 10};
  const std::vector<double> by_volume = measured(line, {0, CurveWeights::lumen_section, {}}).measure.weight;
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(by_arc[i] == doctest::Approx(expected_arc[i]).epsilon(1e-15));
    CHECK(by_volume[i] == doctest::Approx(expected_volume[i]).epsilon(1e-15));
  }
}

TEST_CASE("resampled places lie in the middle of equal arc lengths and weigh the same") {
  const NodalCurve line{{0, 0, 0, 1, 0, 0, 4, 0, 0}, {}};
  const CurveMeasure four = measured(line, {4, CurveWeights::arc_length, {}});
  CHECK(four.arc == std::vector<double>{0.5, 1.5, 2.5, 3.5});
  CHECK(four.measure.weight == std::vector<double>(4, 0.25));
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(four.measure.position[3 * i] == doctest::Approx(0.5 + static_cast<double>(i)));
  CHECK(measured(line, {1, CurveWeights::uniform, {}}).measure.position == std::vector<double>{2, 0, 0});
  // The same for any curve: then uniform in arc length is 1/N each.
  for (const int count : {1, 7, 300}) {
    for (const double weight : measured(helix(40), {count, CurveWeights::arc_length, {}}).measure.weight) {
      CHECK(weight == doctest::Approx(1.0 / count).epsilon(1e-14));
    }
  }
}

TEST_CASE("stations draw weight toward themselves") {
  const NodalCurve line{{0, 0, 0, 100, 0, 0}, {}};
  const CurveSampling sampling{1000, CurveWeights::arc_length, {{30.0, 5.0, 3.0}}};
  const CurveMeasure drawn = measured(line, sampling);
  CHECK(sum(drawn.measure.weight) == doctest::Approx(1.0).epsilon(1e-14));
  const double total = 100.0 + 3.0 * 5.0 * std::sqrt(2.0 * std::acos(-1.0));  // ∫ 1 + 3 exp(−((s − 30)/5)²/2) ds
  for (const std::size_t i : {0UL, 299UL, 340UL, 900UL}) {
    const double s = drawn.arc[i], density = 1.0 + 3.0 * std::exp(-0.5 * std::pow((s - 30.0) / 5.0, 2));
    CHECK(drawn.measure.weight[i] == doctest::Approx(0.1 * density / total).epsilon(1e-7));
  }
}

TEST_CASE("frames: first axes along the curve, no roll from place to place, the least turn at the first") {
  const NodalCurve curve = helix(60);
  for (const int points : {0, 45}) {
    const CurveMeasure places = measured(curve, {points, CurveWeights::uniform, {}});
    const std::size_t count = places.measure.count();
    REQUIRE(places.measure.orientation.size() == 4 * count);
    double largest_roll = 0.0, turned = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const lie::Rotation frame = lie::Rotation::load(&places.measure.orientation[4 * i]);
      const Vector3 axis = frame * Vector3::unit(0);
      const std::size_t a = i == 0 ? 0 : i - 1, b = i + 1 == count ? i : i + 1;
      const Vector3 chord =
          Vector3::load(&places.measure.position[3 * b]) - Vector3::load(&places.measure.position[3 * a]);
      CHECK(dot(axis, chord) > 0.99 * norm(chord));
      if (i == 0) continue;
      const Vector3 turn = lie::log(lie::Rotation::load(&places.measure.orientation[4 * (i - 1)]).inverse() * frame);
      largest_roll = std::max(largest_roll, std::fabs(turn[0]));
      turned += norm(turn);
    }
    CHECK(turned > 3.0);
    CHECK(largest_roll < 1e-14);
    const Vector3 first = lie::log(lie::Rotation::load(places.measure.orientation.data()));
    CHECK(std::fabs(first[0]) < 1e-15);
  }
}

TEST_CASE("like curves carry like rolls, also where Frenet frames jump") {
  // An S in the plane has an inflection in its middle; the same lifted slightly out of it twists Frenet's frame there.
  const auto s_curve = [](double height) {
    NodalCurve out;
    for (int i = 0; i <= 200; ++i) {
      const double t = 0.05 * i;
      out.points.insert(out.points.end(), {10.0 * t, 20.0 * std::sin(0.6 * t), height * std::cos(0.4 * t)});
    }
    return out;
  };
  const std::vector<double> flat = node_frames(s_curve(0.0)), lifted = node_frames(s_curve(0.05));
  double farthest = 0.0;
  for (std::size_t i = 0; i < flat.size(); i += 4) {
    farthest =
        std::max(farthest, norm(lie::log(lie::Rotation::load(&flat[i]).inverse() * lie::Rotation::load(&lifted[i]))));
  }
  CHECK(farthest > 0.0);
  CHECK(farthest < 0.02);
}

TEST_CASE("curves in the plane are lifted with z = 0") {
  CHECK(nodal_curve({1, 2, 3, 4}, 2).points == std::vector<double>{1, 2, 0, 3, 4, 0});
  CHECK(nodal_curve({1, 2, 3}, 3).points == std::vector<double>{1, 2, 3});
}

TEST_CASE("doubled nodes and turns back have directions") {
  const CurveMeasure places = measured({{0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0}, {}}, {});
  for (const double number : places.measure.orientation) CHECK(std::isfinite(number));
  CHECK(measured({{0, 0, 0, 0, 0, 0, 0, 2, 0}, {}}, {}).measure.orientation[0] == doctest::Approx(std::sqrt(0.5)));
}

TEST_CASE("curves that are none") {
  CHECK(refusal({{1, 2, 3}, {}}) == "a curve of 1 nodes; expected at least two");
  CHECK(refusal({{1, 2, 3, 1, 2, 3}, {}}) == "a curve without length: its nodes are one point; expected nodes apart");
  CHECK(refusal({{1, 2, 3, 1, NAN, 3}, {}}) == "node 1 of the curve is not finite; expected three numbers in mm");
  CHECK(refusal({{0, 0, 0, 1, 0, 0}, {}}, {0, CurveWeights::lumen_section, {}}) ==
        "weights 'lumen-section' of a curve whose radius is not known; expected a radius at every node; give it, or "
        "choose the weights 'arc-length'");
  CHECK(refusal({{0, 0, 0, 1, 0, 0}, {1, 0}}, {0, CurveWeights::lumen_section, {}}) ==
        "weights 'lumen-section' of a curve without a radius above 0 at node 1; give it one, or choose the weights "
        "'arc-length'");
}

TEST_CASE("names of weights") {
  for (const CurveWeights weights : {CurveWeights::uniform, CurveWeights::arc_length, CurveWeights::lumen_section}) {
    CurveWeights read = CurveWeights::uniform;
    CHECK(read_curve_weights(curve_weights_name(weights), read));
    CHECK(read == weights);
  }
  CurveWeights untouched = CurveWeights::arc_length;
  CHECK_FALSE(read_curve_weights("mass", untouched));
}
