#include "study/analysis/recommendation.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using doctest::Approx;

/// Two formulations on three meshes with these errors and seconds.
StudyData two(const std::vector<double>& errors, const std::vector<double>& seconds) {
  StudyData data =
      study_of({words_axis("contact", {"node-wise", "segment-wise"}), number_axis("N", {20, 40, 80})}, {"q_mm"});
  data.along = 1;
  add_product(data);
  for (std::size_t run = 0; run < 6; ++run) {
    data.quantities[0].value[run] = 10.0 * (1.0 + errors[run]);
    data.runs[run].solve_seconds = seconds[run];
  }
  refer(data, 0, 10.0);
  return data;
}

TEST_CASE("the fastest run from which on the error stays below the target") {
  const Recommendation out = recommend(two({0.1, 0.004, 0.001, 0.02, 0.015, 0.006}, {1, 2, 4, 1, 2, 5}));
  REQUIRE(out.candidates.size() == 2);
  CHECK(out.candidates[0].mesh == 1);
  CHECK(out.candidates[0].error == Approx(0.004));
  CHECK(out.candidates[1].mesh == 2);
  CHECK(out.text == "Use node-wise at N = 40: 0.4 % in 2 s, 2.5 times faster than segment-wise");
  CHECK(out.detail ==
        "To bring q_mm within 1 % of the known answer, and keep it there on finer meshes: node-wise: N = 40, 0.4 % in "
        "2 s; "
        "segment-wise: N = 80, 0.6 % in 5 s.");
}

TEST_CASE("a crossing of the reference does not count") {
  const Recommendation out = recommend(two({0.1, 0.001, 0.05, 0.02, 0.015, 0.006}, {1, 2, 4, 1, 2, 5}));
  CHECK(out.text == "Use segment-wise at N = 80: 0.6 % in 5 s; node-wise does not stay within 1 %");
}

TEST_CASE("what never gets there is told with what it reached") {
  const Recommendation out = recommend(two({0.1, 0.06, 0.12, 0.02, 0.005, 0.001}, {1, 2, 4, 1, 2, 5}));
  CHECK(out.text == "Use segment-wise at N = 40: 0.5 % in 2 s; node-wise never gets below 6 %");
}

TEST_CASE("within noise both are named") {
  const Recommendation out = recommend(two({0.1, 0.004, 0.001, 0.02, 0.005, 0.001}, {1, 2, 4, 1, 2.3, 5}));
  CHECK(out.text ==
        "Use node-wise at N = 40 or segment-wise at N = 40: 0.4 % in 2 s and 0.5 % in 2.3 s, as fast as each other");
}

TEST_CASE("more than two that are as fast are counted, and of equal times the coarser mesh is taken") {
  StudyData data = study_of({words_axis("contact", {"a", "b", "c", "d"}), number_axis("N", {20, 40})}, {"q_mm"});
  data.along = 1;
  add_product(data);
  data.quantities[0].value.assign(8, 1.001);
  refer(data, 0, 1.0);
  for (int run : {6, 7}) data.runs[static_cast<std::size_t>(run)].solve_seconds = 5.0;
  CHECK(recommend(data).text == "Use a at N = 20: 0.1 % in 1 s, 5 times faster than d; 2 others are as fast");
}

TEST_CASE("alternatives that are cases are not chosen between, and the worst of them counts") {
  StudyData data = study_of({words_axis("contact", {"node-wise", "segment-wise"}),
                             words_axis("scene", {"planar", "helical"}), number_axis("N", {20, 40})},
                            {"q_mm"});
  data.axes[1].problem = {0, 1};
  data.along = 2;
  add_product(data);
  data.quantities[0].value = {1.001, 1.001, 1.05, 1.004, 1.002, 1.001, 1.003, 1.001};
  refer(data, 0, 1.0);
  for (std::size_t run = 4; run < 8; ++run) data.runs[run].solve_seconds = 4.0;
  const Recommendation out = recommend(data);
  REQUIRE(out.candidates.size() == 2);
  CHECK(out.candidates[0].error == Approx(0.004));
  CHECK(out.text == "Use node-wise at N = 40: 0.4 % in 1 s, 4 times faster than segment-wise");
}

TEST_CASE("a finer mesh that is faster is the one to use") {
  CHECK(recommend(two({0.005, 0.004, 0.001, 0.1, 0.1, 0.1}, {9, 2, 4, 1, 2, 5})).candidates[0].mesh == 1);
}

TEST_CASE("where nothing gets there the most accurate is named") {
  const Recommendation out = recommend(two({0.1, 0.06, 0.12, 0.2, 0.2, 0.2}, {1, 2, 4, 1, 2, 5}));
  CHECK(out.text == "No formulation brings q_mm within 1 %: the most accurate is node-wise at N = 40, with 6 % in 2 s");
}

TEST_CASE("runs that did not converge, were invalid or were not timed do not count and are told") {
  StudyData data = two({0.1, 0.004, 0.001, 0.02, 0.015, 0.006}, {1, 2, 4, 1, 2, 5});
  data.runs[1].status = "invalid";
  data.runs[4].solve_seconds = std::numeric_limits<double>::quiet_NaN();
  const Recommendation out = recommend(data);
  CHECK(out.candidates[0].mesh == 2);
  CHECK(out.candidates[0].failures == 1);
  CHECK(out.detail.find("node-wise: N = 80, 0.1 % in 4 s (1 of 3 runs failed)") != std::string::npos);
  for (int run = 3; run < 6; ++run) fail(data, run);
  CHECK(recommend(data).text ==
        "Use node-wise at N = 80: 0.1 % in 4 s; segment-wise has no mesh on which all runs converge");
  for (int run = 0; run < 3; ++run) fail(data, run);
  CHECK(recommend(data).text.empty());
}

TEST_CASE("other numbers are cases: the largest error counts") {
  StudyData data = study_of(
      {words_axis("contact", {"a", "b"}), number_axis("T", {5, 10}, "N"), number_axis("N", {20, 40})}, {"q_mm"});
  data.along = 2;
  add_product(data);
  const double errors[8] = {0.001, 0.0005, 0.03, 0.002, 0.005, 0.001, 0.006, 0.001};
  for (std::size_t run = 0; run < 8; ++run) data.quantities[0].value[run] = 1.0 + errors[run];
  refer(data, 0, 1.0);
  for (RunData& run : data.runs) run.solve_seconds = run.choice[2] == 0 ? 1.0 : 4.0;
  const Recommendation out = recommend(data);
  CHECK(out.text == "Use b at N = 20: 0.6 % in 1 s, 4 times faster than a");
  CHECK(out.candidates[0].runs == std::vector<int>{4, 6});
  CHECK(out.detail.find("the mean of 2 cases.") != std::string::npos);
}

TEST_CASE("without a mesh every formulation has one point") {
  StudyData data = study_of({words_axis("contact", {"a", "b", "c"})}, {"q_mm"});
  add_product(data);
  data.quantities[0].value = {1.001, 1.1, 1.0};
  refer(data, 0, 1.0);
  fail(data, 2);
  const Recommendation out = recommend(data);
  CHECK(out.text == "Use a: 0.1 % in 1 s; b never gets below 10 %");
  CHECK(out.detail ==
        "To bring q_mm within 1 % of the known answer: a: 0.1 % in 1 s; b: never below 10 %; c: did not converge in "
        "every "
        "case (1 of 1 run failed).");
}

TEST_CASE("a study of one formulation") {
  StudyData data = study_of({number_axis("N", {20, 40})}, {"q_mm"});
  data.along = 0;
  add_product(data);
  data.quantities[0].value = {1.1, 1.001};
  refer(data, 0, 1.0);
  CHECK(recommend(data).text == "Use N = 40: 0.1 % in 1 s");
}

TEST_CASE("the anchoring study: one alternative names all that lost") {
  const Recommendation out = recommend(anchoring_study());
  CHECK(out.text ==
        "Use per-length, same-index at N = 40: 0.64 % in 40 ms, 2 times faster than with node-wise; "
        "per-node never gets below 2.1 %");
}

TEST_CASE("two alternatives name all that lost") {
  StudyData data = study_of({words_axis("anchoring", {"per-length", "per-node"}),
                             words_axis("vessel", {"with stretch", "bending only"}), words_axis("contact", {"a", "b"})},
                            {"q_mm"});
  add_product(data);
  data.quantities[0].value = {1.001, 1.002, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7};
  for (std::size_t run = 0; run < 8; ++run) data.runs[run].solve_seconds = 1.0 + static_cast<double>(run);
  refer(data, 0, 1.0);
  CHECK(
      recommend(data).text ==
      "Use per-length, with stretch, a: 0.1 % in 1 s, 2 times faster than with b; per-node and bending only never get "
      "below 20 %");
}

TEST_CASE("without a reference there is nothing to recommend") {
  StudyData data = anchoring_study();
  data.quantities[0].reference_text.clear();
  CHECK(recommend(data).text.empty());
  CHECK(recommend(study_of({}, {})).text.empty());
}

}  // namespace
