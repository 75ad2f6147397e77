#pragma once

#include <string>

#include "core/procedure/procedure.hpp"
#include "core/session/session.hpp"
#include "core/simulation/simulation.hpp"

/// What simulations and prepared ones have in common.
namespace bowstring::solving {

SimulationResult refused(Refusal refusal);

/// Within a handler: the exception as a refusal.
Refusal broken_down();

/// The shortest text that reads back as the same number, in every locale.
std::string number_text(double value);
/// "12 N", in TOML's quotes.
std::string quantity_text(double value, const std::string& unit);

/// Replaces the override of that path, or adds one.
void put(std::vector<Override>& overrides, const std::string& path, const std::string& value);
void take_back(std::vector<Override>& overrides, const std::string& path);

/// Another result's state. False where it has none, with the reason in the refusal.
bool state_of(const SimulationResult& from, CarriedState& carried, Refusal& refusal);

/// Makes a start of a state. False where it does not fit, with the reasons in the refusal.
bool start_from(const Session& session, const CarriedState& carried, Start& start, Refusal& refusal);

/// `provenance`: of the document. `start` as in `solve` of a session.
SimulationResult solve_session(Session& session, std::string provenance, const Progress& progress,
                               const Start* start = nullptr);

/// The whole of what a composition asks for.
SimulationResult solve_procedure(Procedure& procedure, const Progress& progress);

}  // namespace bowstring::solving
