#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::entries;
using testing::read_text;
using testing::replaced;
using testing::TemporaryFolder;

namespace {

using Json = nlohmann::ordered_json;

const char* const observed =
    "x_mm,y_mm,z_mm\n0,0,0\n20,12,0\n40,15,0\n60,9,0\n80,-3,0\n100,-12,0\n120,-13,0\n150,0,0\n";

const char* const loss = "[[loss]]\nname = \"shape\"\non = \"iliac\"\nagainst = \"observed.csv\"\n";

std::string scene(const std::string& more) {
  return "schema = 1\nbase = \"" + testing::source_root() + "/studies/scenes/planar-iliac-coarse.toml\"\n" + more;
}

Json solved(const TemporaryFolder& folder, const std::string& text, const std::vector<std::string>& more = {}) {
  folder.write("scene.toml", text);
  std::vector<std::string> arguments{"solve", "scene.toml", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult result = bowstring_command(folder.path(), arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return Json::parse(result.out);
}

std::string refusal(const TemporaryFolder& folder, const std::string& text) {
  folder.write("scene.toml", text);
  const std::vector<std::string> before = entries(folder.path());
  const CommandResult result = bowstring_command(folder.path(), {"solve", "scene.toml", "--out", "r.json"});
  CHECK(result.exit_code == 2);
  CHECK(result.out == "");
  CHECK(entries(folder.path()) == before);
  return replaced(result.err, folder.path(), "DIR");
}

}  // namespace

TEST_CASE("losses: a value that changes nothing of the solution") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  Json with = solved(folder, scene(loss)), without = solved(folder, scene(""));
  REQUIRE(with["losses"].size() == 1);
  CHECK(without["losses"] == Json::array());
  const Json& shape = with["losses"][0];
  CHECK(shape["name"] == "shape");
  CHECK(shape["on"] == "iliac");
  CHECK(shape["against"] == folder.path() + "/observed.csv");
  CHECK(shape["value"].get<double>() > 1.0);
  CHECK(shape["unit"] == "mm^2");
  CHECK(shape["certificate"]["holds"] == true);
  CHECK(shape["warm"] == false);
  CHECK(shape["gradient"]["positions"].size() == 20);
  CHECK(shape["gradient"]["frames"].size() == 20);
  CHECK(shape["gradient"]["frames"][0].size() == 6);
  CHECK(shape["gradient"]["weights"].size() == 20);
  CHECK(shape["places"]["s_mm"] == with["curves"][0]["s_mm"]);
  for (const char* key : {"state", "energy", "quantities", "curves"}) CHECK(with[key] == without[key]);
}

TEST_CASE("losses: paths of --set, defaults in the resolved composition, the same bits again") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  const Json found = solved(folder, scene(loss), {"--set", "loss.shape.points=11", "--out", "r.json"});
  CHECK(found["losses"][0]["places"]["s_mm"].size() == 11);
  const Json& resolved = found["composition"]["loss"][0];
  CHECK(resolved["transport"]["type"] == "exact");
  CHECK(resolved["ground-cost"]["type"] == "euclidean");
  CHECK(resolved["weights"] == "arc-length");
  const CommandResult again = bowstring_command(folder.path(), {"rerun", "r.json"});
  CHECK(again.exit_code == 0);
  CHECK(contains(again.out, "the same bits: "));
  // Another observation is another number, and the file is named.
  folder.write("observed.csv", std::string(observed) + "160,5,0\n");
  const CommandResult changed = bowstring_command(folder.path(), {"rerun", "r.json"});
  CHECK(changed.exit_code == 1);
  CHECK(contains(changed.out, "losses.shape."));
  CHECK(contains(changed.out, "observed.csv"));
}

TEST_CASE("losses: every state of a chain has its own, and the document that of the last") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  const Json found = solved(folder, scene(std::string(loss) + "[[step]]\nname = \"soft\"\n[[step]]\nname = \"tense\"\n"
                                                              "\"energy.axial-tension.tension\" = \"15 N\"\n"));
  REQUIRE(found["states"].size() == 2);
  CHECK(found["states"][0]["losses"][0]["value"] != found["states"][1]["losses"][0]["value"]);
  CHECK(found["losses"][0]["value"] == found["states"][1]["losses"][0]["value"]);
}

TEST_CASE("losses: explain says them, and compare their values") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  solved(folder, scene(loss), {"--out", "a.json"});
  solved(folder, scene(loss), {"--out", "b.json", "--set", "loss.shape.weights=uniform"});
  const CommandResult explained = bowstring_command(folder.path(), {"explain", "scene.toml"});
  CHECK(contains(explained.out,
                 "losses, evaluated on the solution\n  shape                    exact with euclidean "
                 "between 'iliac' (its nodes, weights arc-length) and '"));
  CHECK(contains(explained.out, "  transport/exact  "));
  const CommandResult compared = bowstring_command(folder.path(), {"compare", "a.json", "b.json"});
  CHECK(compared.exit_code == 1);
  CHECK(contains(compared.out, "loss.shape.weights"));
  CHECK(contains(compared.out, "\nlosses "));
}

TEST_CASE("losses: what cannot be computed is refused before anything is solved") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  folder.write("heavy.csv", "x_mm,y_mm,z_mm,weight\n0,0,0,1\n50,0,0,3\n");
  const std::string start = "[[loss]]\non = \"iliac\"\n";
  CHECK(refusal(folder, scene(start + "against = \"heavy.csv\"\n")) ==
        "scene.toml:3:1: loss 'loss': the weights of the first measure sum to 1, those of the second to 4; expected "
        "equal "
        "sums; divide each weight by the sum of its measure, or choose the method 'unbalanced'\n");
  CHECK(refusal(folder, scene(start + "against = \"observed.csv\"\nground-cost = \"se3-riemannian\"\n")) ==
        "scene.toml:3:1: loss 'loss': the second measure: points without orientations, and the ground cost "
        "'se3-riemannian' compares frames; expected a quaternion w, x, y, z for each place; give them, or choose the "
        "ground cost 'euclidean'\n");
  CHECK(
      contains(refusal(folder, scene("[[loss]]\non = \"iliac\"\nweights = \"lumen-section\"\nagainst = "
                                     "\"observed.csv#curve\"\n")),
               "scene.toml:6:11: 'against' of loss 'loss': DIR/observed.csv#curve: weights 'lumen-section' of a curve "
               "whose radius is not known; "));
  // A station beyond the curve counts for nothing, which is said.
  folder.write("scene.toml",
               scene("[[loss]]\non = \"iliac\"\nagainst = \"observed.csv#curve\"\nstations = [{ at = \"900 mm\", "
                     "spread = \"1 cm\" }]\n"));
  const CommandResult beyond = bowstring_command(folder.path(), {"solve", "scene.toml"});
  CHECK(beyond.exit_code == 0);
  CHECK(
      contains(beyond.err, "warning: the station at 900 mm of loss 'loss' lies beyond the end of 'iliac', which is "));
  // Never over what is compared with.
  folder.write("scene.toml", scene(loss));
  const CommandResult over = bowstring_command(folder.path(), {"solve", "scene.toml", "--out", "observed.csv"});
  CHECK(over.exit_code == 2);
  CHECK(read_text(folder.path() + "/observed.csv") == observed);
}

}  // namespace bowstring
