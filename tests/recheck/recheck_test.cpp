// Solves shipped scenes with the command and rechecks what it wrote; then documents that were tampered with.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "tests/apps/command.hpp"
#include "tests/recheck/recheck.hpp"

namespace recheck {
namespace {

using bowstring::testing::bowstring_command;
using bowstring::testing::contains;
using bowstring::testing::read_text;
using bowstring::testing::source_root;

/// A folder of its own that is removed with its contents.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "recheck-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Solves a shipped scene with overrides, "path=value" each, and answers its document.
Json solved(const std::string& scene, const std::vector<std::string>& overrides, int exit_code = 0) {
  const Folder folder;
  std::vector<std::string> words = {"solve", source_root() + "/scenes/" + scene + ".toml", "--out",
                                    folder.file("result.json")};
  for (const std::string& one : overrides) words.insert(words.end(), {"--set", one});
  const auto result = bowstring_command(folder.file(""), words);
  REQUIRE_MESSAGE(result.exit_code == exit_code, result.err << result.out);
  return Json::parse(read_text(folder.file("result.json")));
}

void write(const Json& document, const std::string& file) { std::ofstream(file) << document.dump(); }

Findings found_in(const Json& document) {
  const Folder folder;
  write(document, folder.file("result.json"));
  return recheck(read_results(folder.file("result.json")).front().second);
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += part + "; ";
  return out;
}

/// Whether the document's claim stands, and is about something: a norm of its state and an energy that are not 0.
void check_holds(const Json& document) {
  const Findings found = found_in(document);
  REQUIRE(found.claims());
  REQUIRE(std::abs(found.total_energy) > 0.0);
  CHECK_MESSAGE(found.reasons.empty(), joined(found.reasons));
  CHECK_MESSAGE(found.not_rechecked.empty(), joined(found.not_rechecked));
  CHECK(found.energy_difference.value <= 1e-9 * std::max(1.0, std::abs(found.total_energy)));
}

/// Whether a tampered document is refused for this reason.
void check_refused(const Json& document, const std::string& reason) {
  const Findings found = found_in(document);
  REQUIRE(found.claims());
  CHECK_MESSAGE(contains(joined(found.reasons), reason), "reasons: " << joined(found.reasons));
}

std::vector<std::string> by_nodes(std::vector<std::string> overrides) {
  overrides.emplace_back("vessel.iliac.kinematics=nodes");
  overrides.emplace_back("wire.lunderquist.kinematics=nodes");
  return overrides;
}

const char* const data_folder = std::getenv("BOWSTRING_DATA");

std::vector<std::string> real_artery(int nodes) {
  const std::string file = std::string(data_folder) + "/vmr_0110/left_smoothed_200.csv";
  return {"vessel.iliac.geometry={ type = \"csv\", file = \"" + file + "\", nodes = " + std::to_string(nodes) + " }",
          "vessel.iliac.radius={ column = \"radius_mm\" }",
          "wire.lunderquist.ends=[{ type = \"clamped\", tangent = [-0.492142416654365, 0.386515454003037, "
          "0.78000105483674] }, \"pinned\"]"};
}

/// The number of the contact row with the largest force.
std::size_t strongest(const Json& document) {
  const Json& mu = document["state"]["multipliers"]["lumen"];
  std::size_t best = 0;
  for (std::size_t r = 0; r < mu.size(); ++r) {
    if (mu[r].get<double>() > mu[best].get<double>()) best = r;
  }
  REQUIRE(mu[best].get<double>() > 0.1);
  return best;
}

Json& add_to(Json& number, double change) { return number = number.get<double>() + change; }

void set_contact_force(Json& document, std::size_t row, double force) {
  document["state"]["multipliers"]["lumen"][row] = force;
  document["contacts"][row]["force_N"] = force;
}

}  // namespace

TEST_CASE("planar scenes hold") {
  const std::string size = "vessel.iliac.geometry.nodes=40";
  const std::string segments = "constraint.lumen.type=segment-wise-contact";
  check_holds(solved("planar-iliac-smooth", {}));
  check_holds(solved("planar-iliac-smooth", {size}));
  check_holds(solved("planar-iliac-smooth", by_nodes({size})));
  check_holds(solved("planar-iliac-smooth", {size, segments}));
  check_holds(solved("planar-iliac-smooth", by_nodes({size, segments})));
  check_holds(solved("planar-iliac-smooth", {size, "constraint.lumen.rows-per-segment=3"}));
  check_holds(solved("planar-iliac", {size}));
}

TEST_CASE("scenes in space hold") {
  const std::string size = "vessel.iliac.geometry.nodes=40";
  const std::string segments = "constraint.lumen.type=segment-wise-contact";
  check_holds(solved("helical-iliac-full", {}));
  check_holds(solved("helical-iliac-full", by_nodes({size})));
  check_holds(solved("helical-iliac-full", {size, segments}));
  check_holds(solved("helical-iliac-full", by_nodes({size, segments})));
  check_holds(solved("helical-iliac", {}));
  check_holds(solved("helical-iliac", {"wire.lunderquist.kinematics=edge-frames"}));
  check_holds(solved("parked-wire", {}));
}

TEST_CASE("ends that are moved and turned hold") {
  const std::string turned =
      "vessel.iliac.ends=[\"clamped\", { type = \"clamped\", turn = [0.1, -0.2, 0.3], move = [1, 2, 3], axes = \"end\" "
      "}]";
  const std::string twisted = "vessel.iliac.ends=[\"clamped\", { type = \"clamped\", turn = \"20 deg\" }]";
  check_holds(solved("helical-iliac-full", {turned}));
  check_holds(solved("helical-iliac-full", by_nodes({twisted})));
}

TEST_CASE("documents of a later rest state hold, and one that is moved does not") {
  const Folder folder;
  const std::string clamps =
      "vessel.iliac.ends=[{ type = \"clamped\", turn = 0.1 }, { type = \"clamped\", move = [1, 2], turn = \"10 deg\" "
      "}]";
  const std::string in_space =
      "vessel.iliac.ends=[\"clamped\", { type = \"clamped\", turn = [0.1, -0.2, 0.3], move = [1, 2, 3], axes = \"end\" "
      "}]";
  const std::string load = "energy.anchoring.stiffness={ table = [[0, \"0.01 N/mm^2\"], [150, \"0.03 N/mm^2\"]] }";
  for (const bool nodes : {false, true}) {
    for (const bool space : {false, true}) {
      const std::string scene = space ? "helical-iliac-full" : "planar-iliac-smooth";
      std::vector<std::string> overrides = {"vessel.iliac.geometry.nodes=40", space ? in_space : clamps};
      if (nodes) overrides = by_nodes(overrides);
      write(solved(scene, overrides), folder.file("first.json"));
      overrides.push_back("start.from=" + folder.file("first.json"));
      overrides.emplace_back("start.rest=previous");
      if (!space) overrides.push_back(load);
      const Json same = solved(scene, overrides);
      check_holds(same);
      overrides.front() = "vessel.iliac.geometry.nodes=50";
      overrides.emplace_back("vessel.iliac.ends.last=\"clamped\"");
      check_holds(solved(scene, overrides));
      Json moved = same;
      add_to(moved["curves"][0]["reference_points"][17][1], 1e-4);
      check_refused(moved, "energy 'vessel-strain'");
      Json held = same;
      add_to(held["curves"][0]["state_1_points"][0][1], 1e-4);
      check_refused(held, "what the ends hold is off by");
    }
  }
}

TEST_CASE("rods and beams hold") {
  for (const char* kinematics : {"wire.rod.kinematics=edge-frames", "wire.rod.kinematics=nodes"}) {
    check_holds(solved("cantilever", {kinematics}));
    check_holds(solved("buckled-rod", {kinematics}));
  }
  check_holds(solved("beam-on-foundation", {}));
  check_holds(solved("beam-on-foundation", {"vessel.beam.ends=[\"clamped\", \"clamped\"]"}));
  check_holds(solved("rod-in-arc-tube", {}));
}

TEST_CASE("the real artery holds, and a tunnelled wire does not" * doctest::skip(data_folder == nullptr)) {
  check_holds(solved("tortuous-iliac", real_artery(200)));
  check_holds(solved("tortuous-iliac", by_nodes(real_artery(100))));

  std::vector<std::string> unguarded = real_artery(100);
  for (const char* one : {"energy.wire-bending.bending-stiffness='521 N mm^2'", "energy.axial-tension.tension='5 N'",
                          "solver.step-guard=0", "constraint.lumen.window=8"}) {
    unguarded.emplace_back(one);
  }
  Json tunnelled = solved("tortuous-iliac", unguarded, 1);
  REQUIRE(tunnelled["status"] == "invalid");
  tunnelled["status"] = "converged";
  const Findings found = found_in(tunnelled);
  REQUIRE(found.reasons.size() == 1);  // every row holds
  CHECK(contains(found.reasons.front(), "the wall is crossed by"));
}

TEST_CASE("a changed multiplier is caught") {
  const Json honest = solved("planar-iliac-smooth", {});
  check_holds(honest);
  const std::size_t row = strongest(honest);
  const double force = honest["state"]["multipliers"]["lumen"][row].get<double>();

  Json larger = honest;
  set_contact_force(larger, row, force + 1e-3);
  check_refused(larger, "stationarity 0.00");
  Json opposite = honest;
  set_contact_force(opposite, row, -force);
  check_refused(opposite, "multiplier below zero by");
  check_refused(opposite, "stationarity");
  Json only_in_state = honest;
  only_in_state["state"]["multipliers"]["lumen"][row] = force + 1e-7;
  check_refused(only_in_state, "contacts and state differ by");
  Json closure = honest;
  add_to(closure["state"]["multipliers"]["iliac.closure"][7], 1e-3);
  check_refused(closure, "stationarity");
  Json idle = honest;  // a row far from its wall that would press
  set_contact_force(idle, 0, 1e-3);
  check_refused(idle, "complementarity");
}

TEST_CASE("a moved node is caught") {
  const Json honest = solved("helical-iliac-full", {"vessel.iliac.geometry.nodes=40"});
  check_holds(honest);
  Json in_state = honest;
  add_to(in_state["state"]["fields"]["lunderquist.position"][3 * 17 + 1], 1e-4);
  check_refused(in_state, "points and state differ by");
  check_refused(in_state, "row violated by");
  Json everywhere = in_state;
  everywhere["curves"][1]["points"][17][1] = everywhere["state"]["fields"]["lunderquist.position"][3 * 17 + 1];
  check_refused(everywhere, "row violated by");
  Json held = honest;
  add_to(held["state"]["fields"]["iliac.position"][0], 1e-4);
  check_refused(held, "what the ends hold is off by");
  Json clamp = honest;
  add_to(clamp["state"]["fields"]["lunderquist.held-tangent"][2], 1e-4);
  check_refused(clamp, "what the ends hold is off by");
  Json turned = honest;  // one component of a unit quaternion: the frame is another
  add_to(turned["state"]["fields"]["iliac.orientation"][4 * 11 + 1], 1e-4);
  check_refused(turned, "stationarity");
}

TEST_CASE("a changed status, energy or parameter is caught") {
  Json stalled = solved("helical-iliac-full", {"vessel.iliac.geometry.nodes=40", "solver.max-iterations=7"}, 1);
  REQUIRE(stalled["status"] == "stalled");
  const double reported = stalled["certificate"]["stationarity"].get<double>();
  REQUIRE(reported > 1e-6);
  stalled["status"] = "converged";
  check_refused(stalled, "stationarity");
  // The same figure by formulas of its own.
  CHECK(found_in(stalled).stationarity.value == doctest::Approx(reported).epsilon(0.01));

  const Json honest = solved("planar-iliac-smooth", {});
  check_holds(honest);
  Json energy = honest;
  add_to(energy["energy"]["vessel-strain"], -1e-6);
  check_refused(energy, "energy 'vessel-strain'");
  Json stiffness = honest;
  stiffness["composition"]["energy"][0]["bending-stiffness"] = 66.0;
  check_refused(stiffness, "energy 'wire-bending'");
  Json tension = honest;
  tension["composition"]["energy"][3]["tension"] = -10.0;
  check_refused(tension, "stationarity");
}

TEST_CASE("the command says what it found, and its exit code") {
  const Folder folder;
  const Json honest = solved("planar-iliac-smooth", {});
  write(honest, folder.file("good.json"));
  Json tampered = honest;
  set_contact_force(tampered, strongest(honest), 0.0);
  write(tampered, folder.file("bad.json"));
  Json foreign = honest;
  foreign["composition"]["energy"][2]["type"] = "superquadratic-anchoring";
  write(foreign, folder.file("foreign.json"));
  write(Json::object(), folder.file("other.json"));

  const std::string program = std::string(std::getenv("BOWSTRING_BUILD_ROOT")) + "/tests/recheck/recheck";
  const auto run = [&](const std::string& arguments) {
    const std::string out = folder.file("out.txt");
    const int status =
        std::system(("cd '" + folder.file("") + "' && '" + program + "' " + arguments + " > '" + out + "'").c_str());
    return std::pair(status, read_text(out));
  };
  const auto [good, good_text] = run("good.json");
  CHECK(good == 0);
  CHECK_MESSAGE(contains(good_text, "| holds\n1 hold, 0 do not hold, 0 without a claim\n"), good_text);
  const auto [bad, bad_text] = run("good.json bad.json other.json");
  CHECK(bad != 0);
  CHECK_MESSAGE(contains(bad_text, "DOES NOT HOLD: stationarity"), bad_text);
  CHECK_MESSAGE(contains(bad_text, "other.json: DOES NOT HOLD: is no bowstring.result/1 document"), bad_text);
  CHECK_MESSAGE(contains(bad_text, "1 hold, 2 do not hold"), bad_text);
  const auto [unknown, unknown_text] = run("foreign.json");
  CHECK(unknown != 0);
  CHECK_MESSAGE(contains(unknown_text, "not rechecked: energy 'superquadratic-anchoring'"), unknown_text);
  CHECK(run("--allow-unknown foreign.json").first == 0);
  add_to(foreign["energy"]["wire-bending"], 1e-6);  // what is known is judged all the same
  write(foreign, folder.file("foreign.json"));
  CHECK(run("--allow-unknown foreign.json").first != 0);
}

}  // namespace recheck
