#include "core/transport/repeat.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/transport/check_measure.hpp"
#include "plugins/host/plugin_host.hpp"

using namespace bowstring;

namespace {

Measure spiral(int count) {
  Measure out;
  for (int i = 0; i < count; ++i) {
    const double t = 0.3 * i;
    out.position.insert(out.position.end(), {2.0 * t, t * std::cos(t), t * std::sin(t)});
  }
  out.weight = uniform_weights(static_cast<std::size_t>(count));
  return out;
}

}  // namespace

TEST_CASE("median, least and most") {
  CHECK(spread_of({}).median == 0.0);
  CHECK(spread_of({3, 1, 2}).median == 2.0);
  CHECK(spread_of({4, 1, 2, 3}).median == 2.5);
  CHECK(spread_of({4, 1, 2, 3}).least == 1.0);
  CHECK(spread_of({4, 1, 2, 3}).most == 4.0);
}

TEST_CASE("the spacing of places is the mean distance to the nearest neighbour") {
  CHECK(mean_spacing({{0, 0, 0}, {}, {1}}) == 0.0);
  CHECK(mean_spacing({{0, 0, 0, 3, 4, 0, 3, 4, 1}, {}, {1, 1, 1}}) == doctest::Approx((5.0 + 1.0 + 1.0) / 3.0));
}

TEST_CASE("repeated comparisons go on from the plan before, the same for the same seed") {
  PluginHost plugins;
  Refusal refusal;
  auto transport = TransportComparison::open({"exact", "euclidean", {}}, plugins, refusal);
  REQUIRE_MESSAGE(transport, refusal.text());
  const Measure a = spiral(80);
  Measure b = spiral(80);
  for (std::size_t i = 0; i < b.count(); ++i) b.position[3 * i + 1] += 2.0 + std::sin(0.4 * static_cast<double>(i));
  TransportResult first;
  REQUIRE(transport->compare(a, b, first).ok());
  RepeatRecord record, again;
  REQUIRE(repeat_comparison(*transport, a, b, 6, 1, record).ok());
  CHECK(record.count == 6);
  CHECK(record.step == doctest::Approx(0.1 * mean_spacing(a)));
  CHECK(record.warm.least > 0.0);
  CHECK(record.cold.least > 0.0);
  CHECK(record.iterations.median < record.cold_iterations.median);
  transport->forget();
  REQUIRE(transport->compare(a, b, first).ok());
  REQUIRE(repeat_comparison(*transport, a, b, 6, 1, again).ok());
  CHECK(again.iterations.median == record.iterations.median);
  CHECK(again.iterations.most == record.iterations.most);
  REQUIRE(repeat_comparison(*transport, a, b, 3, 2, again).ok());
}
