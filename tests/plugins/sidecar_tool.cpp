#include <sys/wait.h>

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "plugins/host/library.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::fixture_library;
using testing::replaced;
using testing::TemporaryFolder;

namespace {

struct Outcome {
  int exit_code = -1;
  std::string text;
  bool written = false;
};

Outcome run_tool(const std::string& library) {
  TemporaryFolder folder;
  const std::string output = folder.path() + "/out.bowstring.json";
  const std::string command = std::string(std::getenv("BOWSTRING_BUILD_ROOT")) +
                              "/plugins/sidecar/bowstring-sidecar '" + library + "' '" + output + "' 2>&1";
  Outcome outcome;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) outcome.text.push_back(static_cast<char>(c));
  const int status = ::pclose(pipe);
  REQUIRE(WIFEXITED(status));
  outcome.exit_code = WEXITSTATUS(status);
  outcome.text = replaced(replaced(outcome.text, testing::fixture_folder(), "DIR"), host_abi_tag(), "TAG");
  outcome.written = std::filesystem::exists(output);
  return outcome;
}

Outcome refused(const std::string& fixture) {
  const Outcome outcome = run_tool(fixture_library(fixture));
  CHECK(outcome.exit_code == 3);
  CHECK_FALSE(outcome.written);
  return outcome;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the sidecar tool writes the sidecar of a good plugin") {
  const Outcome outcome = run_tool(fixture_library("every-kind"));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.text == "");
  CHECK(outcome.written);
}

TEST_CASE("the build gate: one exported symbol") {
  const std::string text = refused("two-symbols").text;
  CHECK(contains(text,
                 "plugin library 'DIR/bowstring_two-symbols.so' is refused: a plugin exports the one symbol "
                 "bowstring_plugin; compile with -fvisibility=hidden and link with the SDK's plugin.map; it "
                 "exports"));
  CHECK(contains(text, "\n  bowstring_plugin\n"));
  CHECK(contains(text, "\n  leaked_helper\n"));
}

#if defined(__clang__)
constexpr bool makes_unique_symbols = false;
#else
constexpr bool makes_unique_symbols = true;
#endif

TEST_CASE("the build gate: no GNU_UNIQUE symbol" * doctest::skip(!makes_unique_symbols)) {
  const std::string text = refused("unique-symbol").text;
  CHECK(contains(text,
                 "is refused: it has GNU_UNIQUE symbols, which all plugins of a process share; compile with "
                 "-fno-gnu-unique and link with the SDK's plugin.map:\n  _ZN6SharedIiE5valueE\n"));
}

TEST_CASE("the sidecar tool refuses what the host could not open") {
  CHECK(contains(refused("foreign-abi").text,
                 "plugin library 'DIR/bowstring_foreign-abi.so' was built for another ABI: section .bowstring.abi says "
                 "'bowstring-999/gxx-abi-1017/libstdc++-cxx11/double', this bowstring is 'TAG'; rebuild it"));
  CHECK(contains(refused("no-descriptor").text,
                 "a plugin exports the one symbol bowstring_plugin; compile with "
                 "-fvisibility=hidden and link with the SDK's plugin.map; it exports none"));
  CHECK(contains(refused("wrong-magic").text,
                 "'DIR/bowstring_wrong-magic.so' exports a 'bowstring_plugin' that is no "
                 "plugin descriptor of this bowstring; rebuild it"));
  CHECK(contains(refused("unresolved").text,
                 "plugin library 'DIR/bowstring_unresolved.so' cannot be opened: undefined "
                 "symbol: missing_function; rebuild it"));
  CHECK(contains(refused("bad-name").text,
                 "offers a component whose name 'Wire_Bending' is not lower-case words joined "
                 "by hyphens; mend its line in BOWSTRING_PLUGIN"));
}

TEST_CASE("the sidecar tool refuses a file that is not a library") {
  TemporaryFolder folder;
  const Outcome outcome = run_tool(folder.write("notes.so", "dear diary"));
  CHECK(outcome.exit_code == 3);
  CHECK_FALSE(outcome.written);
  CHECK(replaced(outcome.text, folder.path(), "DIR") ==
        "bowstring-sidecar: 'DIR/notes.so' is not a plugin library: it is not an ELF file; expected a shared library "
        "whose source ends with BOWSTRING_PLUGIN\n");
}

}  // namespace bowstring
