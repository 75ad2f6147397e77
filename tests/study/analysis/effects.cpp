#include "study/analysis/effects.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using doctest::Approx;

TEST_CASE("paired differences with interval, largest and relative size") {
  StudyData data = study_of({words_axis("contact", {"a", "b"}), number_axis("T", {1, 2, 3, 4, 5, 6, 7}, "N")},
                            {"q_mm", "length_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) {
    const double t = number(d, run, 1);
    return 10.0 * t + (run.choice[0] == 1 ? 1.0 + 0.1 * (t - 4.0) : 0.0);
  });
  fill(data, 1, [](const StudyData&, const RunData& run) { return run.choice[0] == 1 ? 50.0 : 100.0; });
  for (RunData& run : data.runs) run.solve_seconds = run.choice[0] == 1 ? 3.0 : 1.0;
  const Effects effects = find_effects(data);
  REQUIRE(effects.quantities.size() == 2);  // T has too many numbers
  CHECK(effects.quantities[0].quantity == 1);
  CHECK(effects.quantities[0].relative == Approx(-0.5));
  const Effect& own = effects.quantities[1];
  CHECK(own.from == 0);
  CHECK(own.to == 1);
  CHECK(own.pairs == 7);
  CHECK(own.mean == Approx(1.0));
  const double half = 2.4469 * std::sqrt(0.28 / 6.0) / std::sqrt(7.0);
  CHECK(own.high - own.mean == Approx(half).epsilon(1e-4));
  CHECK(own.largest == Approx(1.3));
  CHECK(own.largest_run == 13);
  CHECK(own.relative == Approx(1.0 / 40.0));
  REQUIRE(effects.times.size() == 1);
  CHECK(effects.times[0].mean == Approx(3.0));
  CHECK(effects.times[0].relative == Approx(2.0));
  CHECK(effects.times[0].quantity == Effect::solve_time);
}

TEST_CASE("one at a time: everything against the baseline") {
  StudyData data = study_of({words_axis("contact", {"b", "c"}), words_axis("vessel", {"d"})}, {"q_mm"});
  const double values[4] = {10.0, 11.0, 12.0, 5.0};
  int k = 0;
  for (const std::vector<int>& choice : {std::vector<int>{-1, -1}, {0, -1}, {1, -1}, {-1, 0}}) {
    data.quantities[0].value[static_cast<std::size_t>(add_run(data, choice))] = values[k++];
  }
  const Effects effects = find_effects(data);
  REQUIRE(effects.quantities.size() == 3);
  CHECK(effects.quantities[0].axis == 1);
  CHECK(effects.quantities[0].from == -1);
  CHECK(effects.quantities[0].mean == -5.0);
  CHECK(std::isnan(effects.quantities[0].low));
  CHECK(effects.quantities[1].to == 1);
  CHECK(effects.quantities[2].to == 0);
  CHECK(effects.quantities[2].from == -1);
}

TEST_CASE("pairs with a failed run do not count") {
  StudyData data = study_of({words_axis("contact", {"a", "b"}), words_axis("vessel", {"c", "d", "e"})}, {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData&, const RunData& run) { return 1.0 + run.choice[0]; });
  fail(data, 0);
  fail(data, 4);
  const Effects effects = find_effects(data);
  REQUIRE_FALSE(effects.quantities.empty());
  CHECK(effects.quantities[0].axis == 0);
  CHECK(effects.quantities[0].pairs == 1);
  CHECK(effects.quantities[0].largest_run == 5);
  fail(data, 5);
  for (const Effect& effect : find_effects(data).quantities) CHECK(effect.axis == 1);
}

TEST_CASE("of a mesh study the finest pair counts") {
  StudyData data = study_of(
      {words_axis("contact", {"a", "b"}), number_axis("N", {20, 40, 80}), words_axis("vessel", {"c", "d"})}, {"q_mm"});
  data.along = 1;
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return 1.0 + run.choice[0] * number(d, run, 1); });
  fail(data, 4);  // a, 80, c
  const Effects effects = find_effects(data);
  REQUIRE_FALSE(effects.quantities.empty());
  CHECK(effects.quantities[0].axis == 0);
  CHECK(effects.quantities[0].pairs == 2);
  CHECK(effects.quantities[0].mean == Approx(0.5 * (40.0 + 80.0)));
  CHECK(effects.quantities[0].largest_run == 11);
}

TEST_CASE("an effect on what is 0 has no relative size and comes last") {
  StudyData data = study_of({words_axis("contact", {"a", "b"})}, {"force_N", "q_mm"});
  add_product(data);
  data.quantities[0].value = {0.0, 5.0};
  data.quantities[1].value = {10.0, 10.1};
  const Effects effects = find_effects(data);
  REQUIRE(effects.quantities.size() == 2);
  CHECK(effects.quantities[0].quantity == 1);
  CHECK(std::isnan(effects.quantities[1].relative));
}

TEST_CASE("alternatives that state another problem have no effect") {
  StudyData data = study_of({words_axis("swap", {"plain", "other", "another scene"})}, {"q_mm"});
  add_product(data);
  data.quantities[0].value = {1.0, 1.5, 7.0};
  CHECK(find_effects(data).quantities.size() == 2);
  data.axes[0].problem = {0, 0, 2};
  const Effects effects = find_effects(data);
  REQUIRE(effects.quantities.size() == 1);
  CHECK(effects.quantities[0].to == 1);
}

}  // namespace
