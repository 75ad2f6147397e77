#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "core/session/session.hpp"
#include "plugins/host/plugin_host.hpp"
#include "tests/apps/command.hpp"

namespace bowstring {

namespace {

/// Plugin libraries that this process has mapped, by its own list of mappings.
std::set<std::string> open_plugins() {
  std::set<std::string> files;
  std::ifstream maps("/proc/self/maps");
  REQUIRE(maps);
  for (std::string line; std::getline(maps, line);) {
    const std::size_t name = line.find("/bowstring_");
    if (name == std::string::npos || line.find(".so", name) == std::string::npos) continue;
    files.insert(line.substr(line.find('/')));
  }
  return files;
}

}  // namespace

// The only test of this executable that opens plugins in its own process: an open library stays open.
TEST_CASE("the plugins that a composition names are open in the process, and no others") {
  REQUIRE(open_plugins().empty());
  const std::string build = std::getenv("BOWSTRING_BUILD_ROOT");
  PluginHostOptions options;
  options.executable_path = build + "/bowstring";
  PluginHost host(options);
  CHECK(host.names(Kind::energy).size() >= 5);
  CHECK(open_plugins().empty());

  CompositionRequest request;
  request.file = testing::source_root() + "/scenes/planar-iliac.toml";
  Refusal refusal;
  const auto session = prepare(request, host, refusal);
  REQUIRE(session != nullptr);
  std::set<std::string> named;
  const std::pair<Kind, const char*> components[] = {
      {Kind::geometry, "sinusoid"},   {Kind::kinematics, "edge-frames"},
      {Kind::energy, "wire-bending"}, {Kind::energy, "vessel-strain"},
      {Kind::energy, "anchoring"},    {Kind::energy, "axial-tension"},
      {Kind::enforcement, "kkt"},     {Kind::constraint, "node-wise-contact"},
      {Kind::solver, "ipopt"},
  };
  for (const auto& [kind, name] : components) named.insert(host.origin(kind, name).file);
  CHECK(open_plugins() == named);

  CHECK(solve(*session, [](const IterationRecord&) { return true; }).certificate.verdict == Verdict::converged);
  CHECK(open_plugins() == named);
}

}  // namespace bowstring
