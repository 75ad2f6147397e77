#include "tests/simulation/scenes.hpp"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace bowstring::testing {

namespace {

std::string timeless(const std::string& document) {
  nlohmann::ordered_json out = nlohmann::ordered_json::parse(document);
  if (out["energy"]["total"].get<double>() == 0.0) throw std::runtime_error("the energy is 0: an empty comparison");
  out["solver"].erase("seconds");
  return out.dump(1);
}

}  // namespace

std::string scene_file(const std::string& name) {
  return std::string(std::getenv("BOWSTRING_SOURCE_ROOT")) + "/scenes/" + name;
}

Simulation small_planar() {
  Simulation out = Simulation::from_file(scene_file("planar-iliac-smooth.toml"));
  out.set("vessel.iliac.geometry.nodes", 24);
  return out;
}

PluginHost& plugins() {
  static PluginHost host;
  return host;
}

std::string difference(const std::string& document, const std::string& other) {
  std::istringstream one(timeless(document)), two(timeless(other));
  for (std::string a, b; one || two;) {
    a = b = "(end)";
    std::getline(one, a);
    std::getline(two, b);
    if (a != b) return a + "\nis not\n" + b;
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace bowstring::testing
