#include <doctest/doctest.h>

#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/lie/so3.hpp"
#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::entries;
using testing::read_text;
using testing::source_root;
using testing::TemporaryFolder;
using Json = nlohmann::json;

namespace {

std::string scene(const std::string& name) { return source_root() + "/scenes/" + name; }

/// Whether an object has each of the keys; names the missing one.
void check_keys(const Json& object, const std::string& where, const std::vector<std::string>& keys) {
  REQUIRE_MESSAGE(object.is_object(), where << " is no object");
  for (const std::string& key : keys) CHECK_MESSAGE(object.contains(key), where << " has no '" << key << "'");
}

/// The same for the first of a list.
void check_first(const Json& list, const std::string& where, const std::vector<std::string>& keys) {
  REQUIRE_MESSAGE(list.is_array(), where << " is no list");
  REQUIRE_MESSAGE(!list.empty(), where << " is empty");
  check_keys(list.front(), where + "[0]", keys);
}

/// Every key of the result document that docs/results.md promises.
void check_document(const Json& document) {
  check_keys(document, "the document",
             {"format", "status", "reason", "warnings", "composition", "provenance", "problem", "solver", "certificate",
              "energy", "quantities", "curves", "contacts", "supports", "state", "equilibria"});
  CHECK(document["format"] == "bowstring.result/1");
  check_keys(document["provenance"], "provenance", {"version", "interface_version", "kernel", "plugins"});
  check_first(document["provenance"]["plugins"], "provenance.plugins", {"kind", "name", "file", "sha256", "abi_tag"});
  check_keys(document["problem"], "problem", {"unknowns", "fixed", "inequalities", "equalities", "fields"});
  check_first(document["problem"]["fields"], "problem.fields", {"name", "manifold", "count", "unknowns", "reason"});
  check_keys(document["solver"], "solver",
             {"name", "claim", "iterations", "factorizations", "evaluations", "epochs", "history", "seconds"});
  check_first(document["solver"]["history"], "solver.history",
              {"iteration", "energy", "stationarity", "penetration", "step"});
  check_keys(document["solver"]["seconds"], "solver.seconds",
             {"load", "setup", "solve", "total", "evaluation", "factorization"});
  check_keys(document["certificate"], "certificate",
             {"stationarity", "rounding_floor_N", "max_penetration_mm", "max_penetration_dense_mm", "min_stretch",
              "max_stretch", "complementarity", "min_multiplier", "second_order", "second_order_reason",
              "negative_directions", "leftmost_curvature_N_per_mm2", "leftmost_mode", "neutral_modes", "deciding_rows",
              "weakly_active", "folds", "crossings", "verdict"});
  const bool judged = document["status"] == "converged";
  CHECK(document["certificate"]["second_order"] == (judged ? Json("minimum") : Json(nullptr)));
  CHECK(document["certificate"]["negative_directions"] == (judged ? Json(0) : Json(nullptr)));
  check_keys(document["quantities"], "quantities",
             {"peak_displacement_mm", "mean_displacement_mm", "mean_displacement_nodes_mm", "wire_length_mm",
              "vessel_length_change_mm", "arc_to_chord", "contact_count", "contact_force_N", "line_load_peak_N_per_mm",
              "line_load_integral_N"});
  check_first(document["curves"], "curves",
              {"name", "kind", "s_mm", "points", "reference_points", "frames", "radius_mm", "curvature_per_mm",
               "twist_per_mm", "moment_N_mm", "internal_force_N"});
  check_first(document["contacts"], "contacts",
              {"wire", "vessel", "row", "wire_edge", "t", "s_mm", "vessel_s_mm", "gap_mm", "force_N", "direction"});
  check_first(document["supports"], "supports", {"on", "end", "force_N", "moment_N_mm"});
  check_keys(document["state"], "state", {"fields", "multipliers"});
  CHECK(document["equilibria"].is_array());
}

/// Lists of one entry per node of every curve have that length.
void check_lengths(const Json& document) {
  for (const Json& curve : document["curves"]) {
    const std::size_t nodes = curve["points"].size();
    REQUIRE(nodes >= 3);
    for (const char* key : {"s_mm", "reference_points", "frames", "radius_mm", "curvature_per_mm", "moment_N_mm"}) {
      CHECK_MESSAGE(curve[key].size() == nodes, key);
    }
    if (!curve["internal_force_N"].is_null()) CHECK(curve["internal_force_N"].size() == nodes - 1);
  }
}

double total(const CommandResult& result) { return Json::parse(result.out)["energy"]["total"].get<double>(); }

}  // namespace

TEST_CASE("--json prints one document alone, the very bytes of --out") {
  const TemporaryFolder folder;
  const CommandResult result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--json", "--out", "result.json"});
  CHECK(result.exit_code == 0);
  CHECK_MESSAGE(result.err == "", result.err);
  const Json document = Json::parse(result.out);
  CHECK(document["status"] == "converged");
  CHECK(read_text(folder.path() + "/result.json") == result.out);
  CHECK(entries(folder.path()) == std::vector<std::string>{"result.json"});
  check_document(document);
  check_lengths(document);
}

TEST_CASE("the document of a scene in space has every key") {
  const TemporaryFolder folder;
  const CommandResult result = bowstring_command(
      folder.path(), {"solve", scene("helical-iliac-full.toml"), "--json", "--set", "vessel.iliac.geometry.nodes=30"});
  REQUIRE(result.exit_code == 0);
  const Json document = Json::parse(result.out);
  check_document(document);
  check_lengths(document);
  CHECK(document["curves"][0]["twist_per_mm"].size() == 30);
  for (const Json& point : document["curves"][1]["points"]) CHECK(point.size() == 3);
}

TEST_CASE("the energies of a document add up, named by the composition") {
  const TemporaryFolder folder;
  const CommandResult result = bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--json"});
  REQUIRE(result.exit_code == 0);
  const Json energy = Json::parse(result.out)["energy"];
  double sum = 0.0;
  for (const char* term : {"wire-bending", "vessel-strain", "anchoring", "axial-tension"}) {
    REQUIRE(energy.contains(term));
    REQUIRE(energy[term].get<double>() > 0.0);
    sum += energy[term].get<double>();
  }
  CHECK(energy.size() == 5);
  CHECK(energy["total"].get<double>() == doctest::Approx(sum).epsilon(1e-14));
}

TEST_CASE("the table goes to stdout, and stderr is quiet where it is no terminal") {
  const TemporaryFolder folder;
  const CommandResult result = bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml")});
  CHECK(result.exit_code == 0);
  CHECK_MESSAGE(result.err == "", result.err);
  for (const char* part :
       {"Planar iliac, well posed\n", "converged: all thresholds of the certificate hold\n", "peak displacement",
        "total", "N mm", "stationarity", "second order                    minimum every curvature is positive with "}) {
    CHECK_MESSAGE(contains(result.out, part), part);
  }
}

TEST_CASE("warnings go to stderr and into the document") {
  const TemporaryFolder folder;
  const CommandResult result = bowstring_command(folder.path(), {"solve", scene("planar-iliac.toml"), "--json"});
  CHECK(result.exit_code == 0);
  CHECK(result.err.rfind("warning: vessel 'iliac': stretch-stiffness is 0", 0) == 0);
  const Json warnings = Json::parse(result.out)["warnings"];
  REQUIRE(warnings.size() == 1);
  CHECK(result.err == "warning: " + warnings[0].get<std::string>() + "\n");
}

TEST_CASE("exit 1 where it did not converge, and the document is written all the same") {
  const TemporaryFolder folder;
  const CommandResult result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--set", "solver.max-iterations=2",
                                        "--out", "result.json", "--write", "csv=result.csv"});
  CHECK(result.exit_code == 1);
  CHECK(contains(result.out, "stalled: "));
  CHECK(entries(folder.path()) == std::vector<std::string>{"result.csv", "result.json"});
  const Json document = Json::parse(read_text(folder.path() + "/result.json"));
  CHECK(document["status"] == "stalled");
  CHECK(document["certificate"]["verdict"] == "stalled");
  CHECK(document["solver"]["iterations"] == 2);
  const std::string reason = document["reason"];
  CHECK_MESSAGE(contains(reason, "iteration limit"), reason);
  CHECK_MESSAGE(contains(reason, "threshold"), reason);
  check_document(document);
}

TEST_CASE("--out replaces a file whole") {
  const TemporaryFolder folder;
  folder.write("result.json", std::string(1 << 20, 'x'));
  const CommandResult result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--out", "result.json"});
  CHECK(result.exit_code == 0);
  CHECK(Json::parse(read_text(folder.path() + "/result.json"))["status"] == "converged");
  CHECK(entries(folder.path()) == std::vector<std::string>{"result.json"});
}

TEST_CASE("files that cannot be written are the caller's mistake") {
  const TemporaryFolder folder;
  CommandResult result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--out", "no/result.json"});
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "error: --out: cannot write 'no/result.json': No such file or directory\n"));
  result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--write", "csv=no/result.csv"});
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err,
                 "error: --write csv=no/result.csv: cannot write 'no/result.csv': No such file or directory\n"));
  CHECK(entries(folder.path()).empty());
}

TEST_CASE("no output may destroy the composition, or another output") {
  const TemporaryFolder folder;
  const std::string base = testing::shipped_scene("planar-iliac.toml");
  const std::string variant = testing::shipped_scene("planar-iliac-smooth.toml");
  folder.write("planar-iliac.toml", base);
  folder.write("scene.toml", variant);
  folder.write("points.csv", "x_mm,y_mm\n0,0\n10,0\n20,1\n30,3\n40,6\n");
  const std::string csv = "vessel.iliac.geometry={ type = 'csv', file = 'points.csv' }";
  CommandResult result = bowstring_command(folder.path(), {"solve", "scene.toml", "--out", "./scene.toml"});
  CHECK(result.exit_code == 2);
  CHECK(result.err == "error: --out: './scene.toml' is what this composition reads; expected another file\n");
  for (const char* file : {"planar-iliac.toml", "points.csv"}) {
    result =
        bowstring_command(folder.path(), {"solve", "scene.toml", "--set", csv, "--write", "csv=" + std::string(file)});
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, "' is what this composition reads; expected another file\n"));
  }
  result = bowstring_command(folder.path(), {"solve", "scene.toml", "--out", "result", "--write", "csv=result"});
  CHECK(result.exit_code == 2);
  CHECK(result.err == "error: --write csv=result: 'result' is written by --out too; expected one file each\n");
  CHECK(read_text(folder.path() + "/scene.toml") == variant);
  CHECK(read_text(folder.path() + "/planar-iliac.toml") == base);
  CHECK(entries(folder.path()) == std::vector<std::string>{"planar-iliac.toml", "points.csv", "scene.toml"});
}

TEST_CASE("devices and pipes are never replaced, and links stay links") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder.path() + "/pipe").c_str(), 0600) == 0);
  CommandResult result =
      bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--out", "pipe"});
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "error: --out: cannot write 'pipe': it is no regular file\n"));
  folder.write("target.json", "old");
  std::filesystem::create_symlink("target.json", folder.path() + "/link.json");
  result = bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--out", "link.json"});
  CHECK(result.exit_code == 0);
  CHECK(std::filesystem::is_symlink(folder.path() + "/link.json"));
  CHECK(Json::parse(read_text(folder.path() + "/target.json"))["status"] == "converged");
  CHECK(entries(folder.path()) == std::vector<std::string>{"link.json", "pipe", "target.json"});
  result = bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--out", ""});
  CHECK(result.exit_code == 2);
  CHECK(result.err == "error: --out: found no file; expected for instance --out result.json\n");
}

TEST_CASE("moments in space are those of the curvature, in the axes of the frames") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    const TemporaryFolder folder;
    const CommandResult result =
        bowstring_command(folder.path(), {"solve", scene("tortuous-iliac.toml"), "--json", "--set",
                                          std::string("wire.lunderquist.kinematics=") + kinematics});
    REQUIRE(result.exit_code == 0);
    const Json wire = Json::parse(result.out)["curves"][1];
    REQUIRE(wire["kind"] == "wire");
    int checked = 0;
    for (std::size_t i = 1; i + 1 < wire["points"].size(); ++i) {
      const auto point = [&](std::size_t node) { return wire["points"][node].get<std::vector<double>>(); };
      const auto a = point(i - 1), b = point(i), c = point(i + 1);
      Vector3 before, after;
      for (int k = 0; k < 3; ++k) {
        before[k] = b[std::size_t(k)] - a[std::size_t(k)];
        after[k] = c[std::size_t(k)] - b[std::size_t(k)];
      }
      const auto frame = wire["frames"][i].get<std::vector<double>>();
      const auto moment = wire["moment_N_mm"][i].get<std::vector<double>>();
      const Vector3 global = lie::Rotation::load(frame.data()) * Vector3::load(moment.data());
      if (norm(global) < 50.0) continue;
      const Vector3 normal = cross(before, after);
      CHECK(dot(global, normal) >= 0.9999 * norm(global) * norm(normal));
      CHECK(norm(global) == doctest::Approx(4857.0 * wire["curvature_per_mm"][i].get<double>()).epsilon(1e-9));
      ++checked;
    }
    CHECK(checked > 40);
  }
}

TEST_CASE("two runs give the same bits") {
  const TemporaryFolder folder;
  Json documents[2];
  for (Json& document : documents) {
    const CommandResult result =
        bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--json"});
    REQUIRE(result.exit_code == 0);
    document = Json::parse(result.out);
    document["solver"].erase("seconds");
  }
  CHECK(documents[0] == documents[1]);
}

TEST_CASE("a kinematics is swapped by one line and gives the same equilibrium") {
  const TemporaryFolder folder;
  double energy[2];
  int k = 0;
  for (const char* name : {"edge-frames", "nodes"}) {
    const std::string value = std::string("=\"") + name + "\"";
    const CommandResult result = bowstring_command(
        folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--json", "--set",
                        "wire.lunderquist.kinematics" + value, "--set", "vessel.iliac.kinematics" + value});
    REQUIRE_MESSAGE(result.exit_code == 0, name);
    CHECK(contains(result.out, std::string("bowstring_") + name + ".so"));
    energy[k++] = total(result);
  }
  CHECK(energy[0] > 0.0);
  CHECK(energy[1] == doctest::Approx(energy[0]).epsilon(1e-8));
}

TEST_CASE("the wall's centerline is swapped by one line") {
  const TemporaryFolder folder;
  double energy[2];
  int k = 0;
  for (const char* name : {"spline", "polyline"}) {
    const CommandResult result =
        bowstring_command(folder.path(), {"solve", scene("planar-iliac-smooth.toml"), "--json", "--set",
                                          std::string("constraint.lumen.centerline=\"") + name + "\""});
    REQUIRE_MESSAGE(result.exit_code == 0, name);
    energy[k++] = total(result);
  }
  CHECK(energy[0] != energy[1]);
  CHECK(energy[1] == doctest::Approx(energy[0]).epsilon(0.02));
}

}  // namespace bowstring
