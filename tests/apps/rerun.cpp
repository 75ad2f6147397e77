#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "study/store/gzip.hpp"
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
using Json = nlohmann::json;

namespace {

std::string scene(const std::string& more = "") {
  return "schema = 1\nbase = \"" + testing::source_root() +
         "/scenes/planar-iliac-smooth.toml\"\n[set]\n\"vessel.iliac.geometry.nodes\" = 24\n" + more;
}

const char* const springs = "[[energy]]\ntype = \"test-springs\"\non = \"iliac\"\nstiffness = \"0.01 N/mm\"\n";

class Runs : public TemporaryFolder {
 public:
  /// Writes NAME.toml and solves it to NAME.json.
  std::string solve(const std::string& name, const std::string& text, std::vector<std::string> more = {}) const {
    write(name + ".toml", text);
    std::vector<std::string> arguments{"solve", name + ".toml", "--out", name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = bowstring_command(path(), arguments);
    REQUIRE_MESSAGE(result.exit_code <= 1, result.err);
    return read_text(path() + "/" + name + ".json");
  }

  CommandResult rerun(const std::string& file, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"rerun", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    CommandResult result = bowstring_command(path(), arguments);
    result.out = replaced(result.out, path(), "DIR");
    result.err = replaced(result.err, path(), "DIR");
    return result;
  }
};

void append(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::app) << bytes;
}

}  // namespace

TEST_CASE("rerun: the same bits, from a document plain or in gzip") {
  const Runs folder;
  const std::string document = folder.solve("one", scene());
  const CommandResult plain = folder.rerun("one.json");
  CHECK(plain.exit_code == 0);
  CHECK(contains(plain.out, "one.json: converged, as recorded\nthe same bits: "));
  folder.write("one.result.json.gz", study::gzip(document));
  CHECK(folder.rerun("one.result.json.gz").exit_code == 0);
}

TEST_CASE("rerun: a chain of states, and a status that is not 'converged', come out again") {
  const Runs folder;
  folder.solve("chain", scene("[[step]]\nname = \"in\"\n[[step]]\nname = \"tighter\"\n"
                              "\"energy.axial-tension.tension\" = \"12 N\"\n"));
  const CommandResult chain = folder.rerun("chain.json");
  CHECK_MESSAGE(chain.exit_code == 0, chain.out);
  const Json stalled = Json::parse(folder.solve("stalled", scene("\"solver.max-iterations\" = 3\n")));
  REQUIRE(stalled["status"] == "stalled");
  const CommandResult result = folder.rerun("stalled.json");
  CHECK_MESSAGE(result.exit_code == 0, result.out);
  CHECK(contains(result.out, "stalled.json: stalled, as recorded\nthe same bits: "));
}

TEST_CASE("rerun: --out and --json give the document, as solve does") {
  const Runs folder;
  const Json document = Json::parse(folder.solve("one", scene()));
  const CommandResult result = folder.rerun("one.json", {"--out", "again.json", "--json"});
  CHECK(result.exit_code == 0);
  CHECK(result.out == replaced(read_text(folder.path() + "/again.json"), folder.path(), "DIR"));
  CHECK(Json::parse(result.out)["energy"] == document["energy"]);
  CHECK(contains(result.err, "the same bits: "));

  const CommandResult over = folder.rerun("one.json", {"--out", "one.json"});
  CHECK(over.exit_code == 2);
  CHECK(contains(over.err, "'one.json' is what this composition reads; expected another file"));
  CHECK(contains(folder.rerun("one.json", {"--out", "none/x.json"}).err, "--out: cannot write 'none/x.json'"));
}

TEST_CASE("rerun: other numbers by the same programs") {
  const Runs folder;
  Json document = Json::parse(folder.solve("one", scene()));
  double& peak = document["quantities"]["peak_displacement_mm"].get_ref<double&>();
  peak += 0.5;
  folder.write("edited.json", document.dump());
  const CommandResult result = folder.rerun("edited.json");
  CHECK(result.exit_code == 1);
  CHECK(contains(result.out, "\nother numbers: 1 of "));
  CHECK(contains(result.out, "\n  quantities.peak_displacement_mm "));
  CHECK(contains(result.out,
                 "the same programs, other numbers, and it reads no file: did a time limit or an interrupt "
                 "end it?\n"));
}

TEST_CASE("rerun: a geometry file that has changed is asked for by its name") {
  const Runs folder;
  const auto points = [](const char* middle) {
    return std::string("x_mm,y_mm\n0,0\n20,4\n40,") + middle + "\n60,4\n80,0\n";
  };
  folder.write("vessel.csv", points("6"));
  folder.solve("one",
               "schema = 1\n[scene]\ndimension = 2\n[[vessel]]\nname = \"v\"\n"
               "geometry = { type = \"csv\", file = \"vessel.csv\" }\n[[energy]]\n"
               "type = \"vessel-strain\"\non = \"v\"\nbending-stiffness = \"100 N mm^2\"\n"
               "stretch-stiffness = \"10 N\"\n[[energy]]\ntype = \"point-load\"\non = \"v\"\n"
               "force = [\"0 N\", \"0.1 N\"]\nat = \"40 mm\"\n");
  CHECK(folder.rerun("one.json").exit_code == 0);
  folder.write("vessel.csv", points("7"));
  const CommandResult result = folder.rerun("one.json");
  CHECK(result.exit_code == 1);
  CHECK(contains(result.out, "the same programs, other numbers: has a file that it reads changed? DIR/vessel.csv\n"));
}

TEST_CASE("rerun: a plugin that is not what it was is refused, and forced") {
  const Runs folder;
  const TemporaryFolder plugins;
  plugins.take_fixture("every-kind");
  const std::vector<std::string> path{"--plugin-path", plugins.path()};
  folder.solve("one", scene() + springs, path);
  CHECK(folder.rerun("one.json", path).exit_code == 0);

  append(plugins.path() + "/bowstring_every-kind.so", "\n");
  const CommandResult refused = folder.rerun("one.json", {"--plugin-path", plugins.path(), "--out", "again.json"});
  CHECK(refused.exit_code == 2);
  CHECK(refused.out == "");
  CHECK(contains(refused.err,
                 "error: one.json: the same bits cannot be promised, because 1 thing is not what it was\n"
                 "  plugin energy/test-springs: sha256 "));
  CHECK(contains(refused.err, "/bowstring_every-kind.so)\n"));
  CHECK(contains(refused.err, "\n--force would solve with what is here, and report the largest differences\n"));
  CHECK(entries(folder.path()) == std::vector<std::string>{"one.json", "one.toml"});

  const CommandResult forced = folder.rerun("one.json", {"--plugin-path", plugins.path(), "--force"});
  CHECK(forced.exit_code == 0);
  CHECK(contains(forced.err, "warning: plugin energy/test-springs: sha256 "));
  CHECK(contains(forced.out, "the same bits: "));
}

TEST_CASE("rerun: a plugin that is gone, or cannot be loaded") {
  const Runs folder;
  const TemporaryFolder plugins;
  plugins.take_fixture("every-kind");
  folder.solve("one", scene() + springs, {"--plugin-path", plugins.path()});

  const CommandResult gone = folder.rerun("one.json");
  CHECK(gone.exit_code == 2);
  CHECK(contains(gone.err, "  plugin energy/test-springs: offered by no library here, sha256 "));
  const CommandResult forced = folder.rerun("one.json", {"--force"});
  CHECK(forced.exit_code == 2);
  CHECK(contains(forced.err, "one.json[composition]:"));
  CHECK(contains(forced.err, "test-springs"));

  std::filesystem::remove(plugins.path() + "/bowstring_every-kind.so");
  plugins.write("bowstring_every-kind.so", "dear diary");
  const CommandResult broken = folder.rerun("one.json", {"--plugin-path", plugins.path(), "--force"});
  CHECK(broken.exit_code == 3);
  CHECK(contains(broken.err, "is not a plugin library"));
  CHECK(contains(broken.err, "--force would not help: nothing can be solved without this plugin\n"));
}

TEST_CASE("rerun: version and kernel") {
  const Runs folder;
  Json document = Json::parse(folder.solve("one", scene()));
  document["provenance"]["version"] = "0.0.9";
  document["provenance"]["kernel"]["sha256"] = std::string(64, 'a');
  folder.write("old.json", document.dump());
  const CommandResult refused = folder.rerun("old.json");
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err,
                 "because 2 things are not what they were\n  version 0.0.9 then, 0.1.0 here\n  kernel: sha256 "
                 "aaaaaaaaaaaa… then, "));
  CHECK(folder.rerun("old.json", {"--force"}).exit_code == 0);
}

TEST_CASE("rerun: a start document that has changed") {
  const Runs folder;
  folder.solve("first", scene());
  folder.solve("second",
               "schema = 1\nbase = \"first.toml\"\n[start]\nfrom = \"first.json\"\n[set]\n"
               "\"energy.wire-bending.bending-stiffness\" = \"90 N mm^2\"\n");
  CHECK(folder.rerun("second.json").exit_code == 0);
  append(folder.path() + "/first.json", " ");
  const CommandResult refused = folder.rerun("second.json");
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "  start 'DIR/first.json': sha256 "));
  CHECK(folder.rerun("second.json", {"--force"}).exit_code == 0);
  std::filesystem::remove(folder.path() + "/first.json");
  CHECK(contains(folder.rerun("second.json").err, "then, cannot be read here (No such file or directory)"));
}

TEST_CASE("rerun: a run of a study starts at its predecessor's document beside it") {
  const Runs folder;
  const std::string first = folder.solve("first", scene());
  Json second = Json::parse(folder.solve("second",
                                         "schema = 1\nbase = \"first.toml\"\n[start]\nfrom = \"first.json\"\n[set]\n"
                                         "\"energy.wire-bending.bending-stiffness\" = \"90 N mm^2\"\n"));
  second["composition"].erase("start");
  second["provenance"]["start"] = {{"file", nullptr}, {"sha256", nullptr}};
  second["study"] = {{"name", "s"}, {"run", 1}, {"hash", "22"}, {"predecessor", "11"}};
  std::filesystem::create_directory(folder.path() + "/runs");
  folder.write("runs/22.result.json.gz", study::gzip(second.dump()));
  folder.write("runs/11.result.json.gz", study::gzip(first));
  const CommandResult found = folder.rerun("runs/22.result.json.gz");
  CHECK_MESSAGE(found.exit_code == 0, found.out << found.err);

  std::filesystem::remove(folder.path() + "/runs/11.result.json.gz");
  const CommandResult missing = folder.rerun("runs/22.result.json.gz");
  CHECK(missing.exit_code == 2);
  CHECK(contains(missing.err,
                 "  start: the run 11 that it started from has no document 'runs/11.result.json.gz' here (No such file "
                 "or directory)\n"));
  const CommandResult forced = folder.rerun("runs/22.result.json.gz", {"--force"});
  CHECK(forced.exit_code == 1);
  CHECK(contains(forced.out, "largest differences"));
  CHECK_FALSE(contains(forced.out, "the same programs"));
}

TEST_CASE("rerun: what is no result document") {
  const Runs folder;
  folder.write("one.toml", scene());
  const CommandResult composition = folder.rerun("one.toml");
  CHECK(composition.exit_code == 2);
  CHECK(contains(composition.err, "one.toml: the document is no JSON (parse error at line 1, column 1"));
  CHECK(contains(composition.err,
                 "; expected a result document, as `bowstring solve --out` writes it; name a file that "
                 "was written with --out\n"));
  CHECK(contains(folder.rerun("none.json").err, "none.json: cannot be read (No such file or directory)"));
  folder.write("part.json", "{\"format\": \"bowstring.result/1\", \"status\": 3}");
  const CommandResult part = folder.rerun("part.json");
  CHECK(part.exit_code == 2);
  CHECK(contains(part.err, "part.json: the document has 3 as 'status'; expected text; "));
  CHECK(contains(part.err, "part.json: the document has no 'composition'; expected a table; "));
}

TEST_CASE("rerun: a composition that was damaged in its document") {
  const Runs folder;
  Json document = Json::parse(folder.solve("one", scene()));
  document["composition"]["energy"][0]["stifness"] = 3.0;
  folder.write("damaged.json", document.dump());
  const CommandResult result = folder.rerun("damaged.json");
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "damaged.json[composition]:"));
  CHECK(contains(result.err, "unknown key 'stifness'"));
}

}  // namespace bowstring
