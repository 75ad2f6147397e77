#include "study/analysis/sensitivities.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using doctest::Approx;

TEST_CASE("the derivatives of a parabola at unequal spacing, in any order of values") {
  StudyData data = study_of({number_axis("T", {4, 1, 2, 8}, "N")}, {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return 1.0 + std::pow(number(d, run, 0), 2.0); });
  const std::vector<Sensitivity> places = find_sensitivities(data);
  REQUIRE(places.size() == 2);
  CHECK(places[0].at == "T = 4 N");
  REQUIRE(places[0].entries.size() == 1);
  CHECK(places[0].entries[0].derivative == Approx(8.0));
  CHECK(places[0].entries[0].elasticity == Approx(4.0 / 17.0 * 8.0));
  CHECK(places[1].at == "T = 2 N");
  CHECK(places[1].entries[0].derivative == Approx(4.0));
}

TEST_CASE("along a logarithmic axis a power of ln p is exact") {
  StudyData data = study_of({number_axis("EI", {65, 650, 6500}, "N mm^2", Spacing::logarithmic)}, {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return std::pow(std::log(number(d, run, 0)), 2.0); });
  const std::vector<Sensitivity> places = find_sensitivities(data);
  REQUIRE(places.size() == 1);
  CHECK(places[0].entries[0].derivative == Approx(2.0 * std::log(650.0) / 650.0));
  CHECK(places[0].entries[0].elasticity == Approx(2.0 / std::log(650.0)));
}

StudyData product_grid() {
  StudyData data = study_of({number_axis("a", {1, 2, 3, 4, 5}), number_axis("b", {2, 3, 4, 5})}, {"q_mm"});
  add_product(data);
  return data;
}

TEST_CASE("of a product the factors cannot be told apart") {
  StudyData data = product_grid();
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); });
  const std::vector<Inseparable> pairs = find_inseparable(data, find_sensitivities(data));
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].axes[0] == 0);
  CHECK(pairs[0].axes[1] == 1);
  CHECK(pairs[0].cosine == Approx(1.0));
  CHECK(pairs[0].text == "a and b act alike (cosine 1.000): these quantities cannot tell them apart");
}

TEST_CASE("of a quotient they act against each other") {
  StudyData data = study_of({number_axis("a", {1, 2, 4, 8}, "", Spacing::logarithmic),
                             number_axis("b", {1, 2, 4, 8}, "", Spacing::logarithmic)},
                            {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return std::log(number(d, run, 0) / number(d, run, 1)); });
  const std::vector<Inseparable> pairs = find_inseparable(data, find_sensitivities(data));
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].text ==
        "a and b act against each other in one proportion (cosine -1.000): these quantities cannot tell them apart");
}

TEST_CASE("a second quantity tells them apart, and a parameter without effect is no partner") {
  StudyData data = product_grid();
  data.quantities.push_back(data.quantities[0]);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); });
  fill(data, 1, [](const StudyData& d, const RunData& run) { return number(d, run, 0) / number(d, run, 1); });
  CHECK(find_inseparable(data, find_sensitivities(data)).empty());
  data.quantities.pop_back();
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0); });
  REQUIRE_FALSE(find_sensitivities(data).empty());
  CHECK(find_inseparable(data, find_sensitivities(data)).empty());
}

TEST_CASE("one place of one quantity tells nothing about a pair") {
  StudyData data = study_of({number_axis("a", {1, 2, 3}), number_axis("b", {1, 2, 3})}, {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); });
  CHECK(find_inseparable(data, find_sensitivities(data)).empty());
}

TEST_CASE("a place beside a failed run has no derivative along that axis") {
  StudyData data = product_grid();
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) + number(d, run, 1); });
  fail(data, 0);  // a = 1, b = 2
  for (const Sensitivity& place : find_sensitivities(data)) {
    for (const SensitivityEntry& entry : place.entries) CHECK(entry.derivative == Approx(1.0));
    if (place.at == "a = 2, b = 2") CHECK(place.entries.empty());
  }
}

TEST_CASE("only the finest mesh with a run counts") {
  StudyData data = study_of({number_axis("T", {1, 2, 3}), number_axis("N", {20, 40})}, {"q_mm"});
  data.along = 1;
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); });
  const std::vector<Sensitivity> places = find_sensitivities(data);
  REQUIRE(places.size() == 1);
  CHECK(places[0].at == "T = 2, N = 40");
  CHECK(places[0].entries[0].derivative == Approx(40.0));
}

TEST_CASE("a sample's gradient is that of the plane through it") {
  StudyData data = sample_of_two(64, {"q_mm", "w_mm"});
  fill(data, 0, [](const StudyData& d, const RunData& run) { return 3.0 * number(d, run, 0) - number(d, run, 1); });
  fill(data, 1, [](const StudyData& d, const RunData& run) { return std::sin(40.0 * number(d, run, 0)); });
  const std::vector<Sensitivity> places = find_sensitivities(data);
  REQUIRE(places.size() == 1);  // no plane explains the second quantity
  CHECK(places[0].at == "the middle of the sample");
  REQUIRE(places[0].entries.size() == 2);
  CHECK(places[0].entries[0].derivative == Approx(3.0));
  CHECK(places[0].entries[1].derivative == Approx(-1.0));
}

TEST_CASE("a sample's two quantities of one product cannot tell its factors apart") {
  StudyData data = sample_of_two(128, {"q_mm", "w_mm"});
  const auto product = [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); };
  fill(data, 0, product);
  fill(data, 1, [&](const StudyData& d, const RunData& run) { return std::sqrt(product(d, run)); });
  const std::vector<Inseparable> pairs = find_inseparable(data, find_sensitivities(data));
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].cosine > 0.98);
}

}  // namespace
