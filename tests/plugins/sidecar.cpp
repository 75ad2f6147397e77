#include "plugins/host/sidecar.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::replaced;
using testing::TemporaryFolder;

TEST_CASE("a sidecar reads as it was written, and its library lies beside it") {
  TemporaryFolder folder;
  const std::string file = folder.path() + "/fancy.bowstring.json";
  const Sidecar written{folder.path() + "/bowstring_fancy.so",
                        7,
                        "a/b/c",
                        {{Kind::ground_cost, "fancy", "with \"quotes\" and κ²"}, {Kind::energy, "fancy", ""}}};
  REQUIRE(write_sidecar(written, file).ok());
  Sidecar read;
  REQUIRE(read_sidecar(file, read).ok());
  CHECK(read.library == written.library);
  CHECK(read.interface_version == 7);
  CHECK(read.abi_tag == "a/b/c");
  CHECK(read.components == written.components);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a sidecar that cannot be used is named with the reason") {
  TemporaryFolder folder;
  const auto text = [&](std::string_view content) {
    const std::string file = folder.write("x.bowstring.json", content);
    Sidecar sidecar;
    return replaced(read_sidecar(file, sidecar).text, folder.path(), "DIR");
  };
  CHECK(text("{").find("plugin sidecar 'DIR/x.bowstring.json' is of no use: ") == 0);
  CHECK(text("{").find("parse error") != std::string::npos);
  CHECK(text("{}").find("'file'") != std::string::npos);
  CHECK(text(R"({"file": "a.so", "interface_version": 1, "abi_tag": "", "components": [{"kind": "enrgy"}]})") ==
        "plugin sidecar 'DIR/x.bowstring.json' is of no use: it names an unknown kind 'enrgy'; the build writes it: "
        "run ninja again, or install the plugin again");
}

TEST_CASE("every kind is called by its name") {
  for (int i = 0; i < kind_count; ++i) {
    const Kind kind = static_cast<Kind>(i);
    CHECK(kind_called(kind_name(kind)) == kind);
  }
  CHECK(kind_called("ground_cost") == std::nullopt);
}

}  // namespace bowstring
