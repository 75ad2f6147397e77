#include "core/procedure/procedure.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/procedure/continuation.hpp"
#include "core/procedure/multistart.hpp"
#include "core/procedure/summary.hpp"
#include "core/result/carry.hpp"
#include "core/result/provenance.hpp"

namespace bowstring {
namespace {

/// Shares of the way at which a walk's composition is read and built before anything is solved. A value's bounds hold
/// in between where they hold at the ends; a geometry may be sound at both and fold on the way.
constexpr double checked_shares[] = {0.0, 1.0, 0.25, 0.5, 0.75};

bool is_of_the_path(const InputError& error) {
  return error.found.rfind("path '", 0) == 0 || error.found.rfind("unknown key", 0) == 0;
}

/// Errors of a walked value, with what the value was.
void tell_value(Refusal& refusal, const ContinuationTable& table, double share) {
  for (InputError& error : refusal.errors) {
    if (is_of_the_path(error)) {
      error.position = table.path_position;
    } else {
      error.found = "with '" + table.path + "' at " + table.range.text(share) + " of [continuation]: " + error.found;
    }
  }
}

/// A state that could not be built on the one before it, which it shows.
StateResult unsolved(const StateResult& before, const std::string& name, const std::string& why) {
  StateResult out = before;
  out.name = name;
  out.path = {};
  out.equilibria.clear();
  out.solution.certificate.verdict = Verdict::failed;
  out.solution.certificate.reason = "the state before does not carry over: " + why;
  return out;
}

}  // namespace

void take_losses(const Composition& composition, const Scene& scene, StateResult& state) {
  state.losses = evaluate_losses(composition, scene, state.readings);
  for (std::string& warning : loss_warnings(state.losses)) state.solution.warnings.push_back(std::move(warning));
}

bool Procedure::check_walk(const Session& session, const CompositionRequest& request, Refusal& refusal) const {
  const ContinuationTable& table = session.composition.continuation;
  if (!table.given) return true;
  for (const double share : checked_shares) {
    CompositionRequest walked = request;
    walked.overrides.push_back(
        {table.path, table.range.text(share), share < 0.5 ? table.from_position : table.to_position, "", true});
    Refusal refused;
    if (bowstring::prepare(walked, registry_, refused) != nullptr) continue;
    tell_value(refused, table, share);
    refusal.errors.insert(refusal.errors.end(), refused.errors.begin(), refused.errors.end());
    if (refusal.plugin_failure.ok()) refusal.plugin_failure = refused.plugin_failure;
    if (!refused.errors.empty() && is_of_the_path(refused.errors.front())) break;
    if (share == 1.0) break;
  }
  return !refusal.any();
}

std::unique_ptr<Procedure> Procedure::prepare(const CompositionRequest& request, Registry& registry, Refusal& refusal,
                                              const CarriedState* carried) {
  std::unique_ptr<Procedure> out(new Procedure(request, registry));
  if (carried != nullptr) out->carried_ = *carried;
  out->session_ = bowstring::prepare(request, registry, refusal, carried);
  if (out->session_ == nullptr) return nullptr;
  out->input_files_ = out->session_->composition.input_files;
  const std::size_t steps = out->session_->composition.steps.size();
  out->check_walk(*out->session_, request, refusal);
  for (std::size_t k = 1; k < steps; ++k) {
    CompositionRequest step = request;
    step.step = static_cast<int>(k);
    step.from_memory = true;
    Refusal refused;
    const std::unique_ptr<Session> session = bowstring::prepare(step, registry, refused);
    if (session != nullptr) {
      out->check_walk(*session, step, refused);
      for (const std::string& file : session->composition.input_files) {
        auto& all = out->input_files_;
        if (std::find(all.begin(), all.end(), file) == all.end()) all.push_back(file);
      }
    }
    for (InputError& error : refused.errors) {
      const auto same = [&](const InputError& told) { return told.text() == error.text(); };
      if (std::none_of(refusal.errors.begin(), refusal.errors.end(), same)) refusal.errors.push_back(error);
    }
    if (refusal.plugin_failure.ok()) refusal.plugin_failure = refused.plugin_failure;
  }
  return refusal.any() ? nullptr : std::move(out);
}

StateResult Procedure::solve_state(const CompositionRequest& request, std::unique_ptr<Session> session,
                                   const CarriedState* carried,
                                   const std::function<bool(const IterationRecord&)>& progress) const {
  const auto begin = std::chrono::steady_clock::now();
  StateResult out;
  const std::string asked = session->composition.resolved_json;
  std::optional<StartOrigin> start;
  if (!session->start.q.empty()) start = session->start.origin;
  const ContinuationTable table = session->composition.continuation;
  const MultistartTable multistart = session->composition.multistart;
  const auto build = [&](const CompositionRequest& walked, Refusal& refusal) {
    return bowstring::prepare(walked, registry_, refusal, carried);
  };
  bool stopped = false;
  const auto watched = [&](const IterationRecord& record) {
    stopped = stopped || (progress && !progress(record));
    return !stopped;
  };
  SolvedState solved;
  if (table.given && !table.fallback) {
    solved = walk(request, std::move(session), build, watched, out.path);
  } else {
    solved.session = std::move(session);
    solved.solution = solve(*solved.session, watched);
    const Certificate cold = solved.solution.certificate;
    if (table.given && cold.verdict != Verdict::converged && !stopped) {
      Refusal refusal;
      SolvedState walked = walk(request, build(request, refusal), build, watched, out.path);
      const std::string told =
          "the solve from the start ended '" + std::string(verdict_name(cold.verdict)) + "' (" + cold.reason + "); ";
      if (out.path.reached) {
        solved = std::move(walked);
        solved.solution.warnings.push_back(told + "this is what [continuation] came to");
      } else {
        solved.solution.warnings.push_back(told + "[continuation] did not help: " + out.path.reason);
      }
    }
  }
  if (multistart.given && !stopped) {
    find_equilibria(*solved.session, multistart, watched, solved.solution, out.equilibria);
  }
  out.readable = read_solution(*solved.session, solved.solution, out.readings);
  if (solved.session->composition.resolved_json != asked) out.path.asked_composition = asked;
  out.session = record_of(*solved.session, provenance_json(provenance_of(solved.session->composition, registry_)));
  if (table.given || multistart.given) {
    // Of all solves, not of the last one.
    Seconds& seconds = out.session.seconds;
    seconds.solve = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    seconds.total = seconds.load + seconds.setup + seconds.solve;
  }
  out.input_files = solved.session->composition.input_files;
  out.solution = std::move(solved.solution);
  take_losses(solved.session->composition, *solved.session->scene, out);
  out.solution.start = std::move(start);  // of what was asked, not of a solve that was one of many
  return out;
}

std::vector<StateResult> Procedure::run(const std::function<bool(const IterationRecord&)>& progress) {
  std::vector<StateResult> out;
  const std::vector<StepTable> steps = session_->composition.steps;
  out.push_back(solve_state(request_, std::move(session_), carried_ ? &*carried_ : nullptr, progress));
  if (steps.empty()) return out;
  out.back().name = steps.front().name;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const StateResult& before = out.back();
    if (before.solution.certificate.verdict != Verdict::converged) break;
    CarriedState carried = carry(before.session, before.solution, before.readings, "the state '" + before.name + "'");
    carried.position = steps[k].position;
    carried.becomes_rest = steps[k].rest_is_previous;
    CompositionRequest request = request_;
    request.step = static_cast<int>(k);
    Refusal refusal;
    std::unique_ptr<Session> session = bowstring::prepare(request, registry_, refusal, &carried);
    if (session == nullptr) {
      out.push_back(unsolved(before, steps[k].name, refusal.text()));
      break;
    }
    out.push_back(solve_state(request, std::move(session), &carried, progress));
    out.back().name = steps[k].name;
  }
  if (out.size() < steps.size()) {
    Certificate& certificate = out.back().solution.certificate;
    certificate.reason = "step " + std::to_string(out.size()) + " of " + std::to_string(steps.size()) + ", '" +
                         out.back().name + "': " + certificate.reason;
  }
  return out;
}

}  // namespace bowstring
