#include "tests/benchmarks/bench_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "core/model/manifold.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::benchmarks {

namespace {

constexpr double small_turn = 0.02;     // rad
constexpr double small_stretch = 0.01;  // of an edge
constexpr double away = 0.5;            // mm: of the wire from the centerline
constexpr double along = 0.3;           // of an edge: of the wire along the centerline
constexpr double unevenness = 0.02;     // of an edge

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr)
    throw std::runtime_error(std::string(name) + " has to be set: run the benchmarks by ./dev bench");
  return value;
}

PluginHost& plugin_host() {
  static PluginHost host([] {
    PluginHostOptions options;
    options.executable_path = variable("BOWSTRING_BUILD_ROOT") + "/bowstring";
    return options;
  }());
  return host;
}

void require(const std::vector<InputError>& errors, const Status& status) {
  std::string text = status.text;
  for (const InputError& error : errors) text += "\n" + error.text();
  if (!errors.empty() || !status.ok()) throw std::runtime_error(text);
}

bool composed(const Terms& terms, const std::string& label) {
  if (label == "wire-bending") return terms.wire_bending;
  if (label == "vessel-strain") return terms.vessel_strain;
  if (label == "anchoring") return terms.anchoring;
  if (label == "axial-tension") return terms.axial_tension;
  throw std::runtime_error("the benchmark knows no energy '" + label + "'");
}

/// Every unknown a little off its start, and the wire's nodes beside the centerline, where contact rows have something
/// to search. At every mesh edges keep their directions nearly.
std::vector<double> state_near_start(const BenchScene& bench, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Assembly& assembly = *bench.assembly;
  const std::vector<double> start = bench.scene->start_coordinates();
  const double edge = bench.vessel().edge_length.front();
  std::vector<double> delta(at(assembly.unknowns()), 0.0);
  for (const FieldEntry& entry : assembly.entries()) {
    if (entry.block < 0) continue;
    double scale = small_turn;
    if (entry.manifold == Manifold::vector) scale = unevenness * edge;
    if (entry.manifold == Manifold::real) scale = small_stretch * start[at(entry.coordinate)];
    for (int u = assembly.blocks().begin[at(entry.block)]; u < assembly.blocks().begin[at(entry.block) + 1]; ++u) {
      delta[at(u)] = scale * uniform(random);
    }
  }
  std::vector<double> q(start.size());
  assembly.retract(start, delta, q);

  const int d = bench.scene->dimension;
  const double* vessel = start.data() + field_place(bench.vessel(), "position").coordinate;
  double* wire = q.data() + field_place(bench.wire(), "position").coordinate;
  for (int i = 1; i < bench.wire().view.nodes - 1; ++i) {
    double tangent[3] = {}, length = 0.0;
    for (int k = 0; k < d; ++k) {
      tangent[k] = vessel[(i + 1) * d + k] - vessel[(i - 1) * d + k];
      length += tangent[k] * tangent[k];
    }
    const double shift = along * edge * uniform(random) / std::sqrt(length);
    const double aside = away * std::sin(M_PI * i / (bench.wire().view.nodes - 1)) / std::hypot(tangent[0], tangent[1]);
    wire[i * d] += shift * tangent[0] - aside * tangent[1];
    wire[i * d + 1] += shift * tangent[1] + aside * tangent[0];
    if (d == 3) wire[i * d + 2] += shift * tangent[2];
  }
  return q;
}

}  // namespace

std::unique_ptr<BenchScene> make_bench_scene(const SceneChoice& choice) {
  CompositionRequest request;
  request.file = variable("BOWSTRING_SOURCE_ROOT") + "/scenes/" + choice.file;
  request.overrides = {{"vessel.iliac.geometry.nodes", std::to_string(choice.nodes)},
                       {"vessel.iliac.kinematics", choice.kinematics},
                       {"wire.lunderquist.kinematics", choice.kinematics},
                       {"constraint.lumen.window", "2"}};
  CompositionOutcome loaded = load_composition(request, plugin_host());
  require(loaded.errors, loaded.plugin_failure);
  auto bench = std::make_unique<BenchScene>();
  bench->composition = std::make_unique<Composition>(std::move(*loaded.composition));
  SceneOutcome built = build_scene(*bench->composition, SolverTraits{});
  require(built.errors, built.plugin_failure);
  bench->scene = std::move(built.scene);
  // The kinematics have been declared for the whole scene and stay what they are.
  std::vector<EnergyUse>& energies = bench->scene->energies;
  energies.erase(std::remove_if(energies.begin(), energies.end(),
                                [&](const EnergyUse& energy) { return !composed(choice.terms, energy.label); }),
                 energies.end());
  if (!choice.terms.contact) bench->scene->constraints.clear();
  bench->assembly = std::make_unique<Assembly>(*bench->scene);
  for (unsigned k = 0; k < 2; ++k) bench->state[k] = state_near_start(*bench, k + 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  bench->multipliers.resize(at(bench->assembly->rows()));
  for (double& multiplier : bench->multipliers) multiplier = uniform(random);
  return bench;
}

FieldPlace field_place(const Curve& curve, const std::string& name) {
  FieldPlace place{curve.coordinate_begin, curve.unknown_begin};
  for (const FieldDeclaration& field : curve.declaration.fields) {
    if (field.name == name) return place;
    place.coordinate += field.count * coordinate_count(field.manifold, field.dimension);
    place.unknown += field.count * tangent_count(field.manifold, field.dimension);
  }
  return {};
}

}  // namespace bowstring::benchmarks
