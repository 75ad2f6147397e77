#include "core/composition/resolved_toml.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/procedure/procedure.hpp"
#include "core/result/document.hpp"
#include "tests/plugins/plugin_folders.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Json = nlohmann::ordered_json;

CompositionRequest of_scene(const std::string& name, std::vector<Override> overrides = {}) {
  CompositionRequest out;
  out.file = scene_file(name);
  out.overrides = std::move(overrides);
  return out;
}

CompositionRequest of_json(const std::string& json) {
  CompositionRequest out;
  out.file = "again.toml";
  out.text = resolved_toml(json);
  return out;
}

std::string resolved(const CompositionRequest& request) {
  const CompositionOutcome outcome = load_composition(request, plugins());
  REQUIRE_MESSAGE(outcome.composition, (outcome.errors.empty() ? "" : outcome.errors.front().text()));
  return outcome.composition->resolved_json;
}

std::string solved(const CompositionRequest& request) {
  Refusal refusal;
  const std::unique_ptr<Procedure> procedure = Procedure::prepare(request, plugins(), refusal);
  REQUIRE_MESSAGE(procedure != nullptr, refusal.text());
  return result_document(procedure->run({}));
}

/// What a document was asked; of a chain, by its first state.
std::string asked(const std::string& document) {
  const Json whole = Json::parse(document);
  const Json& first = whole["states"].empty() ? whole : whole["states"][0];
  const Json& walk = first["continuation"];
  return walk.is_object() && walk["asked_composition"].is_object() ? walk["asked_composition"].dump()
                                                                   : first["composition"].dump();
}

/// A document without seconds, and without texts in which a place of the composition stands.
Json timeless(const std::string& document) {
  Json out = Json::parse(document);
  out["solver"].erase("seconds");
  out.erase("warnings");
  for (Json& state : out["states"]) {
    state["solver"].erase("seconds");
    state.erase("warnings");
  }
  return out;
}

void check_same_bits(const CompositionRequest& request) {
  const std::string first = solved(request);
  const std::string again = solved(of_json(asked(first)));
  REQUIRE(Json::parse(first)["energy"]["total"].get<double>() != 0.0);
  CHECK(asked(again) == asked(first));
  CHECK(timeless(again) == timeless(first));
}

}  // namespace

TEST_CASE("every shipped scene, resolved and written as TOML, resolves to the same text") {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scene_file(""))) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().filename().string();
    const CompositionOutcome outcome = load_composition(of_scene(name), plugins());
    if (!outcome.plugin_failure.ok()) continue;  // of a plugin that this build does not have
    REQUIRE_MESSAGE(outcome.composition, name);
    const std::string first = outcome.composition->resolved_json;
    CHECK_MESSAGE(resolved(of_json(first)) == first, name);
    ++read;
  }
  CHECK(read >= 12);
}

TEST_CASE("what it says is solved to the same bits") {
  SUBCASE("a solve") { check_same_bits(of_scene("planar-iliac-smooth.toml")); }
  SUBCASE("in space") { check_same_bits(of_scene("helical-iliac.toml")); }
  SUBCASE("a walk through folds") { check_same_bits(of_scene("shallow-arch.toml")); }
  SUBCASE("a chain of states") { check_same_bits(of_scene("wire-exchange.toml")); }
  SUBCASE("several starts") {
    check_same_bits(of_scene("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "24"},
                                                          {"multistart.starts", "3"},
                                                          {"multistart.seed", "7"},
                                                          {"multistart.perturbation", "0.5 mm"}}));
  }
}

TEST_CASE("a chain holds its steps as what they change, whatever paths they are written with") {
  std::string first_step;
  SUBCASE("by place") { first_step = "\"wire.lunderquist.ends.first\" = \"clamped\""; }
  SUBCASE("by a type, which then is another") {
    first_step = "\"constraint.node-wise-contact.type\" = \"segment-wise-contact\"";
  }
  SUBCASE("by what fits nothing once it was applied") {
    first_step = "\"wire.lunderquist.ends.first\" = \"clamped\"\n\"wire.lunderquist.ends.pinned\" = \"clamped\"";
  }
  CompositionRequest request;
  request.file = scene_file("chain.toml");
  request.text =
      "schema = 1\nbase = \"planar-iliac-smooth.toml\"\n[set]\n\"vessel.iliac.geometry.nodes\" = 24\n"
      "[[step]]\nname = \"in\"\n" +
      first_step +
      "\n[[step]]\n\"energy.axial-tension.tension\" = \"12 N\"\n"
      "\"wire.lunderquist.ends.first\" = { type = \"clamped\", turn = \"-5 deg\" }\n"
      "[[step]]\nname = \"at rest\"\nrest = \"previous\"\n\"solver.tolerance\" = 1e-9\n";
  CompositionOutcome probe = load_composition(request, plugins());
  REQUIRE_MESSAGE(probe.composition, (probe.errors.empty() ? "" : probe.errors.front().text()));
  const Json steps = Json::parse(probe.composition->resolved_json)["step"];
  REQUIRE(steps.size() == 3);
  CHECK(steps[0] == Json{{"name", "in"}});
  CHECK(steps[1]["name"] == "2");
  CHECK(steps[1].contains("energy"));
  CHECK_FALSE(steps[1].contains("vessel"));
  CHECK(steps[2]["rest"] == "previous");
  CHECK(steps[2]["solver"]["tolerance"] == 1e-9);
  CHECK(resolved(of_json(probe.composition->resolved_json)) == probe.composition->resolved_json);
  check_same_bits(request);
}

TEST_CASE("a later state's composition is that of the state alone") {
  CompositionRequest request = of_scene("wire-exchange.toml");
  request.step = 1;
  request.from_memory = true;
  const Json later = Json::parse(resolved(request));
  CHECK_FALSE(later.contains("step"));
  request.text = resolved_toml(later.dump());
  request.step = 0;
  CHECK(resolved(request) == later.dump());
}

TEST_CASE("what was asked of a fallback walk stays, though the walk leaves another value") {
  const CompositionRequest request =
      of_scene("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "24"},
                                            {"solver.max-iterations", "2"},
                                            {"continuation.path", "solver.max-iterations"},
                                            {"continuation.from", "1"},
                                            {"continuation.to", "101"},
                                            {"continuation.when", "fallback"}});
  const Json document = Json::parse(solved(request));
  REQUIRE(document["status"] == "converged");
  CHECK(document["composition"]["solver"]["max-iterations"] == 101);
  CHECK(document["continuation"]["asked_composition"]["solver"]["max-iterations"] == 2);
  check_same_bits(request);
}

TEST_CASE("a first step that makes the state that it starts from the rest state says so") {
  const TemporaryFolder folder;
  const std::string start = folder.write("start.json", solved(of_scene("planar-iliac-smooth.toml")));
  CompositionRequest request;
  request.file = scene_file("chain.toml");
  request.text = "schema = 1\nbase = \"planar-iliac-smooth.toml\"\n[start]\nfrom = \"" + start +
                 "\"\n[[step]]\nrest = \"previous\"\n[[step]]\n";
  const Json composition = Json::parse(resolved(request));
  CHECK(composition["start"]["rest"] == "previous");
  const Json document = Json::parse(solved(request));
  CHECK_FALSE(document["states"][0]["curves"][0]["state_1_points"].is_null());
  check_same_bits(request);
}

TEST_CASE("where a walk and several starts began is where their composition did") {
  const CompositionRequest walked = of_scene("shallow-arch.toml");
  CHECK_FALSE(Json::parse(solved(walked))["provenance"].contains("start"));
  const TemporaryFolder folder;
  const std::string start = folder.write("start.json", solved(of_scene("planar-iliac-smooth.toml")));
  const std::string several = solved(of_scene(
      "planar-iliac-smooth.toml", {{"start.from", start}, {"multistart.starts", "2"}, {"multistart.seed", "1"}}));
  CHECK(Json::parse(several)["provenance"]["start"]["file"] == start);
}

TEST_CASE("texts and keys that TOML writes otherwise than JSON") {
  const std::string json =
      "{\"schema\":1,\"title\":\"a \\\"b\\\" \\\\ \\u0001 \x7f é\",\"plugin-path\":[],\"scene\":{\"dimension\":2},"
      "\"vessel\":[{\"name\":\"v\",\"radius\":{\"segments\":{\"e i a\":5.0,\"\":1e-08}}}],\"step\":[{\"name\":\"1\"}]}";
  CHECK(resolved_toml(json) ==
        "schema = 1\ntitle = \"a \\\"b\\\" \\\\ \\u0001 \\u007F é\"\nplugin-path = []\n"
        "\n[scene]\ndimension = 2\n"
        "\n[[vessel]]\nname = \"v\"\nradius = { segments = { \"e i a\" = 5.0, \"\" = 1e-08 } }\n"
        "\n[[step]]\nname = \"1\"\n");
  CHECK(toml_value("{}") == "{}");
  CHECK(toml_value("[[0.0, \"5 mm\"], true]") == "[[0.0, \"5 mm\"], true]");
  CHECK(path_step("e i a") == "e i a");
  CHECK(path_step("a.b") == "\"a.b\"");
  CHECK(path_step("a\"b") == "'a\"b'");
}

}  // namespace bowstring
