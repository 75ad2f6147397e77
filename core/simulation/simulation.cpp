#include "core/simulation/simulation.hpp"

#include <memory>
#include <utility>

#include "core/composition/sha256.hpp"
#include "core/result/document.hpp"
#include "core/simulation/prepared_simulation.hpp"
#include "core/simulation/solving.hpp"

namespace bowstring {

Simulation Simulation::from_file(const std::string& file) {
  Simulation out;
  out.request_.file = file;
  return out;
}

Simulation Simulation::from_text(const std::string& toml, const std::string& file) {
  Simulation out = from_file(file);
  out.request_.text = toml;
  return out;
}

void Simulation::set(const std::string& path, const std::string& value) {
  solving::put(request_.overrides, path, value);
}

void Simulation::set(const std::string& path, double value) { set(path, solving::number_text(value)); }

void Simulation::set(const std::string& path, double value, const std::string& unit) {
  set(path, solving::quantity_text(value, unit));
}

void Simulation::unset(const std::string& path) { solving::take_back(request_.overrides, path); }

std::vector<std::string> Simulation::plugin_path() const { return composition_plugin_path(request_); }

Refusal Simulation::check(Registry& plugins) const {
  Refusal refusal;
  try {
    Procedure::prepare(request_, plugins, refusal);
  } catch (...) {
    refusal = solving::broken_down();
  }
  return refusal;
}

SimulationResult Simulation::solve(Registry& plugins, const Progress& progress) const {
  return solve_request(plugins, progress, nullptr);
}

SimulationResult Simulation::solve(Registry& plugins, const Progress& progress, const SimulationResult& from) const {
  return solve_request(plugins, progress, &from);
}

SimulationResult Simulation::solve_request(Registry& plugins, const Progress& progress,
                                           const SimulationResult* from) const {
  try {
    Refusal refusal;
    CarriedState carried;
    if (from != nullptr && !solving::state_of(*from, carried, refusal)) return solving::refused(std::move(refusal));
    if (from != nullptr) {
      RecordedState state = *carried.state;
      state.sha256 = sha256_hex(from->json());
      carried.state = std::make_shared<const RecordedState>(std::move(state));
    }
    const std::unique_ptr<Procedure> procedure =
        Procedure::prepare(request_, plugins, refusal, from != nullptr ? &carried : nullptr);
    if (procedure == nullptr) return solving::refused(std::move(refusal));
    return solving::solve_procedure(*procedure, progress);
  } catch (...) {
    return solving::refused(solving::broken_down());
  }
}

PreparedSimulation Simulation::prepared(Registry& plugins) const { return PreparedSimulation(request_, plugins); }

}  // namespace bowstring
