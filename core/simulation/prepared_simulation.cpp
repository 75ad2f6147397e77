#include "core/simulation/prepared_simulation.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "core/result/document.hpp"
#include "core/result/provenance.hpp"
#include "core/session/revalue.hpp"
#include "core/simulation/solving.hpp"

namespace bowstring {

class PreparedSimulation::Inside {
 public:
  Inside(CompositionRequest given, Registry& registry) : request(std::move(given)), plugins(registry) {}

  void put(const std::string& path, const std::string& value) {
    solving::put(request.overrides, path, value);
    changed.push_back(path);
  }

  void take_back(const std::string& path) {
    solving::take_back(request.overrides, path);
    session.reset();
  }

  /// Gives the session the values that were set since, or none where it has to be built anew.
  void revalue_session() {
    for (const std::string& path : changed) {
      if (session != nullptr && !revalue(*session, current(path))) session.reset();
    }
    changed.clear();
  }

  bool build(const CarriedState* carried, Refusal& refusal) {
    ++builds;
    built_with_state = carried != nullptr;
    session = prepare(request, plugins, refusal, carried);
    if (session != nullptr) refuse_procedures(session->composition, refusal);
    if (refusal.any()) session.reset();
    if (session != nullptr) provenance = provenance_json(provenance_of(session->composition, plugins));
    return session != nullptr;
  }

  /// Brings the session up to date; false with the refusal. `own_start`: its start has to be the composition's.
  bool update(bool own_start, Refusal& refusal) {
    revalue_session();
    return (session != nullptr && !(own_start && built_with_state)) || build(nullptr, refusal);
  }

  SimulationResult solved(const Progress& progress, const Start* start) {
    SimulationResult result = solving::solve_session(*session, provenance, progress, start);
    if (result.status() == Verdict::converged || result.status() == Verdict::stalled) last = result;
    return result;
  }

  SimulationResult solve(const Progress& progress) {
    if (!last) return solve_afresh(progress);
    Refusal refusal;
    SimulationResult result = solve_from(*last, progress);
    if (result.ok()) return result;
    // What is wrong with the composition is wrong without a start as well.
    if (!update(true, refusal)) return solving::refused(std::move(refusal));
    Start own = session->start;
    own.warnings.push_back(
        "the result before does not fit this scene any more, which starts where its composition does: " +
        result.refusal().text());
    return solved(progress, &own);
  }

  SimulationResult solve_from(const SimulationResult& from, const Progress& progress) {
    Refusal refusal;
    CarriedState carried;
    if (!solving::state_of(from, carried, refusal)) return solving::refused(std::move(refusal));
    revalue_session();
    Start start;
    if (session != nullptr && !session->composition.start.rest_is_previous) {
      if (!solving::start_from(*session, carried, start, refusal)) return solving::refused(std::move(refusal));
      if (show_previous(*session, start.previous)) return solved(progress, &start);
    }
    if (!build(&carried, refusal)) return solving::refused(std::move(refusal));
    return solved(progress, nullptr);
  }

  SimulationResult solve_afresh(const Progress& progress) {
    Refusal refusal;
    if (!update(true, refusal)) return solving::refused(std::move(refusal));
    return solved(progress, nullptr);
  }

  CompositionRequest request;
  Registry& plugins;
  std::unique_ptr<Session> session;
  std::string provenance;
  std::vector<std::string> changed;  // paths since the session was brought up to date
  std::optional<SimulationResult> last;
  bool built_with_state = false;  // the session's own start is not the composition's
  int builds = 0;

 private:
  /// One state is solved here, from wherever the caller wants.
  static void refuse_procedures(const Composition& composition, Refusal& refusal) {
    const auto refuse = [&](const std::string& position, const char* table) {
      refusal.errors.push_back({position, std::string(table) + " in a composition that is prepared",
                                "a composition of one state", "remove it, or solve the Simulation itself"});
    };
    if (!composition.steps.empty()) refuse(composition.steps.front().position, "[[step]]");
    if (composition.continuation.given) refuse(composition.continuation.position, "[continuation]");
    if (composition.multistart.given) refuse(composition.multistart.position, "[multistart]");
  }

  Override current(const std::string& path) const {
    for (const Override& one : request.overrides) {
      if (one.path == path) return one;
    }
    return {path, ""};
  }
};

namespace {

template <class Solve>
SimulationResult without_exceptions(const Solve& solve) {
  try {
    return solve();
  } catch (...) {
    return solving::refused(solving::broken_down());
  }
}

}  // namespace

PreparedSimulation::PreparedSimulation(const CompositionRequest& request, Registry& plugins)
    : inside_(std::make_unique<Inside>(request, plugins)) {}
PreparedSimulation::~PreparedSimulation() = default;
PreparedSimulation::PreparedSimulation(PreparedSimulation&&) noexcept = default;
PreparedSimulation& PreparedSimulation::operator=(PreparedSimulation&&) noexcept = default;

void PreparedSimulation::set(const std::string& path, const std::string& value) { inside_->put(path, value); }
void PreparedSimulation::set(const std::string& path, double value) { set(path, solving::number_text(value)); }
void PreparedSimulation::set(const std::string& path, double value, const std::string& unit) {
  set(path, solving::quantity_text(value, unit));
}
void PreparedSimulation::unset(const std::string& path) { inside_->take_back(path); }

Refusal PreparedSimulation::check() {
  Refusal refusal;
  try {
    inside_->update(false, refusal);
  } catch (...) {
    refusal = solving::broken_down();
  }
  return refusal;
}

SimulationResult PreparedSimulation::solve(const Progress& progress) {
  return without_exceptions([&] { return inside_->solve(progress); });
}

SimulationResult PreparedSimulation::solve_from(const SimulationResult& from, const Progress& progress) {
  return without_exceptions([&] { return inside_->solve_from(from, progress); });
}

SimulationResult PreparedSimulation::solve_afresh(const Progress& progress) {
  return without_exceptions([&] { return inside_->solve_afresh(progress); });
}

int PreparedSimulation::builds() const noexcept { return inside_->builds; }

}  // namespace bowstring
