#include "study/report/report_json.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/study/analysis/fabricated.hpp"

namespace {

using namespace bowstring::study;
using namespace bowstring::testing;
using Json = nlohmann::json;

Json report(const StudyData& data, const Shapes& shapes = {}) {
  return Json::parse(report_json(data, analyse(data), shapes));
}

TEST_CASE("a study along a mesh") {
  StudyData data = anchoring_study();
  data.title = "Anchoring";
  data.energies.push_back({"wire-bending", std::vector<double>(36, 1.5)});
  fail(data, 7);
  const Json json = report(data);
  CHECK(json["format"] == "bowstring.report/1");
  CHECK(json["study"]["title"] == "Anchoring");
  CHECK(json["along"] == 2);
  CHECK(json["line_over"] == 2);
  CHECK(json["line_axes"] == Json({0, 1}));
  CHECK(json["axes"][0]["numbers"].is_null());
  CHECK(json["axes"][2]["numbers"][5] == 640);
  CHECK(json["axes"][2]["spacing"] == "listed");
  CHECK(json["quantities"][0]["values"].size() == 36);
  CHECK(json["quantities"][0]["values"][7].is_null());
  CHECK(json["quantities"][0]["errors"][7].is_null());
  CHECK(json["quantities"][0]["errors"][0].get<double>() == doctest::Approx(0.25 / 9.75));
  CHECK(json["energies"][0]["term"] == "wire-bending");
  CHECK(json["runs"]["choice"].size() == 3);
  CHECK(json["runs"]["choice"][1][35] == 2);
  CHECK(json["runs"]["status"][7] == "stalled");
  CHECK(json["runs"]["solve_seconds"][7].is_null());
  for (const char* key : {"hash", "reason", "second_order", "unknowns", "iterations", "factorizations", "epochs",
                          "max_penetration_dense_mm", "min_stretch", "setup_seconds"}) {
    CHECK_MESSAGE(json["runs"][key].size() == 36, key);
  }
  REQUIRE(json["lines"].size() == 6);
  CHECK(json["lines"][1]["label"] == "per-length, node-wise");
  CHECK(json["lines"][1]["runs"] == Json({6, 7, 8, 9, 10, 11}));
  CHECK(json["lines"][1]["fits"][0]["verdict"] == "converges");
  CHECK(json["lines"][4]["fits"][0]["limit"].is_null());
  CHECK(json["headlines"][0]["kind"] == "recommendation");
  REQUIRE_FALSE(json["effects"].empty());
  CHECK(json["effects"][0]["quantity"] == 0);
  CHECK_FALSE(json["time_effects"].empty());
  CHECK(json["sensitivities"] == Json::array());
  CHECK(json["inseparable"] == Json::array());
  CHECK(json["distributions"] == Json::array());
  CHECK(json["shapes"] == Json::array());
}

TEST_CASE("a sample, without a reference") {
  StudyData data = sample_of_two(64, {"q_mm"});
  fill(data, 0, [](const StudyData& d, const RunData& run) { return number(d, run, 0) + number(d, run, 1); });
  data.quantities[0].reference.clear();
  const Json json = report(data);
  CHECK(json["along"].is_null());
  CHECK(json["line_over"].is_null());
  CHECK(json["line_axes"] == Json::array());
  CHECK(json["quantities"][0]["errors"].is_null());
  CHECK(json["quantities"][0]["references"][0].is_null());
  CHECK(json["lines"][0]["fits"] == Json::array({nullptr}));
  REQUIRE(json["distributions"].size() == 1);
  CHECK(json["distributions"][0]["quantiles"][2][0] == 0.5);
  CHECK(json["distributions"][0]["quantiles"].size() == 5);
  CHECK(json["distributions"][0]["shares"].size() == 2);
  CHECK(json["sensitivities"][0]["entries"].size() == 2);
}

TEST_CASE("shapes") {
  Shapes shapes;
  shapes.text = "x–y plane";
  shapes.shapes.push_back(
      {3, "N = 20", {{"w", true, {0, 1, 2, 3}, {}}, {"v", false, {0, 0, 1, 0}, {0, 1, 1, 1}}}, {{1, 2, 0.5, 0, 0.7}}});
  const Json json = report(anchoring_study(), shapes);
  CHECK(json["shapes_text"] == "x–y plane");
  CHECK(json["shapes"][0]["run"] == 3);
  CHECK(json["shapes"][0]["curves"][0]["kind"] == "wire");
  CHECK(json["shapes"][0]["curves"][0]["points"] == Json({{0, 1}, {2, 3}}));
  CHECK(json["shapes"][0]["curves"][0]["rest"].is_null());
  CHECK(json["shapes"][0]["curves"][1]["kind"] == "vessel");
  CHECK(json["shapes"][0]["curves"][1]["rest"] == Json({{0, 1}, {1, 1}}));
  CHECK(json["shapes"][0]["contacts"][0]["force_N"] == 0.7);
}

TEST_CASE("names of any kind, and an empty study") {
  StudyData data = anchoring_study();
  data.title = "</script>\"\\\n\xff";
  CHECK(report(data)["study"]["title"].get<std::string>().rfind("</script>\"\\\n", 0) == 0);
  const Json empty = report(study_of({}, {}));
  CHECK(empty["lines"] == Json::array());
  CHECK(empty["runs"]["hash"] == Json::array());
}

TEST_CASE("equal input gives equal bytes") {
  CHECK(report_json(anchoring_study(), analyse(anchoring_study()), {}) ==
        report_json(anchoring_study(), analyse(anchoring_study()), {}));
}

}  // namespace
