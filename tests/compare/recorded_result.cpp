#include "core/result/recorded_result.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

Lines flaws_of(const std::string& text) {
  std::vector<DocumentFlaw> flaws;
  read_result(text, "it", flaws);
  Lines out;
  for (const DocumentFlaw& flaw : flaws) out.push_back(flaw.found + "; expected " + flaw.expected);
  return out;
}

Json small_document() { return Json::parse(small_planar().solve(plugins()).json()); }

RecordedResult read(const Json& document) {
  std::vector<DocumentFlaw> flaws;
  RecordedResult out = read_result(document.dump(), "it", flaws);
  REQUIRE(flaws.empty());
  return out;
}

}  // namespace

TEST_CASE("what a document says of its question") {
  const Json document = small_document();
  const RecordedResult result = read(document);
  CHECK(result.status == "converged");
  CHECK(result.composition == document["composition"].dump());
  CHECK(result.provenance.plugins.size() == document["provenance"]["plugins"].size());
  CHECK(result.provenance.plugins.size() > 3);
  CHECK_FALSE(result.start);
  CHECK(result.predecessor == "");
}

TEST_CASE("of a study's run the one that it started from") {
  Json document = small_document();
  document["study"] = {{"name", "s"}, {"run", 3}, {"hash", "abcd"}, {"predecessor", nullptr}};
  CHECK(read(document).predecessor == "");
  document["study"]["predecessor"] = "1234";
  document["provenance"]["start"] = {{"file", nullptr}, {"sha256", "ff"}};
  const RecordedResult result = read(document);
  CHECK(result.predecessor == "1234");
  REQUIRE(result.start);
  CHECK(result.start->file == "");
  CHECK(result.start->sha256 == "ff");
}

TEST_CASE("of a chain the first state's composition, and the plugins of all states") {
  const RecordedResult chain =
      read(Json::parse(Simulation::from_file(scene_file("wire-exchange.toml")).solve(plugins()).json()));
  CHECK(Json::parse(chain.composition)["step"].size() == 2);

  Json without = Json::parse(chain.text);
  without["states"][0]["composition"].erase("step");
  CHECK(flaws_of(without.dump()) == Lines{"it has states, but a composition without 'step'; expected the steps in the "
                                          "composition of the first state"});
}

TEST_CASE("all that is wrong with a document at once") {
  const std::string wanted = "; expected a result document, as `bowstring solve --out` writes it";
  CHECK(contains(flaws_of("schema = 1").front(), "it is no JSON (parse error at line 1, column 1"));
  CHECK(flaws_of("[1]") == Lines{"it is JSON that is a list" + wanted});
  CHECK(flaws_of("{}") == Lines{"it is JSON without 'format'" + wanted});
  CHECK(flaws_of(R"({"format": "other/2"})") == Lines{"it has format \"other/2\"; expected \"bowstring.result/1\""});
  Json document = small_document();
  document.erase("state");
  document["curves"] = 3;
  document["states"] = Json::array({1, Json::object()});
  CHECK(flaws_of(document.dump()) ==
        Lines{"it has 3 as 'curves'; expected a list", "it has no 'state'; expected a table",
              "it has 1 as entry 0 of 'states'; expected a table", "it has no 'states.1.composition'; expected a table",
              "it has no 'states.1.provenance'; expected a table"});
}

}  // namespace bowstring
