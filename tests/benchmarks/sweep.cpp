// Time per point of a sweep in process, each point from the one before, and of the same points by Ipopt from where the
// composition starts: as a Markdown table.
//
//   benchmark-sweep [POINTS [REPETITIONS [NODES]]]   100, 5, 80

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/simulation/prepared_simulation.hpp"
#include "core/simulation/simulation_data.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::benchmarks {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double softest = 65.0, stiffest = 6132.0;  // N mm^2, of the wire, in equal ratios
constexpr double same_energy = 1e-6;                 // relative
constexpr const char* stiffness = "energy.wire-bending.bending-stiffness";

struct Variant {
  const char* solver;
  bool warm;
};
constexpr Variant variants[] = {
    {"active-set", true}, {"active-set", false}, {"interior-point", false}, {"ipopt", false}};
constexpr int reference = 3;  // of the variants: what the others are compared with

/// Per point.
struct Figures {
  double point = 0.0, solver = 0.0, certificate = 0.0;  ///< ms
  double iterations = 0.0;
  int converged = 0;
  std::vector<double> energies;
};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr)
    throw std::runtime_error(std::string(name) + " has to be set: run the benchmarks by ./dev bench");
  return value;
}

double milliseconds(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

Figures sweep(PreparedSimulation& simulation, bool warm, int points) {
  Figures out;
  // Whatever was solved before, the first point starts where the composition does.
  simulation.set(stiffness, softest, "N mm^2");
  if (const SimulationResult first = simulation.solve_afresh(); !first.ok()) {
    throw std::runtime_error(first.refusal().text());
  }
  for (int i = 0; i < points; ++i) {
    const double value = softest * std::pow(stiffest / softest, i / std::max(1.0, points - 1.0));
    const auto begin = Clock::now();
    simulation.set(stiffness, value, "N mm^2");
    const SimulationResult result = warm ? simulation.solve() : simulation.solve_afresh();
    const Found<double> peak = result.number("quantities.peak_displacement_mm");
    out.point += milliseconds(begin) / points;
    if (!peak.ok()) throw std::runtime_error(peak.error);
    const SimulationData& data = result.data();
    out.solver += 1e3 * data.state().session.seconds.solve / points;
    out.certificate += 1e3 * data.state().session.seconds.certificate / points;
    out.iterations += static_cast<double>(data.state().solution.solver.iterations) / points;
    out.converged += result.converged() ? 1 : 0;
    out.energies.push_back(result.number("energy.total").value);
  }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Part>
double median_of(const std::vector<Figures>& sweeps, const Part& part) {
  std::vector<double> values;
  for (const Figures& one : sweeps) values.push_back(part(one));
  return median(values);
}

/// Points with the energy of the reference.
int agreeing(const Figures& one, const Figures& other) {
  int count = 0;
  for (std::size_t i = 0; i < one.energies.size(); ++i) {
    count += std::fabs(one.energies[i] - other.energies[i]) <= same_energy * std::fabs(other.energies[i]) ? 1 : 0;
  }
  return count;
}

void run(int points, int repetitions, int nodes) {
  PluginHostOptions options;
  options.executable_path = variable("BOWSTRING_BUILD_ROOT") + "/bowstring";
  PluginHost plugins(options);
  Simulation planar = Simulation::from_file(variable("BOWSTRING_SOURCE_ROOT") + "/tests/grid/planar.toml");
  planar.set("vessel.iliac.geometry.nodes", nodes);
  planar.set("solver.tolerance", 1e-8);

  std::vector<PreparedSimulation> prepared;
  std::vector<std::vector<Figures>> told(std::size(variants));
  for (const Variant& variant : variants) {
    Simulation simulation = planar;
    simulation.set("solver.type", std::string(variant.solver));
    prepared.push_back(simulation.prepared(plugins));
  }
  // In turns, so that what else the machine does meets all alike.
  for (int k = 0; k < repetitions; ++k) {
    for (std::size_t v = 0; v < std::size(variants); ++v) {
      told[v].push_back(sweep(prepared[v], variants[v].warm, points));
    }
  }
  std::printf("planar iliac, N = %d, %d bending stiffnesses of the wire, %g to %g N mm^2\n\n", nodes, points, softest,
              stiffest);
  std::puts(
      "| solver | start | converged | energy as the reference | iterations | point, ms | of which solver |"
      " of which certificate | rest | the reference's point over this |");
  std::puts("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  const double compared = median_of(told[reference], [](const Figures& one) { return one.point; });
  for (std::size_t v = 0; v < std::size(variants); ++v) {
    const std::vector<Figures>& sweeps = told[v];
    const double point = median_of(sweeps, [](const Figures& one) { return one.point; });
    std::printf("| %s | %s | %d | %d | %.3g | %.3f | %.3f | %.3f | %.3f | %.3g |\n", variants[v].solver,
                variants[v].warm ? "point before" : "cold", sweeps[0].converged,
                agreeing(sweeps[0], told[reference][0]), sweeps[0].iterations, point,
                median_of(sweeps, [](const Figures& one) { return one.solver; }),
                median_of(sweeps, [](const Figures& one) { return one.certificate; }),
                median_of(sweeps, [](const Figures& one) { return one.point - one.solver - one.certificate; }),
                compared / point);
  }
}

}  // namespace

}  // namespace bowstring::benchmarks

int main(int count, char** arguments) {
  const auto argument = [&](int index, int otherwise) {
    return index < count ? std::max(1, std::atoi(arguments[index])) : otherwise;
  };
  try {
    bowstring::benchmarks::run(argument(1, 100), argument(2, 5), argument(3, 80));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
