#include "core/compare/result_differences.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/compare/reading.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Json = nlohmann::ordered_json;

RecordedResult solved(const char* path = nullptr, const char* value = nullptr) {
  Simulation simulation = small_planar();
  if (path != nullptr) simulation.set(path, value);
  return read_sound(simulation.solve(plugins()).json());
}

const NumberDifference& find(const std::vector<NumberDifference>& all, const std::string& path) {
  for (const NumberDifference& one : all) {
    if (one.path == path) return one;
  }
  throw std::runtime_error("no number '" + path + "'");
}

/// Distance at which all points of a curve lie from where they were.
Json shifted(const Json& document, const std::string& curve, double dx, double dy) {
  Json out = document;
  for (Json& one : out["curves"]) {
    if (one["name"] != curve) continue;
    for (Json& point : one["points"]) point = {point[0].get<double>() + dx, point[1].get<double>() + dy};
  }
  return out;
}

}  // namespace

TEST_CASE("a result beside itself: every number, and no difference") {
  const RecordedResult result = solved();
  const ResultDifferences found = result_differences(result, result);
  CHECK(found.bits.same());
  CHECK(found.quantities.size() == 10);
  CHECK(found.energies.size() == 5);
  CHECK(found.certificate.size() >= 8);
  for (const NumberDifference& one : found.quantities) CHECK(one.absolute() == 0.0);
  REQUIRE(found.curves.size() == 2);
  for (const CurveDifference& curve : found.curves) CHECK(curve.largest == 0.0);
  CHECK(compare_questions(result, result, &plugins()).none());
}

TEST_CASE("numbers of two results, with absolute and relative difference") {
  const RecordedResult one = solved(), other = solved("energy.axial-tension.tension", "12 N");
  const ResultDifferences found = result_differences(one, other);
  const Json a = Json::parse(one.text), b = Json::parse(other.text);
  const NumberDifference& peak = find(found.quantities, "peak_displacement_mm");
  CHECK(peak.a == a["quantities"]["peak_displacement_mm"].get<double>());
  CHECK(peak.b == b["quantities"]["peak_displacement_mm"].get<double>());
  CHECK(peak.absolute() > 0.1);
  CHECK(peak.relative() == peak.absolute() / peak.a);
  CHECK(find(found.energies, "total").absolute() != 0.0);
  CHECK(find(found.effort, "unknowns").absolute() == 0.0);
  CHECK(find(found.seconds, "solve").a > 0.0);
  const NumberDifference& sum = find(found.forces, "contacts of lunderquist on iliac, sum");
  CHECK(std::fabs(sum.a - a["quantities"]["contact_force_N"].get<double>()) < 1e-12);
  CHECK(std::fabs(find(found.forces, "support of lunderquist, first end").a - 10.0) < 0.02);
  CHECK_FALSE(found.bits.same());

  const Comparison questions = compare_questions(one, other, &plugins());
  REQUIRE(questions.composition.size() == 1);
  CHECK(questions.composition[0].path == "energy.axial-tension.tension");
  CHECK(questions.provenance.empty());
  CHECK(questions.things() == 1);
}

TEST_CASE("the distance of curves: a shift is found whole, on one mesh and between two") {
  const RecordedResult one = solved();
  const RecordedResult moved = read_sound(shifted(Json::parse(one.text), "iliac", 0.3, 0.4).dump());
  const CurveDifference same_mesh = result_differences(one, moved).curves.front();
  CHECK(same_mesh.name == "iliac");
  CHECK(std::fabs(same_mesh.largest - 0.5) < 1e-12);
  CHECK(std::fabs(same_mesh.mean - 0.5) < 1e-12);

  const RecordedResult fine = solved("vessel.iliac.geometry.nodes", "48");
  const CurveDifference near = result_differences(one, fine).curves.front();
  const RecordedResult far = read_sound(shifted(Json::parse(fine.text), "iliac", 30.0, 40.0).dump());
  const CurveDifference between = result_differences(one, far).curves.front();
  CHECK(between.nodes_a == 24);
  CHECK(between.nodes_b == 48);
  CHECK(near.largest > 0.0);
  CHECK(near.largest < 1.0);  // meshes of one curve
  CHECK(near.mean <= near.largest);
  CHECK(std::fabs(between.mean - 50.0) <= near.largest);
  CHECK(std::fabs(between.largest - 50.0) <= near.largest);
}

TEST_CASE("a curve that is in one alone, or not known") {
  const RecordedResult one = solved();
  Json document = Json::parse(one.text);
  document["curves"].erase(1);
  document["curves"][0]["points"][3] = nullptr;
  const RecordedResult other = read_sound(document.dump());
  const auto curves = result_differences(one, other).curves;
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].unknown == "B has it with 'points' that are not known");
  CHECK(curves[1].unknown == "only in A");
  CHECK(result_differences(other, one).curves[1].unknown == "only in B");
}

TEST_CASE("programs and starts count as one thing") {
  const RecordedResult one = solved();
  RecordedResult other = solved("energy.axial-tension.tension", "12 N");
  other.provenance.kernel_sha256 = std::string(64, 'a');
  other.start = StartOrigin{"/somewhere/start.json", std::string(64, 'b')};
  const Comparison questions = compare_questions(one, other, &plugins());
  REQUIRE(questions.provenance.size() == 2);
  CHECK(contains(questions.provenance[0], "kernel: sha256 "));
  CHECK(questions.provenance[1] ==
        "start: from its own start in A, from '/somewhere/start.json' (sha256 bbbbbbbbbbbb…) in B");
  CHECK(questions.things() == 2);
}

TEST_CASE("a start that the composition names is not told twice") {
  const RecordedResult one = solved();
  RecordedResult other = solved("certificate.require", "none");
  Json composition = Json::parse(other.composition);
  composition["start"] = {{"from", "/x.json"}, {"rest", "state-1"}};
  other.composition = composition.dump();
  other.start = StartOrigin{"/x.json", std::string(64, 'b')};
  const Comparison questions = compare_questions(one, other, &plugins());
  CHECK(questions.provenance.empty());
  CHECK(questions.things() == 1);
}

}  // namespace bowstring
