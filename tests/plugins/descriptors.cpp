#include <doctest/doctest.h>

#include "plugins/host/library.hpp"
#include "plugins/sdk/abi_tag.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

TEST_CASE("the ABI tag says interface version, compiler ABI, standard library and scalar") {
  const std::string tag = host_abi_tag();
  CHECK(tag.find("bowstring-" + std::to_string(interface_version) + "/gxx-abi-") == 0);
  CHECK(tag.find("/lib") != std::string::npos);
  CHECK(tag.substr(tag.size() - 7) == "/double");
}

TEST_CASE("an open library's descriptor is handed out as it is") {
  const PluginDescriptor* plugin = nullptr;
  REQUIRE(open_library(testing::fixture_library("every-kind"), &plugin).ok());
  CHECK(plugin->component_count == kind_count);
  const std::vector<OfferedComponent> offered = offered_components(*plugin);
  REQUIRE(offered.size() == kind_count);
  CHECK(offered[0] == OfferedComponent{Kind::geometry, "test-segment", "A straight segment"});
}

TEST_CASE("a library without descriptor is refused after opening") {
  const PluginDescriptor* plugin = nullptr;
  const std::string library = testing::fixture_library("no-descriptor");
  CHECK(open_library(library, &plugin).text ==
        "'" + library +
            "' is not a plugin library: it exports no symbol 'bowstring_plugin'; expected a shared library "
            "whose source ends with BOWSTRING_PLUGIN");
  CHECK(plugin == nullptr);
}

}  // namespace bowstring
