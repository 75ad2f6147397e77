#include "core/transport/transport_comparison.hpp"

#include <doctest/doctest.h>

#include "plugins/host/plugin_host.hpp"

using namespace bowstring;

TEST_CASE("unknown names and settings are told, with the nearest ones") {
  PluginHost plugins;
  Refusal refusal;
  CHECK_FALSE(TransportComparison::open({"exakt", "euclidian", {}}, plugins, refusal));
  CHECK(refusal.errors.size() == 2);
  CHECK(refusal.text().find("unknown ground-cost 'euclidian'") != std::string::npos);
  CHECK(refusal.text().find("did you mean 'euclidean'?") != std::string::npos);
}
