#include <doctest/doctest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "plugins/host/library.hpp"
#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::entries;
using testing::replaced;
using testing::shipped_scene;
using testing::TemporaryFolder;

namespace {

/// The planar scene with one more energy.
void write_scene(const TemporaryFolder& folder, const std::string& energy) {
  folder.write("scene.toml",
               shipped_scene("planar-iliac.toml") + "\n[[energy]]\ntype = \"" + energy + "\"\non = \"iliac\"\n");
}

CommandResult solve_with(const TemporaryFolder& folder, const std::string& plugins,
                         const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"solve", "scene.toml", "--plugin-path", plugins, "--out", "result.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  CommandResult result = bowstring_command(folder.path(), arguments);
  result.err = replaced(replaced(result.err, plugins, "DIR"), host_abi_tag(), "TAG");
  return result;
}

/// stderr of a solve that a plugin's failure ends before anything is solved or written.
std::string failure(const std::string& energy, const TemporaryFolder& plugins) {
  const TemporaryFolder folder;
  write_scene(folder, energy);
  const CommandResult result = solve_with(folder, plugins.path(), {"--write", "csv=result.csv"});
  CHECK(result.exit_code == 3);
  CHECK(result.out == "");
  CHECK(entries(folder.path()) == std::vector<std::string>{"scene.toml"});
  return result.err;
}

}  // namespace

TEST_CASE("exit 3: a library file that is no plugin") {
  const TemporaryFolder plugins;
  plugins.write("notes.so", "dear diary");
  plugins.write_sidecar("notes.so", "energy", "test-notes", host_abi_tag());
  const std::string error = failure("test-notes", plugins);
  CHECK(contains(error, "scene.toml:"));
  CHECK(contains(error,
                 "'DIR/notes.so' is not a plugin library: it is not an ELF file; expected a shared library whose "
                 "source ends with BOWSTRING_PLUGIN\n"));
}

TEST_CASE("exit 3: a library of another ABI") {
  const TemporaryFolder plugins;
  plugins.take_fixture("foreign-abi");
  plugins.write_sidecar("bowstring_foreign-abi.so", "energy", "test-foreign", "bowstring-999/other");
  CHECK(contains(
      failure("test-foreign", plugins),
      "plugin library 'DIR/bowstring_foreign-abi.so' was built for another ABI: its sidecar says "
      "'bowstring-999/other', this bowstring is 'TAG'; rebuild it against this bowstring with the compiler and "
      "standard library of that tag, or take the bowstring that it was built for\n"));
}

TEST_CASE("exit 3: a factory that throws") {
  const TemporaryFolder plugins;
  plugins.take_fixture("faulty");
  const std::string error = failure("test-thrower", plugins);
  CHECK(contains(error, "test-thrower"));
  CHECK(contains(error, "the licence is out of date"));
}

TEST_CASE("exit 3: a writer that throws leaves no file behind") {
  const TemporaryFolder plugins, folder;
  plugins.take_fixture("throwing");
  folder.write("scene.toml", shipped_scene("planar-iliac.toml"));
  const CommandResult result = solve_with(folder, plugins.path(), {"--write", "test-throws-runtime-error=picture"});
  CHECK(result.exit_code == 3);
  CHECK(contains(result.err, "test-throws-runtime-error"));
  CHECK(contains(result.err, "the ink is dry"));
  CHECK(entries(folder.path()) == std::vector<std::string>{"scene.toml"});
}

TEST_CASE("a plugin that answers NaN: failed, and named") {
  const TemporaryFolder plugins, folder;
  plugins.take_fixture("faulty");
  write_scene(folder, "test-not-a-number");
  const CommandResult result = solve_with(folder, plugins.path());
  CHECK(result.exit_code == 1);
  CHECK(entries(folder.path()) == std::vector<std::string>{"result.json", "scene.toml"});
  const auto document = nlohmann::json::parse(testing::read_text(folder.path() + "/result.json"));
  CHECK(document["status"] == "failed");
  const std::string reason = document["reason"];
  CHECK_MESSAGE(contains(reason, "test-not-a-number"), reason);
  CHECK(document["certificate"]["stationarity"].is_null());
  CHECK(document["energy"]["total"].is_null());
  CHECK(document["curves"][0]["points"].size() == 80);
  CHECK_MESSAGE(contains(reason, "iliac"), reason);
}

TEST_CASE("a plugin whose evaluation fails: failed, with its own words") {
  const TemporaryFolder plugins, folder;
  plugins.take_fixture("faulty");
  write_scene(folder, "test-refusal");
  const CommandResult result = solve_with(folder, plugins.path());
  CHECK(result.exit_code == 1);
  const auto document = nlohmann::json::parse(testing::read_text(folder.path() + "/result.json"));
  CHECK(document["status"] == "failed");
  const std::string reason = document["reason"];
  CHECK_MESSAGE(contains(reason, "test-refusal"), reason);
  CHECK_MESSAGE(contains(reason, "the table of moduli has ended"), reason);
}

}  // namespace bowstring
