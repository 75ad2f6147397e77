#include "frames.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "plugins/host/plugin_host.hpp"

namespace ground_cost_test {
namespace {

TransportComparison open(const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings) {
  static PluginHost plugins;
  TransportRequest request;
  request.cost = name;
  for (const auto& [key, value] : settings) request.settings.push_back({key, value, "", ""});
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open(request, plugins, refusal);
  REQUIRE_MESSAGE(out, refusal.text());
  return std::move(*out);
}

}  // namespace

OpenCost::OpenCost(const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings)
    : transport_(open(name, settings)) {}

double OpenCost::operator()(const Se3& g, const Se3& h) const {
  const std::vector<int> pair{0, 0};
  std::vector<double> value(1);
  const Status status = transport_.ground_cost().evaluate(measure_of({g}), measure_of({h}), pair, value, {});
  REQUIRE_MESSAGE(status.ok(), status.text);
  return value[0];
}

Vector<6> OpenCost::gradient(const Se3& g, const Se3& h) const {
  const std::vector<int> pair{0, 0};
  std::vector<double> value(1), gradient(6);
  const Status status = transport_.ground_cost().evaluate(measure_of({g}), measure_of({h}), pair, value, gradient);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return Vector<6>::load(gradient.data());
}

Measure measure_of(const std::vector<Se3>& frames) {
  Measure out;
  for (const Se3& g : frames) {
    for (int k = 0; k < 3; ++k) out.position.push_back(g.position[k]);
    out.orientation.insert(out.orientation.end(), {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z});
    out.weight.push_back(1.0 / static_cast<double>(frames.size()));
  }
  return out;
}

double Random::uniform() {
  state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
  return (static_cast<double>(state_ >> 11) + 0.5) / 9007199254740992.0;
}

double Random::normal() {
  double sum = -6.0;
  for (int k = 0; k < 12; ++k) sum += uniform();
  return sum;
}

Twist Random::twist() {
  Twist out;
  for (int k = 0; k < 6; ++k) out[k] = normal();
  return out;
}

Se3 Random::frame(double size) {
  lie::Rotation q{normal(), normal(), normal(), normal()};
  const Vector3 position{{2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0}};
  return {q.normalized(), size * position};
}

Twist Random::dilated(double size) {
  Twist out = size * twist();
  out[4] *= size;
  out[5] *= size;
  return out;
}

int repeats(int few, int usual, int all) {
  if (std::getenv("BOWSTRING_TEST_SHORT") != nullptr) return few;
  return std::getenv("BOWSTRING_TEST_FULL") != nullptr ? all : usual;
}

}  // namespace ground_cost_test
