#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "study/store/gzip.hpp"
#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::edited;
using testing::entries;
using testing::read_text;
using testing::shipped_scene;
using testing::TemporaryFolder;
using Json = nlohmann::json;

namespace {

const char* const tension = "\"energy.axial-tension.tension\" = ";

/// The well-posed planar scene on a coarse mesh, under a tension.
std::string scene(const std::string& force, const std::string& more = "") {
  return "schema = 1\ntitle = \"compared\"\nbase = \"" + testing::source_root() +
         "/scenes/planar-iliac-smooth.toml\"\n[set]\n\"vessel.iliac.geometry.nodes\" = 24\n" + tension + "\"" + force +
         "\"\n" + more;
}

/// A folder with one.toml, two.toml (another tension) and three.toml (another radius besides).
class Scenes : public TemporaryFolder {
 public:
  Scenes() {
    write("one.toml", scene("10 N"));
    write("two.toml", scene("12 N"));
    write("three.toml", scene("12 N", "\"vessel.iliac.radius\" = \"5 mm\"\n"));
  }

  CommandResult compare(const std::string& a, const std::string& b, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"compare", a, b};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return bowstring_command(path(), arguments);
  }

  void solve(const std::string& name) const {
    const CommandResult result = bowstring_command(path(), {"solve", name + ".toml", "--out", name + ".json"});
    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  }
};

int widest(const std::string& text) {
  int out = 0, line = 0;
  for (const char c : text) {
    line = c == '\n' ? 0 : line + ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U);
    out = std::max(out, line);
  }
  return out;
}

}  // namespace

TEST_CASE("compare: two compositions, place by place") {
  const Scenes folder;
  const CommandResult same = folder.compare("one.toml", "one.toml");
  CHECK(same.exit_code == 0);
  CHECK(same.out == "A  one.toml (composition)\nB  one.toml (composition)\ncomposition: the same\n");
  CHECK(same.err == "");

  const CommandResult other = folder.compare("one.toml", "two.toml");
  CHECK(other.exit_code == 1);
  CHECK(other.out ==
        "A  one.toml (composition)\nB  two.toml (composition)\n"
        "composition                       A                           B\n"
        "  energy.axial-tension.tension    10 N                        12 N\n");
  CHECK(other.err == "");
  CHECK(folder.compare("one.toml", "three.toml").err ==
        "warning: 2 things differ: what their results differ in cannot be laid to one of them\n");
}

TEST_CASE("compare: long values are cut so that the difference is seen") {
  const Scenes folder;
  const std::string table =
      "\"wire.lunderquist.radius\" = { table = [[\"0 mm\", \"0.4 mm\"], [\"50 mm\", \"0.45 mm\"], ";
  folder.write("a.toml", scene("10 N", table + "[\"90 mm\", \"0.41 mm\"]] }\n"));
  folder.write("b.toml", scene("10 N", table + "[\"90 mm\", \"0.42 mm\"]] }\n"));
  const CommandResult result = folder.compare("a.toml", "b.toml");
  CHECK(contains(result.out, "0.41 mm\""));
  CHECK(contains(result.out, "0.42 mm\""));
  CHECK(widest(result.out) <= 100);
}

TEST_CASE("compare: two results, what differs in them and why") {
  const Scenes folder;
  folder.solve("one");
  folder.solve("two");
  const CommandResult result = folder.compare("one.json", "two.json");
  CHECK(result.exit_code == 1);
  CHECK(result.err == "");
  CHECK(contains(result.out, "A  one.json (result, converged)\nB  two.json (result, converged)\n"));
  for (const char* part : {"\n  peak_displacement_mm ", "\nenergy, N mm ", "\n  wire-bending ", "\n  total ",
                           "\n  stationarity ", "\n  iliac ", "\n  contacts of lunderquist on iliac, sum ",
                           "\n  support of iliac, last end ", "\n  iterations ", "\n  solve, ms ", " × ",
                           "\n  energy.axial-tension.tension    10 N ", "\nprograms: the same\n"}) {
    CHECK_MESSAGE(contains(result.out, part), part);
  }
  CHECK(widest(result.out) <= 100);

  folder.solve("three");
  const CommandResult three = folder.compare("one.json", "three.json");
  CHECK(three.err == "warning: 2 things differ: what follows cannot be laid to one of them\n");
}

TEST_CASE("compare: a result with itself, in gzip or not, whatever the file is called") {
  const Scenes folder;
  folder.solve("one");
  folder.write("packed.toml", study::gzip(read_text(folder.path() + "/one.json")));
  const CommandResult result = folder.compare("one.json", "packed.toml");
  CHECK(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(contains(result.out, "the same bits: "));
  CHECK(contains(result.out, "\ncomposition: the same\nprograms: the same\n"));
}

TEST_CASE("compare: a composition with a result's own") {
  const Scenes folder;
  folder.solve("one");
  const CommandResult own = folder.compare("one.toml", "one.json");
  CHECK(own.exit_code == 0);
  CHECK(own.out ==
        "A  one.toml (composition)\nB  one.json (result, converged: its composition is compared)\n"
        "composition: the same\n");
  CHECK(folder.compare("two.toml", "one.json").exit_code == 1);
}

TEST_CASE("compare: a difference of programs is told, and counts as one thing") {
  const Scenes folder;
  folder.solve("one");
  Json document = Json::parse(read_text(folder.path() + "/one.json"));
  document["provenance"]["version"] = "0.0.9";
  for (Json& plugin : document["provenance"]["plugins"]) plugin["sha256"] = std::string(64, 'a');
  folder.write("old.json", document.dump());
  const CommandResult result = folder.compare("old.json", "one.json");
  CHECK(result.exit_code == 1);
  CHECK(result.err == "");
  CHECK(contains(result.out, "\nprograms\n  version 0.0.9 in A, 0.1.0 in B\n"));
  CHECK(contains(result.out, "  plugin energy/anchoring: sha256 aaaaaaaaaaaa… in A, "));
}

TEST_CASE("compare --json prints the same as one document") {
  const Scenes folder;
  folder.solve("one");
  folder.solve("three");
  const CommandResult result = folder.compare("one.json", "three.json", {"--json"});
  CHECK(result.exit_code == 1);
  const Json document = Json::parse(result.out);
  CHECK(document["format"] == "bowstring.compare/1");
  CHECK(document["a"] == Json{{"file", "one.json"}, {"form", "result"}});
  CHECK(document["differs"] == true);
  CHECK(document["things"] == 2);
  CHECK(document["warning"] == "2 things differ: what follows cannot be laid to one of them");
  REQUIRE(document["composition"].size() == 2);
  CHECK(document["composition"][0] ==
        Json{{"path", "vessel.iliac.radius"}, {"a", "6 mm"}, {"b", "5 mm"}, {"because_of", nullptr}});
  const Json peak = document["results"]["quantities"]["peak_displacement_mm"];
  CHECK(peak["absolute"].get<double>() == peak["b"].get<double>() - peak["a"].get<double>());
  CHECK(peak["absolute"].get<double>() != 0.0);
  CHECK(document["results"]["same_bits"] == false);
  CHECK(document["results"]["curves"][0]["largest_mm"].get<double>() > 0.0);

  const Json texts = Json::parse(folder.compare("one.toml", "one.toml", {"--json"}).out);
  CHECK(texts["differs"] == false);
  CHECK(texts["results"] == nullptr);
}

TEST_CASE("compare: wrong input, in words") {
  const Scenes folder;
  const auto refused = [&](const std::string& a, const std::string& b) {
    const CommandResult result = folder.compare(a, b);
    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    return result.err;
  };
  CHECK(refused("none.toml", "one.toml") ==
        "none.toml: cannot be read (No such file or directory); expected a file, plain or in gzip; check the "
        "path\n");
  folder.write("notes.txt", "dear diary, today\n");
  CHECK(contains(refused("one.toml", "notes.txt"), "notes.txt:1:"));
  CHECK(contains(refused("one.toml", "notes.txt"),
                 "; expected a composition (TOML) or a result document (JSON, also in gzip); mend this first: what "
                 "stands behind it has not been read\n"));
  folder.write("other.json", "{\"format\": \"other/1\"}");
  CHECK(refused("other.json", "one.toml") ==
        "other.json: the document has format \"other/1\"; expected \"bowstring.result/1\"; solve it again with "
        "this version, which reads no other\n");
  folder.write("half.json", "{\"format\": ");
  CHECK(contains(refused("half.json", "one.toml"), "half.json: the document is no JSON (parse error at line 1"));
  const std::string packed = study::gzip(scene("10 N"));
  folder.write("cut.gz", packed.substr(0, packed.size() / 2));
  CHECK(refused("cut.gz", "one.toml") ==
        "cut.gz: cannot be read (it ends too early: a gzip file that was cut off); expected a file, plain or in "
        "gzip; check the path\n");
  folder.write("misspelt.toml", edited(scene("10 N"), "axial-tension", "axial-tensoin"));
  CHECK(contains(refused("misspelt.toml", "none.toml"), "did you mean 'axial-tension'?"));
  CHECK(contains(refused("misspelt.toml", "none.toml"), "none.toml: cannot be read"));
  folder.write("step.toml", scene("10 N") + "[[step]]\n[[step]]\n\"energy.axial-tension.tension\" = \"1 mm\"\n");
  CHECK(contains(refused("step.toml", "one.toml"), "wrong unit: 'tension' of energy 'axial-tension'"));
  CHECK(folder.compare("one.toml", "two.toml", {"--set", "title=x"}).exit_code == 2);
}

TEST_CASE("compare: a plugin that is known and cannot be used") {
  const Scenes folder;
  const TemporaryFolder plugins;
  plugins.write("notes.so", "dear diary");
  plugins.write_sidecar("notes.so", "energy", "test-notes", "some-tag");
  folder.write("bad.toml", scene("10 N") + "[[energy]]\ntype = \"test-notes\"\non = \"iliac\"\n");
  CHECK(folder.compare("bad.toml", "one.toml", {"--plugin-path", plugins.path()}).exit_code == 3);
}

}  // namespace bowstring
