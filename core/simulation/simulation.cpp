#include "core/simulation/simulation.hpp"

#include <algorithm>
#include <charconv>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "core/result/solved.hpp"
#include "core/simulation/simulation_data.hpp"

namespace bowstring {

namespace {

/// The shortest text that reads back as the same number, in every locale.
std::string shortest_text(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, error == std::errc() ? end : text};
}

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

SimulationResult solve_session(Session& session, const Registry& plugins, const Progress& progress) {
  GuardedProgress guarded(progress);
  Solved solved = solve_and_read(session, plugins, std::ref(guarded));
  auto data = std::make_shared<SimulationData>();
  data->status = solved.solution.certificate.verdict;
  data->reason = std::move(solved.solution.certificate.reason);
  data->warnings = std::move(solved.solution.warnings);
  if (!solved.readable.ok()) data->warnings.push_back(solved.readable.text);
  if (!guarded.problem().empty()) data->warnings.push_back(guarded.problem());
  data->input_files = std::move(session.composition.input_files);
  data->document = nlohmann::ordered_json::parse(solved.document);
  data->text = std::move(solved.document);
  return SimulationResult(std::move(data));
}

}  // namespace

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
  unset(path);
  request_.overrides.push_back({path, value});
}

void Simulation::set(const std::string& path, double value) { set(path, shortest_text(value)); }

void Simulation::set(const std::string& path, double value, const std::string& unit) {
  set(path, "\"" + shortest_text(value) + " " + unit + "\"");
}

void Simulation::unset(const std::string& path) {
  std::vector<Override>& all = request_.overrides;
  const auto same = [&](const Override& one) { return one.path == path; };
  all.erase(std::remove_if(all.begin(), all.end(), same), all.end());
}

std::vector<std::string> Simulation::plugin_path() const { return composition_plugin_path(request_); }

Refusal Simulation::check(Registry& plugins) const {
  Refusal refusal;
  try {
    prepare(request_, plugins, refusal);
  } catch (...) {
    refusal = broken_down();
  }
  return refusal;
}

SimulationResult Simulation::solve(Registry& plugins, const Progress& progress) const {
  try {
    Refusal refusal;
    const std::unique_ptr<Session> session = prepare(request_, plugins, refusal);
    return session == nullptr ? refused(std::move(refusal)) : solve_session(*session, plugins, progress);
  } catch (...) {
    return refused(broken_down());
  }
}

}  // namespace bowstring
