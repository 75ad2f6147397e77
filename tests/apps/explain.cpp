#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::entries;
using testing::source_root;
using testing::TemporaryFolder;
using Json = nlohmann::json;

namespace {

std::string scene(const std::string& name) { return source_root() + "/scenes/" + name; }

std::string successful(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const CommandResult result = bowstring_command(folder.path(), arguments);
  CHECK(result.exit_code == 0);
  CHECK_MESSAGE(result.err == "", result.err);
  CHECK(entries(folder.path()).empty());
  return result.out;
}

void check_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) CHECK_MESSAGE(contains(text, part), "missing: " << part << "\nin\n" << text);
}

}  // namespace

TEST_CASE("explain names curves, fields with their reasons, rows, and the plugins that are opened") {
  const std::string text = successful({"explain", scene("helical-iliac-full.toml")});
  check_parts(
      text,
      {
          "Helical iliac with a full vessel\n",
          "scene of dimension 3\n",
          "vessel 'iliac': 60 nodes, 177.128 mm, ends pinned and pinned; every edge has its own length\n",
          "kinematics edge-frames, with material frames because vessel-strain of 'iliac' has torsional-stiffness > 0\n",
          "60 × vector            174 unknown, 6 fixed: every kinematics has node positions\n",
          "59 × rotation (SO3)    177 unknown, 0 fixed: vessel-strain of 'iliac' has torsional-stiffness > 0\n",
          "59 × number             59 unknown, 0 fixed: the curve stretches\n",
          "wire 'lunderquist': 60 nodes, 177.128 mm, ends clamped and pinned; length slides through the sheath: one "
          "unknown L\n",
          "59 × direction (S2)    118 unknown, 0 fixed: edge-frames has one orientation per edge\n",
          "held-tangent       1 × direction (S2)      0 unknown, 2 fixed: a clamped end holds the tangent at its "
          "node\n",
          "rows: 354 equalities, 58 inequalities\n",
          "edge closure of 'iliac' (177)\n",
          "constraint 'lumen' (58)\n",
          "unknowns: 703, eliminated because they are held: 14\n",
          "solved by interior-point with rows by kkt\n",
          "plugins opened, and no others\n",
      });
  for (const char* plugin : {"constraint/node-wise-contact", "energy/anchoring", "energy/axial-tension",
                             "energy/vessel-strain", "energy/wire-bending", "enforcement/kkt", "geometry/helix",
                             "kinematics/edge-frames", "solver/interior-point"}) {
    CHECK_MESSAGE(contains(text, std::string("  ") + plugin + "  /"), plugin);
  }
  CHECK_FALSE(contains(text, "kinematics/nodes"));
}

TEST_CASE("a planar scene has no third coordinate and no twist") {
  const std::string text = successful({"explain", scene("planar-iliac-smooth.toml")});
  check_parts(text, {"80 × vector            156 unknown, 4 fixed", "79 × angle (S1)         79 unknown"});
  CHECK_FALSE(contains(text, "SO3"));
  CHECK_FALSE(contains(text, "S2"));
  CHECK_FALSE(contains(text, "warning"));
}

TEST_CASE("node positions alone have no orientations") {
  const std::string text =
      successful({"explain", scene("planar-iliac-smooth.toml"), "--set", "wire.lunderquist.kinematics=\"nodes\"",
                  "--set", "vessel.iliac.kinematics=\"nodes\""});
  check_parts(text, {"kinematics/nodes  /"});
  CHECK_FALSE(contains(text, "orientation"));
  CHECK_FALSE(contains(text, "edge-frames"));
}

TEST_CASE("explain says what a composition asks for beyond one solve") {
  check_parts(successful({"explain", scene("shallow-arch.toml")}),
              {"walks 'energy.point-load.force' from [\"0 N\", \"0 N\"] to [\"0 N\", \"6 N\"]\n"});
  check_parts(successful({"explain", scene("rod-in-channel.toml")}), {"solved from 9 starts, perturbed with seed 1\n"});
  check_parts(successful({"explain", scene("wire-exchange.toml")}),
              {"this is the first of a chain of states: 'stiff wire'\nthen 'soft wire'\n"});
}

TEST_CASE("explain says what has no effect and what to beware of") {
  const std::string text = successful(
      {"explain", scene("planar-iliac.toml"), "--set", "energy.vessel-strain.torsional-stiffness=\"133 N mm^2\""});
  check_parts(text, {"warning: vessel 'iliac': stretch-stiffness is 0", "without effect: ", "torsional-stiffness"});
}

TEST_CASE("plugins lists every kind, one kind, and JSON") {
  const std::string all = successful({"plugins"});
  check_parts(all, {"geometry     sinusoid", "kinematics   edge-frames", "energy       wire-bending",
                    "constraint   node-wise-contact", "enforcement  kkt", "writer       csv"});
  const std::string energies = successful({"plugins", "energy"});
  CHECK(contains(energies, "wire-bending"));
  CHECK_FALSE(contains(energies, "sinusoid"));

  const Json json = Json::parse(successful({"plugins", "energy", "--json"}));
  REQUIRE(json.is_array());
  CHECK(json.size() == static_cast<std::size_t>(std::count(energies.begin(), energies.end(), '\n')));
  for (const Json& plugin : json) {
    CHECK(plugin["kind"] == "energy");
    CHECK(plugin["name"].is_string());
    CHECK(plugin["description"].is_string());
    CHECK(plugin["file"].get<std::string>().front() == '/');
  }
}

TEST_CASE("describe gives a plugin's parameters with unit, bounds and default") {
  CHECK(successful({"describe", "energy/wire-bending"}) ==
        "energy/wire-bending: Bending of a wire that is straight at rest: ½ ∫ EI κ² ds\n"
        "  bending-stiffness      profile, N mm^2, >= 0, required, differentiable\n"
        "      EI of the wire\n");
  const Json json = Json::parse(successful({"describe", "energy/vessel-strain", "--json"}));
  CHECK(json["kind"] == "energy");
  CHECK(json["name"] == "vessel-strain");
  REQUIRE(json["parameters"].size() == 3);
  const Json& torsion = json["parameters"][1];
  CHECK(torsion["key"] == "torsional-stiffness");
  CHECK(torsion["type"] == "profile");
  CHECK(torsion["unit"] == "N mm^2");
  CHECK(torsion["required"] == false);
  CHECK(torsion["default"] == "0.0");
  CHECK(torsion["lower"] == 0.0);
  CHECK(torsion["upper"].is_null());
  CHECK(torsion["differentiable"] == true);
}

TEST_CASE("every installed plugin can be described") {
  const Json plugins = Json::parse(successful({"plugins", "--json"}));
  REQUIRE(plugins.size() >= 15);
  for (const Json& plugin : plugins) {
    const std::string what = plugin["kind"].get<std::string>() + "/" + plugin["name"].get<std::string>();
    const Json json = Json::parse(successful({"describe", what, "--json"}));
    for (const Json& parameter : json["parameters"]) {
      CHECK_MESSAGE(!parameter["description"].get<std::string>().empty(), what << " " << parameter["key"]);
    }
  }
}

TEST_CASE("--version and --help") {
  CHECK(successful({"--version"}).rfind("bowstring ", 0) == 0);
  check_parts(successful({"--help"}), {"solve", "explain", "check", "plugins", "describe"});
}

}  // namespace bowstring
