#include "study/analysis/causes.hpp"

#include <doctest/doctest.h>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;

template <class Hit>
std::vector<Case> cases(const StudyData& data, Hit hit) {
  std::vector<Case> out;
  for (const RunData& run : data.runs) out.push_back({run.choice, hit(run)});
  return out;
}

StudyData grid() {
  StudyData data =
      study_of({words_axis("kinematics", {"nodes", "edge-frames"}),
                words_axis("vessel", {"bending only", "with stretch"}), number_axis("N", {20, 40, 80, 160, 320})},
               {});
  add_product(data);
  return data;
}

TEST_CASE("a pure split by one alternative") {
  const StudyData data = grid();
  const Cause cause = find_cause(cases(data, [](const RunData& run) { return run.choice[1] == 0; }), {0, 1, 2});
  REQUIRE(cause.found());
  CHECK(cause.pure());
  CHECK(conditions_text(data, cause.conditions) == "vessel = bending only");
  CHECK(cause.hits_with == 10);
  CHECK(cause.without == 10);
}

TEST_CASE("the numbers from one on") {
  const StudyData data = grid();
  const Cause fine = find_cause(cases(data, [](const RunData& run) { return run.choice[2] >= 3; }), {0, 1, 2});
  CHECK(conditions_text(data, fine.conditions) == "N ≥ 160");
  const Cause coarse = find_cause(cases(data, [](const RunData& run) { return run.choice[2] < 2; }), {0, 1, 2});
  CHECK(conditions_text(data, coarse.conditions) == "N ≤ 40");
  const Cause apart = find_cause(cases(data, [](const RunData& run) { return run.choice[2] % 3 == 0; }), {0, 1, 2});
  CHECK(conditions_text(data, apart.conditions) == "N = 20 or 160");
}

TEST_CASE("a failing corner takes two axes") {
  const StudyData data = grid();
  const Cause cause =
      find_cause(cases(data, [](const RunData& run) { return run.choice[1] == 0 && run.choice[2] >= 3; }), {0, 1, 2});
  CHECK(conditions_text(data, cause.conditions) == "vessel = bending only and N ≥ 160");
  CHECK(cause.pure());
  CHECK(cause.with == 4);
}

TEST_CASE("an impure split is counted, and noise is no split") {
  const StudyData data = grid();
  const Cause cause = find_cause(
      cases(data, [](const RunData& run) { return run.choice[0] == 0 && !(run.choice[1] == 1 && run.choice[2] == 2); }),
      {0, 1, 2});
  CHECK(conditions_text(data, cause.conditions) == "kinematics = nodes");
  CHECK_FALSE(cause.pure());
  CHECK(cause.hits_with == 9);
  CHECK(cause.with == 10);
  CHECK(cause.hits_without == 0);
  const Cause none = find_cause(
      cases(data, [](const RunData& run) { return (run.choice[0] + run.choice[1] + run.choice[2]) % 2 == 0; }),
      {0, 1, 2});
  CHECK_FALSE(none.found());
  CHECK_FALSE(find_cause(cases(data, [](const RunData&) { return true; }), {0, 1, 2}).found());
  CHECK_FALSE(find_cause(cases(data, [](const RunData&) { return false; }), {0, 1, 2}).found());
  CHECK_FALSE(find_cause({}, {}).found());
}

TEST_CASE("rare failures are explained as well as frequent ones") {
  StudyData data =
      study_of({words_axis("kinematics", {"nodes", "frames"}), number_axis("T", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10})}, {});
  add_product(data);
  const Cause cause =
      find_cause(cases(data, [](const RunData& run) { return run.choice[0] == 0 && run.choice[1] == 9; }), {0, 1});
  CHECK(conditions_text(data, cause.conditions) == "T = 10");
  CHECK(cause.hits_with == 1);
  CHECK(cause.with == 2);
}

TEST_CASE("an axis without part in a run is an alternative") {
  StudyData data = study_of({words_axis("contact", {"b", "c"})}, {});
  for (int k : {-1, 0, 1}) add_run(data, {k});
  const Cause cause = find_cause(cases(data, [](const RunData& run) { return run.choice[0] < 0; }), {0});
  CHECK(conditions_text(data, cause.conditions) == "without contact");
}

}  // namespace
