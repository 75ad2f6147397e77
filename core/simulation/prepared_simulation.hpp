#pragma once

#include <memory>
#include <string>
#include <type_traits>

#include "core/simulation/simulation.hpp"

namespace bowstring {

/// A simulation that is read and built once and solved many times: for sweeps, fits and continuation.
///
///   bowstring::PreparedSimulation iliac = simulation.prepared(plugins);
///   for (double stiffness : stiffnesses) {
///     iliac.set("energy.anchoring.stiffness", stiffness, "N/mm^2");
///     const bowstring::SimulationResult result = iliac.solve();  // from the one before
///   }
///
/// A number of an energy or of a constraint is changed in place, where it changes numbers alone; for any other value
/// `solve` reads and builds the composition again. Either way a solve gives the bits that a Simulation with the same
/// values gives from the same start. Files are read when something is built, not with every solve.
///
/// A composition with [[step]], [continuation] or [multistart] is refused: here the caller says what comes after what.
///
/// Errors, progress and plugins are as with Simulation. One thread at a time may use it.
class PreparedSimulation {
 public:
  PreparedSimulation(const CompositionRequest& request, Registry& plugins);
  ~PreparedSimulation();
  PreparedSimulation(PreparedSimulation&&) noexcept;
  PreparedSimulation& operator=(PreparedSimulation&&) noexcept;

  /// As with Simulation.
  void set(const std::string& path, const std::string& value);
  void set(const std::string& path, double value);
  void set(const std::string& path, double value, const std::string& unit);
  template <class Flag, std::enable_if_t<std::is_same_v<Flag, bool>, int> = 0>
  void set(const std::string& path, Flag value) {
    set(path, std::string(value ? "true" : "false"));
  }
  void unset(const std::string& path);

  /// Builds what `set` has changed, solves nothing.
  Refusal check();

  /// From the last result that converged or stalled; the first time from where the composition starts. Where that
  /// result does not fit any more, for a value has changed the mesh, from there again, with a warning.
  SimulationResult solve(const Progress& progress = {});

  /// From the state of any result, of this object or not; refused where it does not fit.
  SimulationResult solve_from(const SimulationResult& from, const Progress& progress = {});

  /// From where the composition starts: what `Simulation::solve` gives, bit for bit.
  SimulationResult solve_afresh(const Progress& progress = {});

  /// How often the composition was read and built so far: what `set` could not change in place adds one.
  int builds() const noexcept;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace bowstring
