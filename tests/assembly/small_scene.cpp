#include "tests/assembly/small_scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/curve/temporary_file.hpp"

namespace bowstring::testing {

namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  REQUIRE_MESSAGE(value != nullptr, name << " has to be set: run the tests through meson");
  return value;
}

std::unique_ptr<Session> prepared(const CompositionRequest& request, const CarriedState* carried = nullptr) {
  Refusal refusal;
  auto session = prepare(request, plugin_host(), refusal, carried);
  REQUIRE_MESSAGE(session != nullptr, refusal_text(refusal));
  return session;
}

}  // namespace

std::string SmallScene::text() const {
  const std::string s_shape = R"({ type = "sinusoid", chord = "40 mm", amplitude = "4 mm", periods = 1, nodes = 8 })";
  const std::string coil = R"({ type = "helix", chord = "40 mm", radius = "6 mm", turns = 0.6, nodes = 8 })";
  const std::string shape = !geometry.empty() ? geometry : (dimension == 2 ? s_shape : coil);
  std::string out =
      "schema = 1\n[scene]\ndimension = " + std::to_string(dimension) +
      "\n[[vessel]]\nname = \"vessel\"\ngeometry = " + shape + "\nradius = " + radius + "\nkinematics = \"" +
      vessel_kinematics + "\"\nends = " + vessel_ends +
      "\n[[wire]]\nname = \"wire\"\nvessel = \"vessel\"\nradius = \"0.4 mm\"\nnodes = " + std::to_string(wire_nodes) +
      "\nkinematics = \"" + wire_kinematics + "\"\nends = " + wire_ends +
      "\n[[energy]]\ntype = \"wire-bending\"\non = \"wire\"\nbending-stiffness = \"65 N mm^2\"\n"
      "[[energy]]\ntype = \"vessel-strain\"\non = \"vessel\"\nbending-stiffness = \"40 N mm^2\"\n"
      "stretch-stiffness = \"11 N\"\n";
  if (vessel_frames) out += "torsional-stiffness = \"25 N mm^2\"\n";
  out += "[[energy]]\ntype = \"anchoring\"\non = \"vessel\"\nstiffness = \"0.05 N/mm^2\"\n";
  if (wire_frames) {
    out +=
        "[[energy]]\nname = \"wire-torsion\"\ntype = \"vessel-strain\"\non = \"wire\"\nbending-stiffness = \"5 N "
        "mm^2\"\n"
        "torsional-stiffness = \"9 N mm^2\"\n";
  }
  if (tension) out += "[[energy]]\ntype = \"axial-tension\"\non = \"wire\"\ntension = \"3 N\"\n";
  if (!contact.empty()) {
    out += "[[constraint]]\nname = \"lumen\"\ntype = \"" + contact_type +
           "\"\non = [\"wire\", \"vessel\"]\nwindow = 20\n" + contact + "\n";
  }
  return out + "[solver]\ntype = \"ipopt\"\n";
}

PluginHost& plugin_host() {
  static PluginHost host([] {
    PluginHostOptions options;
    options.executable_path = variable("BOWSTRING_BUILD_ROOT") + "/bowstring";
    return options;
  }());
  return host;
}

std::string edited(std::string text, const std::string& word, const std::string& by) {
  const std::size_t position = text.find(word);
  REQUIRE(position != std::string::npos);
  return text.replace(position, word.size(), by);
}

std::string refusal_text(const Refusal& refusal) {
  std::string text = refusal.plugin_failure.text;
  for (const InputError& error : refusal.errors) text += (text.empty() ? "" : "\n") + error.text();
  return text;
}

std::unique_ptr<Session> session_of(const SmallScene& scene) { return session_of_text(scene.text()); }

std::unique_ptr<Session> session_of_text(const std::string& text, const CarriedState* carried) {
  const TemporaryFile file(text);
  CompositionRequest request;
  request.file = file.path();
  return prepared(request, carried);
}

std::string refusal_of(const std::string& text, const CarriedState* carried) {
  const TemporaryFile file(text);
  CompositionRequest request;
  request.file = file.path();
  Refusal refusal;
  REQUIRE(prepare(request, plugin_host(), refusal, carried) == nullptr);
  return refusal_text(refusal);
}

std::unique_ptr<Session> session_of_file(const std::string& name, const std::vector<Override>& overrides) {
  CompositionRequest request;
  request.file = variable("BOWSTRING_SOURCE_ROOT") + "/scenes/" + name;
  request.overrides = overrides;
  return prepared(request);
}

std::unique_ptr<Session> narrow_session(SmallScene scene) {
  scene.geometry = scene.dimension == 2
                       ? R"({ type = "sinusoid", chord = "40 mm", amplitude = "4 mm", periods = 1, nodes = 31 })"
                       : R"({ type = "helix", chord = "40 mm", radius = "6 mm", turns = 0.6, nodes = 31 })";
  scene.wire_nodes = 21;
  std::string text = scene.text();
  text.replace(text.find("window = 20"), 11, "window = 1");
  return session_of_text(text);
}

std::vector<double> random_numbers(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> out(at(count));
  for (double& number : out) number = uniform(random);
  return out;
}

double largest(const std::vector<double>& numbers) {
  double out = 0.0;
  for (const double number : numbers) out = std::max(out, std::fabs(number));
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::fabs(a[i] - b[i]));
  return out;
}

std::vector<double> moved_start(const Session& session, double amplitude, unsigned seed) {
  const Assembly& assembly = *session.assembly;
  std::vector<double> delta = random_numbers(assembly.unknowns(), seed);
  for (const FieldEntry& entry : assembly.entries()) {
    if (entry.block < 0) continue;
    const double scale = entry.manifold == Manifold::vector ? amplitude : 0.3 * amplitude;
    for (int u = assembly.blocks().begin[at(entry.block)]; u < assembly.blocks().begin[at(entry.block) + 1]; ++u) {
      delta[at(u)] *= scale;
    }
  }
  const std::vector<double> start = session.scene->start_coordinates();
  std::vector<double> q(start.size());
  assembly.retract(start, delta, q);
  return q;
}

std::vector<double> slid(const Session& session, double share) {
  std::vector<double> q = session.scene->start_coordinates();
  const Curve& wire = *session.scene->find("wire");
  const int d = session.scene->dimension;
  for (int i = 2; i + 2 < wire.view.nodes; ++i) {
    for (int k = 0; k < d; ++k) {
      const double* p = wire.start.data() + i * d + k;
      q[at(wire.coordinate_begin + i * d + k)] += share * (p[d] - p[0]);
    }
  }
  return q;
}

}  // namespace bowstring::testing
