#include "study/workers/unit_work.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

#include "study/workers/run_solver.hpp"

namespace bowstring::study {

namespace {

constexpr auto look_every = std::chrono::milliseconds(20);

bool has_all(const RunRecord& record, const StudyFile& study, bool keep_documents) {
  if (record.time_limit > 0.0) return study.time_limit > 0.0 && study.time_limit <= record.time_limit;
  if (record.status == "refused" || record.solve_seconds.empty()) return true;  // there is no more to be had
  if (keep_documents && record.document_sha256.empty()) return false;
  if (static_cast<int>(record.solve_seconds.size()) < study.repeats) return false;
  return !record.document_sha256.empty() ||
         std::all_of(study.quantities.begin(), study.quantities.end(),
                     [&](const auto& quantity) { return record.values.count(value_key(quantity)) > 0; });
}

/// A predecessor may have failed where this run was solved, and have been solved since, or the other way round.
bool starts_where_it_has_to(const Plan& plan, const Folder& folder, int run, const RunRecord& record) {
  const int predecessor = plan.runs[static_cast<std::size_t>(run)].predecessor;
  if (predecessor < 0 || record.solve_seconds.empty()) return true;
  RunRecord before;
  std::string why;
  if (folder.load(plan.runs[static_cast<std::size_t>(predecessor)].hash, before, why) != Stored::whole) return true;
  return (before.status == "converged") == !record.predecessor.empty();
}

}  // namespace

bool is_complete(const Plan& plan, const Folder& folder, int run, const RunRecord& record, bool keep_documents) {
  return has_all(record, plan.study, keep_documents) && starts_where_it_has_to(plan, folder, run, record);
}

/// Waiting in the system would not hear of a stop.
bool UnitWork::take_claim(const std::string& hash, bool wait) {
  while (!claims_.take(hash)) {
    if (!wait || !hooks_.go_on()) return false;
    std::this_thread::sleep_for(look_every);
  }
  return true;
}

UnitWork::Outcome UnitWork::carry_out(const Unit& unit, bool wait, std::string& problem) {
  std::optional<CarriedState> carried;
  carried_from_ = -1;
  Outcome outcome = Outcome::done;
  for (std::size_t i = 0; i < unit.runs.size() && outcome == Outcome::done; ++i) {
    if (!hooks_.go_on()) return Outcome::stopped;
    const std::string& hash = plan_.runs[static_cast<std::size_t>(unit.runs[i])].hash;
    // Whoever has begun a chain goes on with it: later runs are waited for.
    if (!take_claim(hash, wait || i > 0)) return hooks_.go_on() ? Outcome::busy : Outcome::stopped;
    outcome = take_step(unit, i, carried, problem);
    claims_.leave(hash);
  }
  return outcome;
}

UnitWork::Outcome UnitWork::take_step(const Unit& unit, std::size_t place, std::optional<CarriedState>& carried,
                                      std::string& problem) {
  const int run = unit.runs[place];
  // A next run of the chain starts from the stored document, whatever else is kept.
  const bool in_chain = unit.runs.size() > 1;
  RunRecord record;
  switch (folder_.load(plan_.runs[static_cast<std::size_t>(run)].hash, record, problem)) {
    case Stored::damaged:
      return Outcome::failed;
    case Stored::whole:
      if (is_complete(plan_, folder_, run, record, keep_documents_ || in_chain)) return Outcome::done;
      break;
    case Stored::missing:
      break;
  }
  return solve_and_store(run, in_chain, carried, problem);
}

bool UnitWork::load_predecessor(int run, std::optional<CarriedState>& carried, std::string& problem) const {
  const int predecessor = plan_.runs[static_cast<std::size_t>(run)].predecessor;
  if (predecessor == carried_from_) return true;
  carried.reset();
  if (predecessor < 0) return true;
  RunRecord record;
  if (folder_.load(plan_.runs[static_cast<std::size_t>(predecessor)].hash, record, problem) != Stored::whole)
    return false;
  if (record.status != "converged") return true;  // then the next one starts from cold
  std::string document;
  problem = folder_.load_document(record, document);
  if (!problem.empty()) return false;
  carried = state_of_document(document, problem);
  return problem.empty();
}

/// A run that throws is a result as well.
SolvedRun UnitWork::solve_guarded(int run, const CarriedState* carried, bool with_document) {
  try {
    return solve_run(plan_, run, carried, with_document, registry_, hooks_.go_on);
  } catch (const std::exception& error) {
    SolvedRun out;
    out.record = failed_run(plan_, run, std::string("solving it threw an exception: ") + error.what());
    return out;
  }
}

UnitWork::Outcome UnitWork::solve_and_store(int run, bool in_chain, std::optional<CarriedState>& carried,
                                            std::string& problem) {
  if (!load_predecessor(run, carried, problem)) return Outcome::failed;
  hooks_.begins(run);
  SolvedRun solved = solve_guarded(run, carried ? &*carried : nullptr, keep_documents_ || in_chain);
  if (solved.stopped) return Outcome::stopped;
  if (!solved.problem.empty()) {
    problem = solved.problem;
    return Outcome::failed;
  }
  const Status status = folder_.store(solved.record, solved.document);
  if (!status.ok()) {
    problem = status.text;
    return Outcome::failed;
  }
  hooks_.stored(solved.record);
  carried = std::move(solved.result);
  carried_from_ = run;
  return Outcome::done;
}

}  // namespace bowstring::study
