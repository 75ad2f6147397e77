#include "study/analysis/lines.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using doctest::Approx;

TEST_CASE("a line for each formulation, along the mesh") {
  const Lines lines = find_lines(anchoring_study());
  CHECK(lines.over == 2);
  CHECK(lines.axes == std::vector<int>{0, 1});
  REQUIRE(lines.lines.size() == 6);
  CHECK(lines.lines[0].label == "per-length, same-index");
  CHECK(lines.lines[5].label == "per-node, segment-wise");
  CHECK(lines.lines[5].choice == std::vector<int>{1, 2});
  CHECK(lines.lines[1].runs == std::vector<int>{6, 7, 8, 9, 10, 11});
  REQUIRE(lines.lines[1].fits[0]);
  CHECK(lines.lines[1].fits[0]->order == Approx(2.0));
}

TEST_CASE("a line holds the numbers of other axes fixed") {
  StudyData data = study_of({number_axis("N", {80, 20, 40}), number_axis("T", {5, 10}, "N")}, {"q_mm"});
  data.along = 0;
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 1) + 1.0 / number(d, run, 0); });
  const Lines lines = find_lines(data);
  REQUIRE(lines.lines.size() == 2);
  CHECK(lines.lines[1].label == "T = 10 N");
  CHECK(lines.lines[1].runs == std::vector<int>{3, 5, 1});
  REQUIRE(lines.lines[1].fits[0]);
  CHECK(lines.lines[1].fits[0]->order == Approx(1.0));
}

TEST_CASE("a mesh width refines downwards: the unknowns say so") {
  StudyData data = study_of({number_axis("h", {4, 2, 1}, "mm")}, {"q_mm"});
  data.along = 0;
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) { return 3.0 + std::pow(number(d, run, 0), 2.0); });
  for (RunData& run : data.runs) run.unknowns = static_cast<int>(100.0 / number(data, run, 0));
  const Lines lines = find_lines(data);
  REQUIRE(lines.lines.size() == 1);
  CHECK(lines.lines[0].label == "all runs");
  CHECK(lines.lines[0].runs == std::vector<int>{0, 1, 2});
  REQUIRE(lines.lines[0].fits[0]);
  CHECK(lines.lines[0].fits[0]->order == Approx(2.0));
  CHECK(lines.lines[0].fits[0]->limit == Approx(3.0));
  CHECK(finest_mesh(data) == 2);
}

TEST_CASE("without a mesh, lines go over the first number and are not fitted") {
  StudyData data = study_of({words_axis("contact", {"a", "b"}), number_axis("T", {20, 5, 10}, "N")}, {"q_mm"});
  add_product(data);
  const Lines lines = find_lines(data);
  CHECK(lines.over == 1);
  REQUIRE(lines.lines.size() == 2);
  CHECK(lines.lines[1].runs == std::vector<int>{4, 5, 3});
  CHECK_FALSE(lines.lines[0].fits[0]);
}

TEST_CASE("one at a time: a line of one run each") {
  StudyData data = study_of({words_axis("contact", {"b"}), words_axis("vessel", {"c"})}, {"q_mm"});
  add_run(data, {-1, -1});
  add_run(data, {0, -1});
  add_run(data, {-1, 0});
  const Lines lines = find_lines(data);
  REQUIRE(lines.lines.size() == 3);
  CHECK(lines.lines[0].label == "baseline");
  CHECK(lines.lines[1].label == "b");
  CHECK(lines.lines[2].choice == std::vector<int>{-1, 0});
}

TEST_CASE("failed runs stay in their line and are counted by its fit") {
  StudyData data = anchoring_study();
  for (int run = 0; run < 4; ++run) fail(data, run);
  fail(data, 11, "invalid", "folded");
  const Lines lines = find_lines(data);
  CHECK(lines.lines[0].runs.size() == 6);
  CHECK(lines.lines[0].fits[0]->text == "too few: 2 of 6 runs converged, 3 are needed");
  CHECK(lines.lines[1].fits[0]->text == "order 2.00 ± 0.00; 1 of 6 runs failed");
}

TEST_CASE("the points of a sample follow each other in no line: no fit") {
  StudyData data = sample_of_two(8, {"q_mm"});
  const Lines lines = find_lines(data);
  CHECK(lines.over == -1);
  REQUIRE(lines.lines.size() == 1);
  CHECK(lines.lines[0].runs.size() == 8);
  CHECK_FALSE(lines.lines[0].fits[0]);
}

TEST_CASE("an error is relative, but to a reference of 0") {
  StudyData data = anchoring_study();
  CHECK(relative_error(data, 0, 0) == Approx(0.25 / 9.75));
  refer(data, 0, 0.0);
  CHECK(relative_error(data, 0, 0) == Approx(9.5));
  fail(data, 0);
  CHECK(std::isnan(relative_error(data, 0, 0)));
}

}  // namespace
