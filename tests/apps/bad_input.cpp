#include <doctest/doctest.h>

#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::edited;
using testing::entries;
using testing::position;
using testing::replaced;
using testing::shipped_scene;
using testing::TemporaryFolder;

namespace {

const char* const geometry_line =
    R"(geometry   = { type = "sinusoid", chord = "150 mm", amplitude = "25 mm", periods = 1, nodes = 80, sampling = "uniform-x" })";

std::string planar() { return shipped_scene("planar-iliac.toml"); }

/// Solves the text as bad.toml with every output asked for, and answers what stands on stderr: the input must be
/// refused, with nothing on stdout and nothing written.
std::string refusal(const TemporaryFolder& folder, const std::string& text, const std::vector<std::string>& more = {}) {
  folder.write("bad.toml", text);
  const std::vector<std::string> before = entries(folder.path());
  std::vector<std::string> arguments{"solve", "bad.toml", "--out", "result.json", "--write", "csv=result.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult result = bowstring_command(folder.path(), arguments);
  CHECK(result.exit_code == 2);
  CHECK(result.out == "");
  CHECK(entries(folder.path()) == before);

  const CommandResult explained = bowstring_command(folder.path(), {"explain", "bad.toml"});
  if (more.empty()) {
    CHECK(explained.exit_code == 2);
    CHECK(explained.out == "");
    CHECK(explained.err == result.err);
  }
  return replaced(result.err, folder.path(), "DIR");
}

std::string refusal(const std::string& text, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  return refusal(folder, text, more);
}

}  // namespace

TEST_CASE("an unknown key is named with its place, the known ones and the nearest") {
  const std::string text = edited(planar(), "tension = \"10 N\"", "tension = \"10 N\"\ntensoin = \"11 N\"");
  CHECK(refusal(text) ==
        position("bad.toml", text, "tensoin") +
            ": unknown key 'tensoin' in energy 'axial-tension'; expected one of: type, name, on, tension; "
            "did you mean 'tension'?\n");
}

TEST_CASE("a wrong unit") {
  const std::string text = edited(planar(), "\"10 N\"", "\"10 mm\"");
  CHECK(refusal(text) ==
        position("bad.toml", text, "\"10 mm\"") +
            ": wrong unit: 'tension' of energy 'axial-tension' is text \"10 mm\"; expected a quantity in N; "
            "write \"10 N\"\n");
}

TEST_CASE("a foundation stiffness without a unit is ambiguous") {
  const std::string text = edited(planar(), "\"0.03 N/mm\"", "0.03");
  CHECK(refusal(text) == position("bad.toml", text, "0.03") +
                             ": ambiguous unit: 'stiffness' of energy 'anchoring' is the bare number 0.03; expected a "
                             "quantity in N/mm^2 or N/mm; write \"0.03 N/mm^2\" or \"0.03 N/mm\", which mean different "
                             "things\n");
}

TEST_CASE("numbers out of bounds") {
  const std::string nodes = edited(planar(), "nodes = 80", "nodes = 2");
  CHECK(refusal(nodes) ==
        position("bad.toml", nodes, "nodes = 2", 8) +
            ": 'nodes' of geometry 'sinusoid' of vessel 'iliac' is 2, out of bounds; expected at least 3 "
            "and at most 1e+06; write a larger number\n");
  const std::string radius = edited(planar(), "\"0.4445 mm\"", "\"0 mm\"");
  CHECK(refusal(radius) ==
        position("bad.toml", radius, "\"0 mm\"") +
            ": 'radius' of wire 'lunderquist' is 0 mm, out of bounds; expected more than 0 mm; write a "
            "larger number\n");
}

TEST_CASE("a number that is not finite") {
  const std::string bare = edited(planar(), "\"10 N\"", "nan");
  CHECK(refusal(bare) ==
        position("bad.toml", bare, "nan") +
            ": 'tension' of energy 'axial-tension' is number nan, which is not finite; expected a finite "
            "number; write \"<number> N\"\n");
  const std::string quoted = edited(planar(), "\"10 N\"", "\"nan N\"");
  CHECK(refusal(quoted) ==
        position("bad.toml", quoted, "\"nan N\"") +
            ": 'tension' of energy 'axial-tension' is text \"nan N\", which is not finite; expected a "
            "finite number; write \"<number> N\"\n");
}

TEST_CASE("an unknown plugin") {
  const std::string text = edited(planar(), "type = \"axial-tension\"", "type = \"axial-tensoin\"");
  CHECK(refusal(text) ==
        position("bad.toml", text, "\"axial-tensoin\"") +
            ": unknown energy 'axial-tensoin'; expected one of: anchoring, axial-tension, dead-moment, "
            "extravascular, point-load, vessel-strain, wire-bending; did you mean 'axial-tension'?\n");
}

TEST_CASE("two energies of one name") {
  const std::string text = planar() + "[[energy]]\ntype = \"anchoring\"\non = \"iliac\"\nstiffness = \"1 N/mm\"\n";
  const std::string first = position("bad.toml", text, "[[energy]]\ntype = \"anchoring\"\non   =");
  CHECK(refusal(text) == position("bad.toml", text, "[[energy]]\ntype = \"anchoring\"\non =") +
                             ": duplicate name: energy 'anchoring', after the energy at " + first +
                             "; expected a name for each; add name = \"<name>\" to each\n");
}

TEST_CASE("a duplicate key") {
  const std::string text = edited(planar(), "dimension = 2", "dimension = 2\ndimension = 3");
  CHECK(refusal(text) == position("bad.toml", text, "dimension = 3") +
                             ": duplicate key 'dimension'; expected each key once; remove one of the two\n");
}

TEST_CASE("an unknown reference in 'on'") {
  const std::string energy = edited(planar(), "on   = \"iliac\"\nstiffness", "on   = \"iliak\"\nstiffness");
  CHECK(refusal(energy) ==
        position("bad.toml", energy, "\"iliak\"") +
            ": unknown curve 'iliak' in 'on' of energy 'anchoring'; expected one of: iliac, lunderquist; "
            "did you mean 'iliac'?\n");
  const std::string constraint = edited(planar(), "[\"lunderquist\", \"iliac\"]", "[\"lunderqvist\", \"iliac\"]");
  CHECK(refusal(constraint) ==
        position("bad.toml", constraint, "\"lunderqvist\"") +
            ": unknown curve 'lunderqvist' in 'on' of constraint 'lumen'; expected one of: iliac, "
            "lunderquist; did you mean 'lunderquist'?\n");
}

TEST_CASE("every error of a points file at once") {
  const TemporaryFolder folder;
  folder.write("points.csv",
               "# a centerline\n"
               "x_mm,y_mm,z_mm,radius_mm\n"
               "0,0,0,5\n"
               "10,0\n"
               "20,zero,0,5\n"
               "30,0,0,5\n"
               "30,0,0,5\n"
               "40,0,nan,5\n");
  const std::string text = edited(planar(), geometry_line, "geometry = { type = \"csv\", file = \"points.csv\" }");
  CHECK(
      refusal(folder, text) ==
      position("bad.toml", text, "{ type = \"csv\"") +
          ": DIR/points.csv:4: a row of 2 cells; expected 4, one for each column that the header names; complete the "
          "row or remove it\n"
          "DIR/points.csv:5: 'zero' in column 'y_mm' is no number; expected a number in mm, as 12.5; correct the cell "
          "or remove the row\n"
          "DIR/points.csv:7: the point of line 6 again; expected points that are apart; remove one of the two rows\n"
          "DIR/points.csv:8: 'nan' in column 'z_mm'; expected a finite number in mm; correct the cell or remove the "
          "row\n");
}

TEST_CASE("a points file that is not there") {
  const std::string text = edited(planar(), geometry_line, "geometry = { type = \"csv\", file = \"points.csv\" }");
  CHECK(refusal(text) == position("bad.toml", text, "{ type = \"csv\"") +
                             ": DIR/points.csv: cannot be read (No such file or directory); expected a text file of "
                             "points; check the path, which is relative to the composition\n");
}

TEST_CASE("a tube that folds into itself, and where") {
  const std::string text = edited(planar(), "\"6 mm\"", "\"20 mm\"");
  CHECK(refusal(text) ==
        position("bad.toml", text, "\"20 mm\"") +
            ": the tube of vessel 'iliac' folds into itself at s = 138.4 mm, (112.03, -24.995) mm: radius "
            "times curvature is 0.875 (radius 20 mm, bend radius 22.9 mm); expected less than 0.8 "
            "everywhere; smooth the centerline (geometry key 'smoothing') or sample it with fewer "
            "'nodes'\n");
}

TEST_CASE("a wire as wide as the lumen, and where") {
  const std::string text = edited(
      planar(), "\"6 mm\"",
      "{ table = [[\"0 mm\", \"6 mm\"], [\"50 mm\", \"0.4 mm\"], [\"60 mm\", \"0.4 mm\"], [\"100 mm\", \"6 mm\"]] }");
  const std::string error = refusal(text);
  CHECK(
      error ==
      position("bad.toml", text, "[[constraint]]") +
          ": constraint 'lumen': wire 'lunderquist' (radius 0.4445 mm) is as wide as the lumen of 'iliac' or wider, by "
          "0.0445 mm at s = 58.64 mm; reduce the wire's radius, or use type = \"concentric\", which has no "
          "clearance\n");
}

TEST_CASE("a planar scene with data in space") {
  const std::string helix =
      edited(planar(), geometry_line,
             "geometry = { type = \"helix\", chord = \"150 mm\", radius = \"15 mm\", turns = 1, nodes = 80 }");
  CHECK(refusal(helix) ==
        position("bad.toml", helix, "{ type = \"helix\"") +
            ": a helix in a scene of dimension 2; expected dimension 3; set dimension = 3 in [scene], or "
            "use a planar geometry such as 'sinusoid'\n");

  const TemporaryFolder folder;
  folder.write("points.csv", "x_mm,y_mm,z_mm\n0,0,0\n10,0,1\n20,1,2\n30,3,4\n");
  const std::string points = edited(planar(), geometry_line, "geometry = { type = \"csv\", file = \"points.csv\" }");
  CHECK(refusal(folder, points) ==
        position("bad.toml", points, "{ type = \"csv\"") +
            ": DIR/points.csv:3: 2-D scene with 3-D data: z_mm is 1 here and not 0 in 3 rows in "
            "all; expected 0 in every row, or no column z_mm; set dimension = 3 in [scene], or "
            "project the points into the plane\n");

  const std::string tangent =
      edited(planar(), "radius     = \"0.4445 mm\"\nends       = [\"pinned\", \"pinned\"]",
             "radius     = \"0.4445 mm\"\nends       = [{ type = \"clamped\", tangent = [1, 0, 0] }, \"pinned\"]");
  CHECK(refusal(tangent) ==
        position("bad.toml", tangent, "[1, 0, 0]") +
            ": 'tangent' of the first end of wire 'lunderquist' has 3 entries; expected a list of as "
            "many numbers as the scene has dimensions; write the direction that is held, along the "
            "curve\n");
}

TEST_CASE("all errors of a file at once, those of --set among them") {
  std::string text = edited(planar(), "\"10 N\"", "\"10 mm\"");
  text = edited(text, "type = \"anchoring\"", "type = \"anchorin\"");
  text = edited(text, "dimension = 2", "dimension = 4");
  const std::string error = refusal(text, {"--set", "wire.lunderqist.radius=1", "--set", "solver.tolerance=-1"});
  CHECK(contains(error,
                 position("bad.toml", text, "4\n") + ": 'dimension' of [scene] is whole number 4; expected 2 or 3"));
  CHECK(contains(error, position("bad.toml", text, "\"anchorin\"") + ": unknown energy 'anchorin'"));
  CHECK(contains(error, position("bad.toml", text, "\"10 mm\"") + ": wrong unit"));
  CHECK(contains(error,
                 "--set wire.lunderqist.radius=1: path 'wire.lunderqist.radius': no entry 'lunderqist' in 'wire'; "
                 "expected one of: lunderquist; did you mean 'lunderquist'?\n"));
  CHECK(contains(error, "'tolerance' of solver 'ipopt' is -1"));
}

TEST_CASE("a file that is not there, and one that is not TOML") {
  const TemporaryFolder folder;
  CommandResult result = bowstring_command(folder.path(), {"solve", "none.toml", "--out", "result.json"});
  CHECK(result.exit_code == 2);
  CHECK(result.err ==
        "none.toml: cannot read the file (No such file or directory); expected a composition in TOML; check "
        "the path\n");
  folder.write("bad.toml", "schema = 1\n[scene\n");
  result = bowstring_command(folder.path(), {"solve", "bad.toml", "--out", "result.json"});
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "bad.toml:2:"));
  CHECK(entries(folder.path()) == std::vector<std::string>{"bad.toml"});
}

TEST_CASE("a command line that is wrong") {
  const TemporaryFolder folder;
  folder.write("good.toml", planar());
  const auto error = [&](const std::vector<std::string>& arguments) {
    const CommandResult result = bowstring_command(folder.path(), arguments);
    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    return result.err;
  };
  CHECK(error({"solve", "good.toml", "--set", "solver.tolerance"}) ==
        "error: --set solver.tolerance: found no path=value; expected for instance --set solver.tolerance=1e-9\n");
  CHECK(error({"solve", "good.toml", "--write", "csv"}) ==
        "error: --write csv: found no writer=file; expected for instance --write svg=picture.svg\n");
  CHECK(contains(error({"solve", "good.toml", "--write", "cvs=points.csv"}),
                 "error: --write cvs=points.csv: no plugin offers writer 'cvs'; expected one of: csv"));
  CHECK(error({"describe", "wire-bending"}) ==
        "error: 'wire-bending': expected KIND/NAME, for instance energy/wire-bending\n");
  CHECK(contains(error({"describe", "energy/wire-bendin"}), "did you mean 'wire-bending'?"));
  CHECK(contains(error({"plugins", "energies"}), "did you mean 'energy'?"));
  CHECK(error({"slove", "good.toml"}) != "");
  CHECK(error({}) != "");
  CHECK(entries(folder.path()) == std::vector<std::string>{"good.toml"});
}

}  // namespace bowstring
