#include "study/analysis/headlines.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "study/analysis/words.hpp"
#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;

TEST_CASE("the anchoring study opens with what to use and what keeps it from converging") {
  const Analysis analysis = analyse(anchoring_study());
  REQUIRE(analysis.headlines.size() == 3);
  CHECK(analysis.headlines[0].kind == HeadlineKind::recommendation);
  CHECK(analysis.headlines[1].kind == HeadlineKind::convergence);
  CHECK(analysis.headlines[1].text ==
        "What keeps peak_displacement_mm from converging is anchoring = per-node: 0 of 3 lines with it settle, 3 of 3 "
        "without (order 2.0)");
  CHECK(analysis.headlines[1].detail.rfind("per-node, same-index and 2 more: moves by 27 % with every doubling; ", 0) ==
        0);
  CHECK(analysis.headlines[2].kind == HeadlineKind::effect);
  for (const Headline& h : analysis.headlines) CHECK(characters(h.text) <= headline_length);
}

TEST_CASE("all lines settle, one of them beside the reference") {
  StudyData data = anchoring_study();
  fill(data, 0, [](const StudyData& d, const RunData& run) {
    const bool other = run.choice[0] == 1 && run.choice[1] == 1;
    return (other ? 9.85 : 9.75) - 100.0 * std::pow(number(d, run, 2), -2.0);
  });
  const Analysis analysis = analyse(data);
  CHECK(analysis.headlines[1].text ==
        "peak_displacement_mm converges in all 6 lines (order 2.0), 1 of them beside the reference");
  CHECK(analysis.headlines[1].detail.find(
            "per-node, node-wise: settles, order 2.00 ± 0.00, 1 % beside the reference. Beside the reference, by 1 %, "
            "settle 1 of 6: 1 of 1 with anchoring = per-node and contact = node-wise.") != std::string::npos);
}

TEST_CASE("an impure split, none, and a single line") {
  StudyData data = anchoring_study();
  for (int run = 18; run < 24; ++run) {  // per-node, same-index settles
    data.quantities[0].value[static_cast<std::size_t>(run)] =
        data.quantities[0].value[static_cast<std::size_t>(run - 18)];
  }
  CHECK(analyse(data).headlines[1].text ==
        "What keeps peak_displacement_mm from converging is anchoring = per-node and contact = node-wise or "
        "segment-wise: "
        "0 of 2 lines with it settle, 4 of 4 without (order 2.0)");
  StudyData one = study_of({number_axis("N", {40, 60, 80, 120, 160})}, {"peak_displacement_mm"});
  one.along = 0;
  add_product(one);
  one.quantities[0].value = {13.10, 11.30, 9.97, 8.10, 6.89};
  REQUIRE(analyse(one).headlines.size() == 1);
  CHECK(analyse(one).headlines[0].text == "peak_displacement_mm does not settle: it moves by 31 % with every doubling");
  for (int run : {0, 2, 4}) fail(one, run);
  CHECK(analyse(one).headlines[0].text ==
        "peak_displacement_mm: too few runs converged to tell whether it settles as the mesh is refined");
}

TEST_CASE("an ablation opens with its largest effect") {
  StudyData data =
      study_of({words_axis("contact", {"b"}), words_axis("anchoring", {"per-node"})}, {"peak_displacement_mm"});
  add_run(data, {-1, -1});
  add_run(data, {0, -1});
  add_run(data, {-1, 0});
  data.quantities[0].value = {10.0, 10.1, 6.9};
  const Analysis analysis = analyse(data);
  REQUIRE(analysis.headlines.size() == 1);
  CHECK(analysis.headlines[0].text ==
        "anchoring = per-node instead of the baseline lowers peak_displacement_mm by 31 %");
  CHECK(analysis.headlines[0].detail ==
        "Over 1 pair of converged runs; most, by -3.1 mm, at per-node. Then: contact = b instead of the baseline "
        "raises it by "
        "1 %.");
}

TEST_CASE("an effect over several pairs has its interval") {
  StudyData data = study_of({words_axis("contact", {"a", "b"}), words_axis("vessel", {"c", "d", "e"})}, {"q_mm"});
  add_product(data);
  data.quantities[0].value = {10, 10, 10, 8, 8.1, 7.9};
  CHECK(analyse(data).headlines[0].text == "contact = b instead of a lowers q_mm by 20 % (95 %: 18…22 %)");
}

TEST_CASE("alternatives that change nothing") {
  StudyData data = study_of({words_axis("kinematics", {"nodes", "frames", "both"})}, {"q_mm"});
  add_product(data);
  data.quantities[0].value = {10, 10 + 1e-9, 10};
  CHECK(analyse(data).headlines[0].text == "No alternative changes q_mm");
  data.quantities[0].value = {10, 10 + 1e-9, 11};
  CHECK(analyse(data).headlines[0].text == "kinematics = both instead of nodes raises q_mm by 10 %");
  CHECK(analyse(data).headlines[0].detail ==
        "Over 1 pair of converged runs; most, by 1 mm, at both. Then: kinematics = frames instead of nodes leaves it "
        "as it "
        "is.");
}

TEST_CASE("a sample opens with its distribution, and warns of parameters that act alike") {
  StudyData data = sample_of_two(512, {"q_mm", "w_mm"});
  const auto product = [](const StudyData& d, const RunData& run) { return number(d, run, 0) * number(d, run, 1); };
  fill(data, 0, product);
  fill(data, 1, [&](const StudyData& d, const RunData& run) { return std::sqrt(product(d, run)); });
  const Analysis analysis = analyse(data);
  REQUIRE(analysis.headlines.size() == 2);
  CHECK(analysis.headlines[0].kind == HeadlineKind::effect);
  CHECK(analysis.headlines[0].text == "q_mm: median 5.78 mm, 5…95 %: 2.97…9.82 mm; a makes up 68 % of its variance");
  CHECK(analysis.headlines[1].kind == HeadlineKind::warning);
  CHECK(analysis.headlines[1].text.rfind("a and b act alike (cosine ", 0) == 0);
}

TEST_CASE("a grid opens with the parameter that matters most") {
  std::vector<double> numbers;
  for (int k = 1; k <= 9; ++k) numbers.push_back(std::pow(2.0, k));
  StudyData data = study_of({number_axis("T", numbers, "N", Spacing::logarithmic),
                             number_axis("EI", numbers, "N mm^2", Spacing::logarithmic)},
                            {"q_mm"});
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) {
    return 100.0 + std::log(number(d, run, 0)) - 2.0 * std::log(number(d, run, 1));
  });
  const Analysis analysis = analyse(data);
  REQUIRE(analysis.headlines.size() == 2);
  CHECK(analysis.headlines[0].text == "1 % more of EI lowers q_mm by 0.021 %, of T raises it by 0.01 %");
  CHECK(analysis.headlines[0].detail.rfind("Medians of the size over the places of the grid; EI -0.0", 0) == 0);
  CHECK(analysis.headlines[1].kind == HeadlineKind::warning);
}

TEST_CASE("parameters about one place") {
  StudyData data =
      study_of({number_axis("T", {9.8, 10.0, 10.2}, "N"), number_axis("R", {5.9, 6.0, 6.1}, "mm")}, {"q_mm"});
  for (int k : {0, 1, 2}) add_run(data, {k, 1});
  for (int k : {0, 2}) add_run(data, {1, k});
  fill(data, 0,
       [](const StudyData& d, const RunData& run) { return std::pow(number(d, run, 0), 2.0) * number(d, run, 1); });
  const Analysis analysis = analyse(data);
  REQUIRE(!analysis.headlines.empty());
  CHECK(analysis.headlines[0].text == "1 % more of T raises q_mm by 2 %, of R by 1 %");
  CHECK(analysis.headlines[0].detail == "What 1 % more of each does: T 2 %; R 1 %.");
}

TEST_CASE("reasons that differ in numbers alone are one") {
  StudyData data = anchoring_study();
  for (int run = 0; run < 36; ++run) {
    fail(
        data, run, "stalled",
        run < 20 ? "edge " + std::to_string(run) + " has folded: stretch 1.5e-0" + std::to_string(run % 7) : "no step");
  }
  const Analysis analysis = analyse(data);
  REQUIRE(!analysis.headlines.empty());
  CHECK(analysis.headlines.back().detail == "20 like: edge 0 has folded: stretch 1.5e-00; 16: no step.");
}

TEST_CASE("failures are counted, with what they have in common") {
  StudyData data = anchoring_study();
  for (int run = 0; run < 36; ++run) {
    const RunData& own = data.runs[static_cast<std::size_t>(run)];
    if (own.choice[1] == 1 && own.choice[2] >= 4) fail(data, run, run % 2 ? "invalid" : "stalled", "edge 3 has folded");
  }
  const Analysis analysis = analyse(data);
  REQUIRE(analysis.headlines.size() == 5);
  CHECK(analysis.headlines[3].kind == HeadlineKind::warning);
  CHECK(analysis.headlines[3].text ==
        "2 of 36 runs came out invalid: they satisfy every row and are no equilibrium of the curves");
  CHECK(analysis.headlines[4].kind == HeadlineKind::failures);
  CHECK(analysis.headlines[4].text ==
        "4 of 4 failures have contact = node-wise and N ≥ 320; of 4 runs with it 4 fail, of 32 without 0");
  CHECK(analysis.headlines[4].detail == "4 of 36 runs did not converge: 2 invalid, 2 stalled. 4: edge 3 has folded.");
}

TEST_CASE("nothing but failures") {
  StudyData data = anchoring_study();
  for (int run = 0; run < 36; ++run) fail(data, run, "refused", "no such curve");
  const Analysis analysis = analyse(data);
  REQUIRE(analysis.headlines.size() == 2);
  CHECK(analysis.headlines[1].text == "36 of 36 runs did not converge: 36 refused");
  CHECK(analysis.headlines[1].detail == "36: no such curve.");
  CHECK(analyse(study_of({}, {})).headlines.empty());
}

TEST_CASE("the same data give the same words") {
  const Analysis one = analyse(anchoring_study()), other = analyse(anchoring_study());
  REQUIRE(one.headlines.size() == other.headlines.size());
  for (std::size_t k = 0; k < one.headlines.size(); ++k) {
    CHECK(one.headlines[k].text == other.headlines[k].text);
    CHECK(one.headlines[k].detail == other.headlines[k].detail);
  }
}

TEST_CASE("names of kinds") {
  CHECK(std::string(headline_kind_name(HeadlineKind::recommendation)) == "recommendation");
  CHECK(std::string(headline_kind_name(HeadlineKind::failures)) == "failures");
}

}  // namespace
