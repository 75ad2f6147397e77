#include "plugins/host/plugin_host.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/interfaces/comparison.hpp"
#include "plugins/host/library.hpp"
#include "core/composition/sha256.hpp"
#include "plugins/host/elf.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::fixture_folder;
using testing::fixture_library;
using testing::is_open;
using testing::replaced;
using testing::TemporaryFolder;

namespace {

/// A host that sees these folders alone.
PluginHostOptions only(std::vector<std::string> folders) {
  PluginHostOptions options;
  options.command_line_path = std::move(folders);
  options.executable_path = "";
  return options;
}

Status status_of(PluginHost& host, Kind kind, const std::string& name) {
  Status status;
  const ComponentDescriptor* component = host.find(kind, name, status);
  CHECK((component == nullptr) == !status.ok());
  return status;
}

/// The text of a refusal with code `failed`, the folder's path replaced.
std::string failure(const TemporaryFolder& folder, Kind kind, const std::string& name) {
  PluginHost host(only({folder.path()}));
  const Status status = status_of(host, kind, name);
  CHECK(status.code == Code::failed);
  return replaced(replaced(status.text, folder.path(), "DIR"), host_abi_tag(), "TAG");
}

std::vector<double> numbers_of(PluginHost& host, const std::string& readout) {
  Status status;
  const ComponentDescriptor* component = host.find(Kind::readout, readout, status);
  REQUIRE_MESSAGE(component != nullptr, status.text);
  void* raw = nullptr;
  REQUIRE(component->create({}, &raw).ok());
  const std::unique_ptr<Readout, Destructor> object(static_cast<Readout*>(raw), component->destroy);
  std::vector<std::string> names;
  std::vector<double> values;
  REQUIRE(object->read("", names, values).ok());
  return values;
}

}  // namespace

// First, since a library that is once open stays so.
TEST_CASE("only the library of the named component is opened") {
  TemporaryFolder folder;
  folder.take_fixture("twin-one");
  folder.take_fixture("twin-two");
  PluginHost host(only({folder.path()}));
  CHECK(host.names(Kind::readout) == std::vector<std::string>{"test-twin-one", "test-twin-two"});
  CHECK(host.description(Kind::readout, "test-twin-one") == "Its own constants");
  CHECK_FALSE(host.origin(Kind::readout, "test-twin-one").sha256.empty());
  CHECK_FALSE(is_open(folder.path() + "/bowstring_twin-one.so"));

  CHECK(status_of(host, Kind::readout, "test-twin-one").ok());
  CHECK(is_open(folder.path() + "/bowstring_twin-one.so"));
  CHECK_FALSE(is_open(folder.path() + "/bowstring_twin-two.so"));
}

TEST_CASE("a library stays open when its host is gone") {
  TemporaryFolder folder;
  folder.take_fixture("twin-one");
  { CHECK(numbers_of(*std::make_unique<PluginHost>(only({folder.path()})), "test-twin-one").size() == 3); }
  CHECK(is_open(folder.path() + "/bowstring_twin-one.so"));
}

TEST_CASE("plugins from copied sources keep their own variables") {
  PluginHost host(only({fixture_folder()}));
  CHECK(numbers_of(host, "test-twin-one") == std::vector<double>{1, 11, 100});
  CHECK(numbers_of(host, "test-twin-two") == std::vector<double>{2, 21, 200});
  CHECK(numbers_of(host, "test-twin-one") == std::vector<double>{1, 12, 100});
}

TEST_CASE("the origin of a component is its file, hash and tag") {
  PluginHost host(only({fixture_folder()}));
  const ComponentOrigin origin = host.origin(Kind::energy, "test-springs");
  CHECK(origin.file == fixture_library("every-kind"));
  CHECK(origin.abi_tag == host_abi_tag());
  std::string bytes;
  REQUIRE(read_bytes(origin.file, bytes).ok());
  CHECK(origin.sha256 == sha256_hex(bytes));
  CHECK(host.origin(Kind::energy, "nobody").file == "");
}

TEST_CASE("a name that nobody offers is answered with the nearest") {
  TemporaryFolder folder;
  folder.take_fixture("every-kind");
  PluginHost host(only({folder.path()}));
  Status status = status_of(host, Kind::energy, "test-spring");
  CHECK(status.code == Code::invalid_input);
  CHECK(status.text ==
        "no plugin offers energy 'test-spring'; expected one of: test-springs; did you mean 'test-springs'?");
  status = status_of(host, Kind::energy, "test-floor");
  CHECK(status.code == Code::invalid_input);
  CHECK(status.text ==
        "no plugin offers energy 'test-floor'; expected one of: test-springs; there is constraint 'test-floor'");
}

TEST_CASE("without any plugin the search path is named") {
  TemporaryFolder folder;
  PluginHost empty(only({folder.path()}));
  CHECK(replaced(status_of(empty, Kind::solver, "ipopt").text, folder.path(), "DIR") ==
        "no plugin offers solver 'ipopt'; no solver was found at all in DIR; name the folder of the plugins with "
        "--plugin-path or BOWSTRING_PLUGIN_PATH");
  PluginHost nowhere(only({}));
  CHECK(status_of(nowhere, Kind::solver, "ipopt").text.find("found at all in an empty search path") !=
        std::string::npos);
  PluginHost missing(only({folder.path() + "/no"}));
  CHECK(replaced(status_of(missing, Kind::solver, "ipopt").text, folder.path(), "DIR")
            .find("; note that plugin folder 'DIR/no' cannot be searched: No such file or directory") !=
        std::string::npos);
}

TEST_CASE("the working directory is not searched") {
  TemporaryFolder folder;
  folder.take_fixture("every-kind");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  PluginHostOptions options = only({});
  options.environment_path = "::";
  const std::vector<std::string> names = PluginHost(options).names(Kind::energy);
  std::filesystem::current_path(before);
  CHECK(names.empty());
}

TEST_CASE("every part of the search path counts, and one file found twice is one plugin") {
  TemporaryFolder one, two, three;
  one.take_fixture("twin-one");
  two.take_fixture("twin-two");
  three.take_fixture("every-kind");
  PluginHostOptions options = only({one.path(), one.path() + "/../" + one.path().substr(one.path().rfind('/') + 1)});
  options.composition_path = {two.path()};
  options.environment_path = three.path() + ":" + one.path();
  PluginHost host(options);
  CHECK(host.problems().empty());
  CHECK(host.names(Kind::readout) ==
        std::vector<std::string>{"test-document-length", "test-twin-one", "test-twin-two"});
}

TEST_CASE("two libraries of one name are an error that names both") {
  TemporaryFolder one, two;
  one.take_fixture("every-kind");
  two.take_fixture("every-kind");
  PluginHost host(only({one.path(), two.path()}));
  const Status status = status_of(host, Kind::loss, "test-mean-squared-distance");
  CHECK(status.code == Code::failed);
  CHECK(replaced(replaced(status.text, one.path(), "ONE"), two.path(), "TWO") ==
        "loss 'test-mean-squared-distance' is offered by 'ONE/bowstring_every-kind.so' and "
        "'TWO/bowstring_every-kind.so'; remove one of them from the plugin path, or rename its component");
  CHECK_FALSE(is_open(one.path() + "/bowstring_every-kind.so"));
  CHECK(host.problems().size() == kind_count);
}

TEST_CASE("another ABI is refused unopened, by its sidecar or by its file") {
  TemporaryFolder folder;
  folder.take_fixture("foreign-abi");
  const std::string advice =
      "rebuild it against this bowstring with the compiler and standard library of that tag, or take the bowstring "
      "that "
      "it was built for";
  folder.write_sidecar("bowstring_foreign-abi.so", "residual", "test-foreign", "bowstring-999/other");
  CHECK(failure(folder, Kind::residual, "test-foreign") ==
        "plugin library 'DIR/bowstring_foreign-abi.so' was built for another ABI: its sidecar says "
        "'bowstring-999/other', this bowstring is 'TAG'; " +
            advice);
  folder.write_sidecar("bowstring_foreign-abi.so", "residual", "test-foreign", host_abi_tag());
  CHECK(failure(folder, Kind::residual, "test-foreign") ==
        "plugin library 'DIR/bowstring_foreign-abi.so' was built for another ABI: section .bowstring.abi says "
        "'bowstring-999/gxx-abi-1017/libstdc++-cxx11/double', this bowstring is 'TAG'; " +
            advice);
  CHECK_FALSE(is_open(folder.path() + "/bowstring_foreign-abi.so"));
}

TEST_CASE("a file that is not a plugin is refused in words") {
  TemporaryFolder folder;
  const std::string expectation = "; expected a shared library whose source ends with BOWSTRING_PLUGIN";
  folder.write("notes.so", "dear diary");
  folder.write_sidecar("notes.so", "writer", "test-notes", host_abi_tag());
  CHECK(failure(folder, Kind::writer, "test-notes") ==
        "'DIR/notes.so' is not a plugin library: it is not an ELF file" + expectation);
  folder.write_sidecar("gone.so", "writer", "test-gone", host_abi_tag());
  CHECK(failure(folder, Kind::writer, "test-gone") ==
        "'DIR/gone.so' is not a plugin library: it cannot be read: No such file or directory" + expectation);
  folder.take_fixture("no-descriptor");
  folder.write_sidecar("bowstring_no-descriptor.so", "writer", "test-none", host_abi_tag());
  CHECK(failure(folder, Kind::writer, "test-none") ==
        "'DIR/bowstring_no-descriptor.so' is not a plugin library: it exports no symbol 'bowstring_plugin'" +
            expectation);
}

TEST_CASE("a library that cannot be opened is refused with the loader's reason alone") {
  TemporaryFolder folder;
  folder.take_fixture("unresolved");
  folder.write_sidecar("bowstring_unresolved.so", "residual", "test-unresolved", host_abi_tag());
  CHECK(
      failure(folder, Kind::residual, "test-unresolved") ==
      "plugin library 'DIR/bowstring_unresolved.so' cannot be opened: undefined symbol: missing_function; rebuild it, "
      "and install the libraries that it needs (ldd names them)");
}

TEST_CASE("a sidecar that does not fit its library is refused") {
  TemporaryFolder folder;
  folder.take_fixture("twin-one");
  std::filesystem::remove(folder.path() + "/twin-one.bowstring.json");
  folder.write_sidecar("bowstring_twin-one.so", "readout", "test-twin-three", host_abi_tag());
  CHECK(failure(folder, Kind::readout, "test-twin-three") ==
        "plugin library 'DIR/bowstring_twin-one.so' is not what its sidecar 'DIR/test-twin-three.bowstring.json' says; "
        "write the sidecar again with ninja or bowstring-sidecar, or install the two together");
}

TEST_CASE("a broken sidecar stops nobody else, and is remembered") {
  TemporaryFolder folder;
  folder.take_fixture("every-kind");
  folder.write("broken.bowstring.json", "{\"file\": ");
  PluginHost host(only({folder.path()}));
  CHECK(status_of(host, Kind::energy, "test-springs").ok());
  REQUIRE(host.problems().size() == 1);
  CHECK(host.problems()[0].find("broken.bowstring.json' is of no use: ") != std::string::npos);
  CHECK(status_of(host, Kind::energy, "broken").text.find("; note that plugin sidecar '") != std::string::npos);
}

TEST_CASE("the plugins beside the binary are found by its list, and what was not built is named") {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() + "/plugins");
  for (const char* file : {"bowstring_every-kind.so", "every-kind.bowstring.json"}) {
    std::filesystem::copy(fixture_folder() + "/" + file, folder.path() + "/plugins");
  }
  folder.write("bowstring-plugins.json",
               R"({"sidecars": ["plugins/every-kind.bowstring.json"],
                   "not_built": [{"kind": "solver", "name": "ipopt", "option": "ipopt", "package": "coinor-libipopt-dev"}]})");
  PluginHostOptions options = only({});
  options.executable_path = folder.path() + "/bowstring";
  PluginHost host(options);
  CHECK(status_of(host, Kind::energy, "test-springs").ok());
  const Status status = status_of(host, Kind::solver, "ipopt");
  CHECK(status.code == Code::failed);
  CHECK(status.text ==
        "plugin solver/ipopt is known but was not built; install coinor-libipopt-dev and configure the "
        "build with -Dipopt=enabled");
}

TEST_CASE("this build's own plugins are found from its binary") {
  PluginHostOptions options = only({});
  options.executable_path = std::string(std::getenv("BOWSTRING_BUILD_ROOT")) + "/bowstring";
  PluginHost host(options);
  CHECK(host.problems().empty());
  const std::vector<std::string> energies = host.names(Kind::energy);
  CHECK(std::count(energies.begin(), energies.end(), "wire-bending") == 1);
  CHECK(status_of(host, Kind::energy, "wire-bending").ok());
}

TEST_CASE("what a factory throws becomes a status") {
  PluginHost host(only({fixture_folder()}));
  const auto create = [&](const std::string& name) {
    Status status;
    const ComponentDescriptor* component = host.find(Kind::writer, name, status);
    REQUIRE_MESSAGE(component != nullptr, status.text);
    void* raw = nullptr;
    status = component->create({}, &raw);
    CHECK(raw == nullptr);
    return status;
  };
  CHECK(create("test-throws-runtime-error").code == Code::failed);
  CHECK(create("test-throws-runtime-error").text == "the ink is dry");
  CHECK(create("test-throws-invalid-input").code == Code::invalid_input);
  CHECK(create("test-throws-invalid-input").text == "'ink' is 3; expected 0 to 1");
  CHECK(create("test-throws-number").text == "an exception that is no std::exception was thrown");
  CHECK(create("test-throws-unknown-key").text.find("'inkk'") != std::string::npos);
}

}  // namespace bowstring
