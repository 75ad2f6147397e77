#include "core/transport/transport_comparison.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/lie/so3.hpp"
#include "core/measure/curve_measure.hpp"
#include "plugins/host/plugin_host.hpp"

using namespace bowstring;

namespace {

struct Opened {
  PluginHost plugins;
  std::optional<TransportComparison> transport;
  Opened() {
    Refusal refusal;
    transport = TransportComparison::open({"exact", "euclidean", {}}, plugins, refusal);
    REQUIRE_MESSAGE(transport, refusal.text());
  }
};

/// A curve with frames, bent by `bend` and moved by `shift`.
Measure bent(double bend, double shift, int places = 25) {
  NodalCurve curve;
  for (int i = 0; i <= 40; ++i) {
    curve.points.insert(curve.points.end(),
                        {2.0 * i + shift, bend * std::sin(0.15 * i), 0.3 * bend * std::cos(0.2 * i)});
  }
  CurveMeasure out;
  REQUIRE(measure_of_curve(curve, {places, CurveWeights::arc_length, {{20.0, 10.0, 2.0}}}, out).ok());
  return out.measure;
}

std::string refusal(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult result;
  const Status status = transport.compare(a, b, result);
  CHECK(status.code == Code::invalid_input);
  CHECK(transport.check(a, b).text == status.text);
  return status.text;
}

}  // namespace

TEST_CASE("unknown names and settings are told, with the nearest ones") {
  PluginHost plugins;
  Refusal refusal;
  CHECK_FALSE(TransportComparison::open({"exakt", "euclidian", {}}, plugins, refusal));
  CHECK(refusal.errors.size() == 2);
  CHECK(refusal.text().find("unknown ground-cost 'euclidian'") != std::string::npos);
  CHECK(refusal.text().find("did you mean 'euclidean'?") != std::string::npos);
}

TEST_CASE("measures that cannot be compared are refused by name and index") {
  Opened opened;
  const Measure good = bent(5.0, 0.0);
  Measure bad = good;
  bad.weight[3] = -1.0;
  CHECK(
      refusal(*opened.transport, good, bad) ==
      "the second measure, place 3: weight -1; expected a finite number, not negative; leave the place out or mend it");
  CHECK(refusal(*opened.transport, {}, good) == "the first measure: no places; expected at least one; add a place");
  bad = good;
  for (double& weight : bad.weight) weight *= 1.001;
  CHECK(refusal(*opened.transport, bad, good).find("sum to 1.001, those of the second to 1; ") != std::string::npos);
  for (double& weight : bad.weight) weight = weight / 1.001 * (1.0 + 1e-12);
  TransportResult result;
  CHECK(opened.transport->compare(bad, good, result).ok());
}

TEST_CASE("gradients by positions and by frames are derivatives") {
  Opened opened;
  const Measure a = bent(5.0, 0.0), b = bent(9.0, 1.5);
  TransportResult at, moved;
  REQUIRE(opened.transport->compare(a, b, at).ok());
  REQUIRE(at.answer.uniqueness_known);
  REQUIRE_FALSE(at.answer.multiple);
  constexpr double step = 1e-5;
  double norm = 0.0, worst = 0.0;
  for (std::size_t k = 0; k < a.position.size(); ++k) {
    double sides[2];
    for (const int side : {0, 1}) {
      Measure there = a;
      there.position[k] += side == 0 ? -step : step;
      REQUIRE(opened.transport->compare(there, b, moved, false).ok());
      sides[side] = moved.answer.value;
    }
    norm = std::max(norm, std::fabs(at.gradient_a.position[k]));
    worst = std::max(worst, std::fabs((sides[1] - sides[0]) / (2 * step) - at.gradient_a.position[k]));
  }
  REQUIRE(norm > 0.1);
  CHECK(worst < 1e-8 * std::max(1.0, norm));
  // The body tangent of a frame: nothing by rotation, the position's in the frame's own axes by translation.
  REQUIRE(at.gradient_a.frame.size() == 6 * a.count());
  for (std::size_t i = 0; i < a.count(); ++i) {
    const Vector3 by_position =
        lie::Rotation::load(&a.orientation[4 * i]).inverse() * Vector3::load(&at.gradient_a.position[3 * i]);
    for (int e = 0; e < 3; ++e) {
      CHECK(at.gradient_a.frame[6 * i + static_cast<std::size_t>(e)] == 0.0);
      CHECK(at.gradient_a.frame[6 * i + 3 + static_cast<std::size_t>(e)] ==
            doctest::Approx(by_position[e]).epsilon(1e-12));
    }
  }
}

TEST_CASE("a comparison goes on from the one before until it is told to forget, to the same value") {
  Opened opened;
  TransportResult first, again, cold;
  REQUIRE(opened.transport->compare(bent(5.0, 0.0), bent(-7.0, 1.0), first).ok());
  CHECK_FALSE(first.answer.warm);
  REQUIRE(opened.transport->compare(bent(5.01, 0.0), bent(-7.0, 1.0), again).ok());
  CHECK(again.answer.warm);
  opened.transport->forget();
  REQUIRE(opened.transport->compare(bent(5.01, 0.0), bent(-7.0, 1.0), cold).ok());
  CHECK_FALSE(cold.answer.warm);
  CHECK(again.answer.value == doctest::Approx(cold.answer.value).epsilon(1e-12));
}

TEST_CASE("costs as a matrix, with pairs that are forbidden") {
  Opened opened;
  TransportResult result;
  const std::vector<double> halves{0.5, 0.5};
  REQUIRE(opened.transport->compare(halves, halves, std::vector<double>{0, 1, 3, HUGE_VAL}, result).ok());
  CHECK(result.answer.value == doctest::Approx(2.0));
  CHECK(result.gradient_a.position.empty());
  CHECK(opened.transport->compare(halves, halves, std::vector<double>{0, 1, 3}, result).text ==
        "3 costs; expected 2 x 2, one for each pair of weights");
  CHECK(opened.transport->compare(halves, halves, std::vector<double>{0, 1, NAN, 1}, result).text ==
        "the cost of row 1, column 0 is not a number; expected a finite one, or +inf for a forbidden pair");
}
