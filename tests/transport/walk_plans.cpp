#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include <nlohmann/json.hpp>

#include "plugins/host/plugin_host.hpp"
#include "tests/transport/plan_walk.hpp"

/// Prints two walks through plan switches as JSON, for docs/make_transport_figures.py.
namespace bowstring::testing {
namespace {

nlohmann::json json_of(const std::vector<WalkPoint>& walk) {
  nlohmann::json out = nlohmann::json::array();
  for (const WalkPoint& point : walk) {
    out.push_back({{"parameter", point.parameter},
                   {"value", point.value},
                   {"before", point.one_sided.before},
                   {"after", point.one_sided.after},
                   {"reported", point.reported},
                   {"switch", point.is_switch}});
  }
  return out;
}

int print_walks() {
  PluginHost plugins;
  Refusal refusal;
  auto transport = TransportComparison::open({"exact", "euclidean", {}}, plugins, refusal);
  if (!transport) {
    std::fprintf(stderr, "%s\n", refusal.text().c_str());
    return 3;
  }
  const double pi = std::acos(-1.0);
  const MovingMeasure square = turning_square(), knot = turning_knot(24);
  const nlohmann::json out = {{"square", json_of(walk_plans(*transport, square, square.at(0.0), 0.0, pi, 240))},
                              {"knot", json_of(walk_plans(*transport, knot, knot.at(0.0), 0.0, 2.0 * pi / 3.0, 400))}};
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace bowstring::testing

int main() {
  try {
    return bowstring::testing::print_walks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
