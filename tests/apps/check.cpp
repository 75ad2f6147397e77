#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::edited;
using testing::entries;
using testing::shipped_scene;
using testing::source_root;
using testing::TemporaryFolder;
using Json = nlohmann::json;

namespace {

CommandResult checked(const std::string& scene, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments{"check", source_root() + "/scenes/" + scene};
  arguments.insert(arguments.end(), more.begin(), more.end());
  CommandResult result = bowstring_command(folder.path(), arguments);
  CHECK(entries(folder.path()).empty());
  return result;
}

void check_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) CHECK_MESSAGE(contains(text, part), "missing: " << part << "\nin\n" << text);
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  return text.substr(text.rfind('\n', end) + 1, end - text.rfind('\n', end));
}

/// The planar scene with one more energy of the fixture `dishonest`.
CommandResult checked_with(const std::string& energy, const std::vector<std::string>& more = {}) {
  const TemporaryFolder plugins, folder;
  plugins.take_fixture("dishonest");
  folder.write("scene.toml",
               shipped_scene("planar-iliac.toml") + "\n[[energy]]\ntype = \"" + energy + "\"\non = \"iliac\"\n");
  std::vector<std::string> arguments{"check", "scene.toml", "--plugin-path", plugins.path()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return bowstring_command(folder.path(), arguments);
}

}  // namespace

TEST_CASE("check: a shipped scene holds, exit 0, one line per claim and the verdict last") {
  const CommandResult result = checked("planar-iliac-smooth.toml");
  CHECK(result.exit_code == 0);
  CHECK_MESSAGE(result.err == "", result.err);
  check_parts(
      result.out,
      {"Planar iliac, well posed\n", "derivatives: largest relative error at 3 states, along 19 directions each\n",
       "  ok      energy 'wire-bending' on 'lunderquist'   gradient  ",
       "  ok      energy 'axial-tension' on 'lunderquist'  Hessian   0         vanishes\n",
       "  ok      edge closure of 'iliac'                  Jacobian  ",
       "  ok      the assembled Lagrangian                 Hessian   ",
       "invariances: relative change under a rigid motion of everything\n",
       "  ok      energy 'vessel-strain' on 'iliac'        rotation     ",
       "  ok      vessel 'iliac'                           supports               first end pinned, last end pinned\n",
       "scaling\n", "|gradient| from ", "  position of 'iliac'                            156 ",
       "modes: what nothing holds at the start\n", "  ok      'iliac'        rigid motions  the ends hold them all\n"});
  CHECK(last_line(result.out) == "all checks hold");
}

TEST_CASE("check: notes are no failure, and warnings of the scene go to stderr") {
  const CommandResult result = checked("planar-iliac.toml");
  CHECK(result.exit_code == 0);
  CHECK_MESSAGE(contains(result.err, "warning: vessel 'iliac': stretch-stiffness is 0"), result.err);
  check_parts(result.out, {"  note    constraint 'lumen'                       Hessian ", "not smooth, in "});
  CHECK(last_line(result.out) == "all checks hold, 2 notes");
}

TEST_CASE("check: --set changes what is checked") {
  const CommandResult result = checked("planar-iliac-smooth.toml", {"--set", "wire.lunderquist.kinematics=nodes"});
  CHECK(result.exit_code == 0);
  check_parts(result.out, {"  ok      uniform spacing of 'lunderquist' "});
}

TEST_CASE("check: exit 1 where a plugin's gradient is wrong, with its node") {
  const CommandResult result = checked_with("test-wrong-gradient");
  CHECK(result.exit_code == 1);
  check_parts(result.out, {"  FAILED  energy 'test-wrong-gradient' on 'iliac'  gradient  ",
                           "is not the derivative: at position 3 of 'iliac', ",
                           "not judged: the gradient that it would be compared with is wrong\n"});
  CHECK_MESSAGE(last_line(result.out).rfind("FAILED: ", 0) == 0, result.out);
  CHECK_MESSAGE(contains(last_line(result.out), " fell short"), result.out);
}

TEST_CASE("check: exit 1 where an energy is not as objective as it claims") {
  const CommandResult result = checked_with("test-false-objectivity");
  CHECK(result.exit_code == 1);
  check_parts(result.out, {"  FAILED  energy 'test-false-objectivity' on 'iliac'  translation  ",
                           "claims to be objective, and changes\n"});
  CHECK_MESSAGE(contains(last_line(result.out), "FAILED: 2 checks fell short"), result.out);
}

TEST_CASE("check: exit 1 where a plugin answers NaN, with the plugin's name and the place") {
  const TemporaryFolder plugins, folder;
  plugins.take_fixture("faulty");
  folder.write("scene.toml",
               shipped_scene("planar-iliac.toml") + "\n[[energy]]\ntype = \"test-not-a-number\"\non = \"iliac\"\n");
  const CommandResult result =
      bowstring_command(folder.path(), {"check", "scene.toml", "--plugin-path", plugins.path()});
  CHECK(result.exit_code == 1);
  check_parts(result.out, {"  FAILED  the start ",
                           "energy 'test-not-a-number' on 'iliac': its energy is not a finite number at node 2\n"});
}

TEST_CASE("check --json: the report and nothing else on stdout") {
  const CommandResult result = checked_with("test-wrong-hessian", {"--json"});
  CHECK(result.exit_code == 1);
  const Json report = Json::parse(result.out);
  CHECK(report["format"] == "bowstring.check/1");
  CHECK(report["verdict"] == "FAILED");
  CHECK(report["states"] == 3);
  CHECK(report["directions"].get<int>() >= 10);
  int found = 0;
  for (const Json& line : report["derivatives"]) {
    if (line["subject"] != "energy 'test-wrong-hessian' on 'iliac'" || line["what"] != "Hessian") continue;
    ++found;
    CHECK(line["verdict"] == "FAILED");
    CHECK(line["error"].get<double>() > 0.01);
    CHECK_MESSAGE(contains(line["where"], "position 4 of 'iliac'"), line["where"]);
  }
  CHECK(found == 1);
  CHECK(report["invariances"].size() > 5);
  CHECK(report["scaling"]["fields"].size() == 6);
  CHECK(report["scaling"]["rows"][2]["name"] == "constraint 'lumen'");
  CHECK(report["scaling"]["rows"][2]["vanishing"] == 78);
  CHECK(report["scaling"]["lines"][0]["error"].is_null());
  CHECK(report["modes"].size() == 3);
}

TEST_CASE("check: exit 2 for a wrong input, exit 3 for a plugin that cannot be used") {
  const TemporaryFolder folder, plugins;
  folder.write("scene.toml", edited(shipped_scene("cantilever.toml"), "dimension = 2", "dimension = 5"));
  const CommandResult wrong = bowstring_command(folder.path(), {"check", "scene.toml"});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.out == "");
  CHECK_MESSAGE(contains(wrong.err, "scene.toml:"), wrong.err);
  CHECK(bowstring_command(folder.path(), {"check"}).exit_code == 2);
  CHECK(bowstring_command(folder.path(), {"check", "scene.toml", "--set", "nothing"}).exit_code == 2);

  plugins.take_fixture("faulty");
  folder.write("thrower.toml",
               shipped_scene("planar-iliac.toml") + "\n[[energy]]\ntype = \"test-thrower\"\non = \"iliac\"\n");
  const CommandResult thrown =
      bowstring_command(folder.path(), {"check", "thrower.toml", "--plugin-path", plugins.path()});
  CHECK(thrown.exit_code == 3);
  CHECK(thrown.out == "");
  CHECK_MESSAGE(contains(thrown.err, "the licence is out of date"), thrown.err);
}

}  // namespace bowstring
