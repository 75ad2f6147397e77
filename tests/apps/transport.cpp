#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
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
using testing::TemporaryFolder;

namespace {

using Json = nlohmann::ordered_json;

constexpr int places = 30;

/// Places on a curve in space, all shifted by (x, y, z).
std::string curve_file(double x = 0.0, double y = 0.0, double z = 0.0, int count = places) {
  std::string out = "# places\nx_mm,y_mm,z_mm\n";
  for (int i = 0; i < count; ++i) {
    const double t = 6.0 * i / (count - 1);
    char row[120];
    std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g\n", 20.0 * t + x, 15.0 * std::sin(t) + y,
                  4.0 * std::cos(1.7 * t) + z);
    out += row;
  }
  return out;
}

std::vector<std::string> command_line(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "transport");
  return arguments;
}

Json document(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const CommandResult result = bowstring_command(folder.path(), command_line(arguments));
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(result.err == "");
  return Json::parse(result.out);
}

/// What stands on stderr of a comparison that is refused, with every output asked for: nothing is printed or written.
std::string refusal(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  const std::vector<std::string> before = entries(folder.path());
  for (const char* more : {"--out", "t.json", "--write", "svg=t.svg"}) arguments.emplace_back(more);
  const CommandResult result = bowstring_command(folder.path(), command_line(arguments));
  CHECK(result.exit_code == 2);
  CHECK(result.out == "");
  CHECK(entries(folder.path()) == before);
  return result.err;
}

/// The refusal of such a file, in the place of either measure.
std::string refusal_of_file(const std::string& text, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  folder.write("good.csv", curve_file());
  folder.write("bad.csv", text);
  std::vector<std::string> first{"bad.csv", "good.csv"}, second{"good.csv", "bad.csv"};
  first.insert(first.end(), more.begin(), more.end());
  second.insert(second.end(), more.begin(), more.end());
  const std::string told = refusal(folder, first);
  CHECK(refusal(folder, second) == told);
  return told;
}

}  // namespace

TEST_CASE("transport: defaults, and every key of the document") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(0.3, 0.4, 0.0));
  const Json found = document(folder, {"a.csv", "b.csv"});
  CHECK(found["format"] == "bowstring.transport/1");
  CHECK(found["method"]["type"] == "exact");
  CHECK(found["ground_cost"]["type"] == "euclidean");
  CHECK(found["unit"] == "mm^2");
  CHECK(found["value"].get<double>() == doctest::Approx(0.25).epsilon(1e-12));  // |t|², and not its root
  CHECK(found["transport_cost"] == found["value"]);
  CHECK(found["unique"] == true);
  CHECK(found["slack"].get<double>() > 0.0);
  CHECK(found["certificate"]["holds"] == true);
  CHECK(found["certificate"]["dual_violation"].get<double>() <=
        1e-9 * found["certificate"]["cost_scale"].get<double>());
  CHECK(found["warm"] == false);
  CHECK(found["iterations"].get<long>() >= 0);
  CHECK(found["memory_bytes"].get<long>() > 0);
  CHECK(found["figures"].is_object());
  CHECK(found["repeat"].is_null());
  for (const char* key : {"read", "cost", "solve"}) CHECK(found["seconds"][key].get<double>() >= 0.0);

  REQUIRE(found["plan"]["mass"].size() == places);
  for (std::size_t k = 0; k < places; ++k) {
    CHECK(found["plan"]["row"][k] == found["plan"]["column"][k]);
    CHECK(found["plan"]["mass"][k].get<double>() == doctest::Approx(1.0 / places).epsilon(1e-14));
  }
  CHECK(found["duals"]["a"].size() == places);
  CHECK(found["duals"]["b"].size() == places);
  const Json& gradient = found["gradient"];
  CHECK(gradient["positions_a"].size() == places);
  for (const Json& row : gradient["positions_a"]) {
    CHECK(row[0].get<double>() == doctest::Approx(-2.0 * 0.3 / places).epsilon(1e-9));
    CHECK(row[1].get<double>() == doctest::Approx(-2.0 * 0.4 / places).epsilon(1e-9));
  }
  CHECK(gradient["positions_b"][3][0].get<double>() == doctest::Approx(2.0 * 0.3 / places).epsilon(1e-9));
  CHECK(gradient["frames_a"].is_null());
  CHECK(gradient["frames_b"].is_null());
  CHECK(gradient["weights_a"].size() == places);
  CHECK(found["a"]["name"] == "a.csv");
  CHECK(found["a"]["kind"] == "places");
  CHECK(found["a"]["weights"][0].get<double>() == 1.0 / places);
  CHECK(found["provenance"]["plugins"].size() == 2);
  CHECK(found["provenance"]["inputs"][0]["file"] == folder.path() + "/a.csv");
  CHECK(found["provenance"]["inputs"][1]["sha256"].get<std::string>().size() == 64);
}

TEST_CASE("transport: a table for people, and the document beside it") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(0.3, 0.4, 0.0));
  const CommandResult result = bowstring_command(folder.path(), command_line({"a.csv", "b.csv", "--out", "t.json"}));
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "exact with euclidean: a.csv (30 places) to b.csv (30 places)\n"));
  CHECK(contains(result.out, "  value                  0.25 mm^2\n"));
  CHECK(contains(result.out, "  its root, a distance   0.5 mm\n"));
  CHECK(contains(result.out, "  plan                   30 of 900 entries are not zero\n"));
  CHECK(contains(result.out, "  certificate            holds: "));
  CHECK(contains(result.out, "  the only plan          yes, slack "));
  Json here = document(folder, {"a.csv", "b.csv"}), written = Json::parse(read_text(folder.path() + "/t.json"));
  here.erase("seconds");
  written.erase("seconds");
  CHECK(here == written);
}

TEST_CASE("transport: a measure is at no distance from itself, and W2^2 grows with the square of a shift") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  CHECK(document(folder, {"a.csv", "a.csv"})["value"].get<double>() == 0.0);
  double before = 0.0;
  for (const double shift : {0.4, 0.2, 0.1, 0.05}) {
    folder.write("b.csv", curve_file(0.6 * shift, 0.0, 0.8 * shift));
    const double value = document(folder, {"a.csv", "b.csv"})["value"].get<double>();
    CHECK(value == doctest::Approx(shift * shift).epsilon(1e-9));
    if (before > 0.0) CHECK(before / value == doctest::Approx(4.0).epsilon(1e-8));
    before = value;
  }
}

TEST_CASE("transport: sums of weights may differ by rounding, and not by more") {
  const TemporaryFolder folder;
  folder.write("a.csv", "x_mm,y_mm,z_mm,weight\n0,0,0,0.25\n3,0,0,0.75\n");
  folder.write("b.csv", "x_mm,y_mm,z_mm,weight\n0,4,0,1.000000000001\n");
  CHECK(document(folder, {"a.csv", "b.csv"})["value"].get<double>() == doctest::Approx(0.25 * 16 + 0.75 * 25));
  folder.write("b.csv", "x_mm,y_mm,z_mm,weight\n0,4,0,1.001\n");
  CHECK(refusal(folder, {"a.csv", "b.csv"}) ==
        "a.csv, b.csv: the weights of the first measure sum to 1, those of the second to 1.001; expected equal sums; "
        "divide each weight by the sum of its measure, or choose the method 'unbalanced'\n");
}

TEST_CASE("transport: what is wrong with a file is told by line and place, all at once, and nothing is written") {
  CHECK(refusal_of_file("x_mm,y_mm,z_mm,weight\n0,0,0,1\n1,0,0,-0.5\n2,0,0,nan\n3,0,0\n") ==
        "bad.csv:3: place 1: weight -0.5; expected a finite number, not negative; leave the place out or mend it\n"
        "bad.csv:4: place 2: weight nan; expected a finite number, not negative; leave the place out or mend it\n"
        "bad.csv:5: place 3: a row of 3 cells; expected 4, one for each column that the header names; complete the row "
        "or "
        "remove it\n");
  CHECK(refusal_of_file("x_mm,y_mm,z_mm,weight\n0,0,0,0\n1,0,0,0\n") ==
        "bad.csv: weights that are all zero; expected at least one above zero; give the places their weights\n");
  CHECK(refusal_of_file("x_mm,y_mm,z_mm\n") ==
        "bad.csv: no places; expected at least one; give a row for each place\n");
  CHECK(refusal_of_file("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n1,0,0,1,1,0,0\n") ==
        "bad.csv:3: place 1: a quaternion of length 1.4142135623730951, which is no rotation; expected length 1; "
        "divide it "
        "by its length\n");
  CHECK(contains(refusal_of_file("x_mm,y_mm,z_mm,qw\n0,0,0,1\n"), "bad.csv:1: columns qw without qx, qy, qz; "));
  CHECK(contains(refusal_of_file("x_mm,y_mm,z_mm\n0,,0\n"), "bad.csv:2: place 0: an empty cell in column 'y_mm'; "));

  const TemporaryFolder folder;
  folder.write("a.csv", "x_mm,y_mm,z_mm\n0,u,0\n");
  const std::string told = refusal(folder, {"a.csv", "none.csv", "--method", "exakt"});
  CHECK(contains(told, "--method exakt: unknown transport 'exakt'; expected one of: exact"));
  CHECK(contains(told, "; did you mean 'exact'"));
  CHECK(
      contains(told,
               "\na.csv:2: place 0: 'u' in column 'y_mm' is no number; expected a number, as 12.5; correct the cell or "
               "remove the row\n"
               "none.csv: cannot be read (No such file or directory); expected a file, plain or in gzip; check the "
               "path\n"));
}

TEST_CASE("transport: a cost of frames needs frames") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(1.0));
  CHECK(
      refusal(folder, {"a.csv", "b.csv#curve", "--cost", "se3-riemannian"}) ==
      "a.csv: places without orientations, and the ground cost 'se3-riemannian' compares frames; expected columns qw, "
      "qx, qy, qz, or a curve; add the columns, write 'a.csv#curve' where the rows are a curve in order, or choose "
      "--cost euclidean\n");
  const Json found = document(folder, {"a.csv#curve", "b.csv#curve", "--cost", "se3-riemannian"});
  CHECK(found["a"]["kind"] == "curve");
  CHECK(found["a"]["s_mm"].size() == places);
  CHECK(found["gradient"]["frames_a"].size() == places);
  CHECK(found["gradient"]["frames_a"][0].size() == 6);
}

TEST_CASE("transport: --set takes keys of the method and of the cost, and no others") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(1.0));
  const Json found = document(folder, {"a.csv#curve", "b.csv#curve", "--method", "sinkhorn", "--set", "epsilon=2",
                                       "--cost", "se3-riemannian", "--set", "forward-weight=0.5 1/mm"});
  CHECK(found["method"]["epsilon"] == 2.0);
  CHECK(found["ground_cost"]["forward-weight"] == 0.5);
  CHECK(contains(
      refusal(folder, {"a.csv", "b.csv", "--method", "sinkhorn", "--set", "epsilom=2"}),
      "--set epsilom=2: unknown key 'epsilom' of transport 'sinkhorn' and ground-cost 'euclidean'; expected one "
      "of: "));
  CHECK(contains(refusal(folder, {"a.csv", "b.csv", "--method", "sinkhorn", "--set", "epsilon=-2"}),
                 "--set epsilon=-2: 'epsilon' of transport 'sinkhorn' is -2, out of bounds; expected "));
  CHECK(contains(refusal(folder, {"a.csv", "b.csv", "--set", "epsilon"}),
                 "--set epsilon: found no path=value; expected for instance "));
}

TEST_CASE("transport: --repeat goes on from the plan before, and leaves the answer alone") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  std::string scattered = "x_mm,y_mm,z_mm\n";
  for (int i = 0; i < places; ++i) {
    scattered += std::to_string(i * 7 % 30) + "," + std::to_string(i * 11 % 30) + ",5\n";
  }
  folder.write("b.csv", scattered);
  const Json found = document(folder, {"a.csv", "b.csv", "--repeat", "7"});
  const Json& repeat = found["repeat"];
  CHECK(repeat["count"] == 7);
  CHECK(repeat["seed"] == 1);
  CHECK(repeat["step_mm"].get<double>() > 0.0);
  for (const char* how : {"warm", "cold"}) {
    const Json& seconds = repeat["seconds"][how];
    CHECK(seconds["min"].get<double>() > 0.0);
    CHECK(seconds["min"] <= seconds["median"]);
    CHECK(seconds["median"] <= seconds["max"]);
  }
  CHECK(repeat["iterations"]["warm"]["median"].get<double>() < repeat["iterations"]["cold"]["median"].get<double>());
  CHECK(found["value"] == document(folder, {"a.csv", "b.csv"})["value"]);
  CHECK(document(folder, {"a.csv", "b.csv", "--repeat", "7"})["repeat"]["iterations"] == repeat["iterations"]);
  const CommandResult told = bowstring_command(folder.path(), command_line({"a.csv", "b.csv", "--repeat", "3"}));
  CHECK(contains(told.out, "3 comparisons after steps of "));
  CHECK(bowstring_command(folder.path(), command_line({"a.csv", "b.csv", "--repeat", "0"})).exit_code == 2);
}

TEST_CASE("transport: curves are sampled and weighted as asked for") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(1.0, 0.0, 0.0, 17));
  const Json resampled = document(folder, {"a.csv#curve", "b.csv#curve", "--points", "25"});
  CHECK(resampled["a"]["positions"].size() == 25);
  CHECK(resampled["b"]["positions"].size() == 25);
  const Json weighted = document(folder, {"a.csv#curve", "b.csv", "--weights", "arc-length"});
  CHECK(weighted["a"]["weights"][0] < weighted["a"]["weights"][1]);
  CHECK(weighted["b"]["weights"][0] == weighted["b"]["weights"][1]);
  CHECK(
      refusal(folder, {"a.csv", "b.csv", "--points", "25"}) ==
      "--points: neither measure is a curve; expected a curve to be sampled; write 'a.csv#curve' where the rows of the "
      "file are a curve in order, or leave --points out\n");
  CHECK(contains(refusal(folder, {"a.csv#curve", "b.csv", "--weights", "lumen-section"}),
                 "a.csv#curve: weights 'lumen-section' of a curve whose radius is not known; "));
}

TEST_CASE("transport: curves of result documents") {
  const TemporaryFolder folder;
  const std::string scene = testing::source_root() + "/scenes/cantilever.toml";
  REQUIRE(bowstring_command(folder.path(), {"solve", scene, "--out", "r.json"}).exit_code == 0);
  const Json found = document(folder, {"r.json#rod", "r.json#rod"});
  CHECK(found["value"] == 0.0);
  CHECK(found["a"]["name"] == "r.json#rod");
  CHECK(found["a"]["kind"] == "curve");
  CHECK(refusal(folder, {"r.json#rood", "r.json"}) ==
        "r.json: the document has no curve 'rood'; expected one of: rod; did you mean 'rod'?\n"
        "r.json: no curve of the document is named; expected one of: rod; write r.json#rod\n");
}

TEST_CASE("transport: --write draws the plan; what cannot be written leaves nothing behind") {
  const TemporaryFolder folder;
  folder.write("a.csv", curve_file());
  folder.write("b.csv", curve_file(3.0, -6.0, 1.0));
  const CommandResult drawn =
      bowstring_command(folder.path(), command_line({"a.csv#curve", "b.csv", "--write", "svg=t.svg"}));
  CHECK(drawn.exit_code == 0);
  const std::string picture = read_text(folder.path() + "/t.svg");
  CHECK(contains(picture, "Transport by exact, ground cost euclidean"));
  CHECK(contains(picture, "A: a.csv#curve, 30 places"));

  std::vector<std::string> before = entries(folder.path());
  for (const char* writer : {"vtp=t.vtp", "csv=c.csv"}) {
    const CommandResult other =
        bowstring_command(folder.path(), command_line({"a.csv", "b.csv", "--write", writer, "--out", "t.json"}));
    CHECK(other.exit_code == 2);
    CHECK(contains(other.err,
                   std::string("error: --write ") + writer + ": this writer takes results, and no comparison"));
    CHECK(entries(folder.path()) == before);
  }
  const std::string kept = read_text(folder.path() + "/a.csv");
  const CommandResult over = bowstring_command(folder.path(), command_line({"a.csv", "b.csv", "--out", "./a.csv"}));
  CHECK(over.exit_code == 2);
  CHECK(contains(over.err, "is what this command reads; expected another file"));
  CHECK(read_text(folder.path() + "/a.csv") == kept);
}

}  // namespace bowstring
