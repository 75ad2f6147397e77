#include "core/simulation/solving.hpp"

#include <algorithm>
#include <charconv>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "core/result/carry.hpp"
#include "core/simulation/simulation_data.hpp"

namespace bowstring::solving {

namespace {

/// What an exception says, within a handler.
std::string exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception was thrown";
  }
}

/// Keeps the exceptions of a caller's function out of the solver.
class GuardedProgress {
 public:
  explicit GuardedProgress(const Progress& progress) : progress_(progress) {}

  bool operator()(const IterationRecord& record) {
    if (!problem_.empty()) return false;
    if (!progress_) return true;
    try {
      return progress_(record);
    } catch (...) {
      problem_ = "the progress function threw '" + exception_text() + "', which has stopped the solver";
      return false;
    }
  }
  const std::string& problem() const noexcept { return problem_; }

 private:
  const Progress& progress_;
  std::string problem_;
};

}  // namespace

SimulationResult refused(Refusal refusal) {
  auto data = std::make_shared<SimulationData>();
  data->refusal = std::move(refusal);
  return SimulationResult(std::move(data));
}

Refusal broken_down() {
  Refusal refusal;
  refusal.plugin_failure = Status::failure(Code::failed, exception_text());
  return refusal;
}

std::string number_text(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, error == std::errc() ? end : text};
}

std::string quantity_text(double value, const std::string& unit) {
  return "\"" + number_text(value) + " " + unit + "\"";
}

void take_back(std::vector<Override>& overrides, const std::string& path) {
  const auto same = [&](const Override& one) { return one.path == path; };
  overrides.erase(std::remove_if(overrides.begin(), overrides.end(), same), overrides.end());
}

void put(std::vector<Override>& overrides, const std::string& path, const std::string& value) {
  take_back(overrides, path);
  overrides.push_back({path, value});
}

bool state_of(const SimulationResult& from, CarriedState& carried, Refusal& refusal) {
  const SimulationData& data = from.data();
  if (!from.ok()) {
    refusal.errors.push_back({"from", "the result to start from is a refusal (" + data.refusal.text() + ")",
                              "a result that was solved", ""});
    return false;
  }
  carried = carry(data.state().session, data.state().solution, data.state().readings, "the result");
  carried.position = "from";
  return true;
}

bool start_from(const Session& session, const CarriedState& carried, Start& start, Refusal& refusal) {
  std::vector<DocumentFlaw> flaws;
  start = bowstring::start_from(*session.scene, session.assembly->row_origins(), carried, flaws);
  for (DocumentFlaw& flaw : flaws) {
    refusal.errors.push_back({carried.position, std::move(flaw.found), std::move(flaw.expected), std::move(flaw.mend)});
  }
  return !refusal.any();
}

namespace {

SimulationResult made_of(std::vector<StateResult> states, const std::vector<std::string>& input_files,
                         const std::string& problem) {
  auto data = std::make_shared<SimulationData>();
  data->states = std::move(states);
  const StateResult& last = data->state();
  data->status = last.solution.certificate.verdict;
  data->reason = last.solution.certificate.reason;
  data->warnings = last.solution.warnings;
  if (!last.readable.ok()) data->warnings.push_back(last.readable.text);
  if (!problem.empty()) data->warnings.push_back(problem);
  data->input_files = input_files;
  return SimulationResult(std::move(data));
}

}  // namespace

SimulationResult solve_session(Session& session, std::string provenance, const Progress& progress, const Start* start) {
  GuardedProgress guarded(progress);
  StateResult state;
  state.solution = solve(session, std::ref(guarded), start);
  state.readable = read_solution(session, state.solution, state.readings);
  take_losses(session.composition, *session.scene, state);
  state.session = record_of(session, std::move(provenance));
  std::vector<StateResult> states;
  states.push_back(std::move(state));
  return made_of(std::move(states), session.composition.input_files, guarded.problem());
}

SimulationResult solve_procedure(Procedure& procedure, const Progress& progress) {
  GuardedProgress guarded(progress);
  std::vector<StateResult> states = procedure.run(std::ref(guarded));
  return made_of(std::move(states), procedure.input_files(), guarded.problem());
}

}  // namespace bowstring::solving
