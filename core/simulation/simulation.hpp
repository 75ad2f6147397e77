#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/registry.hpp"
#include "core/interfaces/solver.hpp"
#include "core/simulation/simulation_result.hpp"

namespace bowstring {

/// Called after each iteration of a solver, in the thread that solves; false stops it with the best point so far.
/// It must not solve anything itself.
using Progress = std::function<bool(const IterationRecord&)>;

class PreparedSimulation;

/// A composition and what is changed of it: the way to compute in process what `bowstring solve FILE --set path=value`
/// computes, with the same bits. A plain value: copy it for a variant.
///
///   bowstring::PluginHost plugins;  // plugins/host/plugin_host.hpp: those that the command finds
///   bowstring::Simulation simulation = bowstring::Simulation::from_file("scenes/planar-iliac.toml");
///   simulation.set("energy.axial-tension.tension", 12.0, "N");
///   const bowstring::SimulationResult result = simulation.solve(plugins);
///   if (!result.ok()) std::puts(result.refusal().text().c_str());
///   const double peak = result.number("quantities.peak_displacement_mm").value;
///
/// Nothing is read before `check` or `solve`, which read the files anew each time; no exception leaves these two.
/// Threads: `check` and `solve` may run in any number of threads at once, on one simulation or on several, with one
/// registry or with several, and give the bits that they give one after the other. A backend that cannot do so (Ipopt,
/// for MUMPS' sake) solves one problem at a time. As with any value, no thread may `set` what another one uses.
class Simulation {
 public:
  /// A composition file. What it names is relative to it.
  static Simulation from_file(const std::string& file);

  /// A composition as TOML text. `file` need not exist: it is what errors call the text, and what files that the text
  /// names are relative to.
  static Simulation from_text(const std::string& toml, const std::string& file = "composition.toml");

  /// Overrides one value by its path, "wire.lunderquist.radius"; later calls come after earlier ones, and replace one
  /// of the same path. `value` is TOML ("80", "[1, 0, 0]", "true"); what does not parse as TOML is a string
  /// ("12 N", "nodes"). Whether path and value fit is told by `check` and `solve`, in the words of the command's
  /// `--set`, since another call may yet make them fit. Paths of files are relative to the working directory.
  void set(const std::string& path, const std::string& value);
  /// A number, as it stands: in mm, N, rad where the parameter has a dimension.
  void set(const std::string& path, double value);
  /// A number with a unit: 12.0, "N".
  void set(const std::string& path, double value, const std::string& unit);
  template <class Flag, std::enable_if_t<std::is_same_v<Flag, bool>, int> = 0>
  void set(const std::string& path, Flag value) {
    set(path, std::string(value ? "true" : "false"));
  }

  /// Takes an override back.
  void unset(const std::string& path);

  /// The folders that the composition's `plugin-path` names, absolute, for `plugin_search` of a PluginHost; empty
  /// where the composition cannot be read.
  std::vector<std::string> plugin_path() const;

  /// Reads, checks and builds everything, solves nothing. All that is wrong is in the refusal, which is empty
  /// (`!any()`) where `solve` would start.
  Refusal check(Registry& plugins) const;

  /// Solves from where the composition starts, and certifies what the solver found. The result is refused where
  /// `check` refuses; whatever happens later is a status of the result. An exception of `progress` stops the solver,
  /// and is told in the result's warnings.
  SimulationResult solve(Registry& plugins, const Progress& progress = {}) const;

  /// The same from the state of a result, of this scene and mesh with whatever other values, as `[start]` from its
  /// document. Refused where the state does not fit: docs/in-process.md.
  SimulationResult solve(Registry& plugins, const Progress& progress, const SimulationResult& from) const;

  /// Reads and builds everything once, to be solved again and again with other values
  /// (core/simulation/prepared_simulation.hpp). The registry outlives what is prepared.
  PreparedSimulation prepared(Registry& plugins) const;

 private:
  SimulationResult solve_request(Registry& plugins, const Progress& progress, const SimulationResult* from) const;

  CompositionRequest request_;
};

}  // namespace bowstring
