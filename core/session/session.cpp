#include "core/session/session.hpp"

#include <chrono>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "core/certificate/multipliers.hpp"
#include "core/model/declarations.hpp"
#include "core/session/revalue.hpp"
#include "core/transport/curve_loss.hpp"

namespace bowstring {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double contact_reach = 1e-6;  // mm: rows so near their bound may carry an estimated multiplier

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

void refuse(const Status& status, const ComponentChoice& choice, Refusal& refusal) {
  if (status.code == Code::invalid_input || status.code == Code::unsupported) {
    refusal.errors.push_back({choice.position, status.text, "", ""});
  } else if (refusal.plugin_failure.ok()) {
    refusal.plugin_failure = status;
  }
}

/// Of a point that could not be evaluated: no figure stands for what nobody knows.
Certificate unknown_certificate() {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Certificate out;
  out.stationarity = out.rounding_floor = out.penetration = out.complementarity = out.minimum_multiplier = unknown;
  out.minimum_stretch = out.maximum_stretch = unknown;
  out.second_order.reason = "the point could not be evaluated";
  out.verdict = Verdict::failed;
  return out;
}

Status admits(const SolverTraits& traits, const ProblemSummary& problem) {
  const char* refused = !traits.equalities && problem.equalities > 0       ? "it takes no equality rows"
                        : !traits.inequalities && problem.inequalities > 0 ? "it takes no inequality rows"
                        : !traits.bounds && problem.bounded_unknowns       ? "it takes no bounds on unknowns"
                                                                           : nullptr;
  return refused == nullptr ? Status{} : Status::failure(Code::unsupported, refused);
}

/// Asks the solver whether it can take what the enforcement leaves of the problem.
void check_pair(const Session& session, Refusal& refusal) {
  ProblemSummary remaining;
  Status status = session.enforcement->remaining(session.assembly->summary(), remaining);
  if (!status.ok()) {
    status.text = "enforcement '" + session.composition.enforcement.name + "': " + status.text;
    return refuse(status, session.composition.enforcement, refusal);
  }
  status = admits(session.solver->traits(), remaining);
  if (status.ok()) status = session.solver->can(remaining);
  if (status.ok()) return;
  std::string groups;
  for (const RowGroup& group : remaining.row_groups) groups += (groups.empty() ? "" : ", ") + group.text;
  status.code = Code::unsupported;
  status.text = "solver '" + session.composition.solver.name + "' refuses this problem: " + status.text +
                (groups.empty() ? "" : " (rows: " + groups + ")");
  refuse(status, session.composition.solver, refusal);
}

}  // namespace

std::unique_ptr<Session> prepare(const CompositionRequest& request, Registry& registry, Refusal& refusal,
                                 const CarriedState* carried) {
  const auto begin = Clock::now();
  CompositionRequest own = request;
  own.from_memory = request.from_memory || carried != nullptr;
  CompositionOutcome loaded = load_composition(own, registry);
  refusal.errors = std::move(loaded.errors);
  refusal.plugin_failure = std::move(loaded.plugin_failure);
  if (refusal.any() || !loaded.composition) return nullptr;

  auto session = std::make_unique<Session>();
  session->composition = std::move(*loaded.composition);
  const Composition& composition = session->composition;
  Status status;
  session->solver = create<Solver>(composition.solver, status);
  if (!status.ok()) refuse(status, composition.solver, refusal);
  session->enforcement = create<Enforcement>(composition.enforcement, status);
  if (!status.ok()) refuse(status, composition.enforcement, refusal);
  session->seconds.load = since(begin);
  if (refusal.any()) return nullptr;

  const auto setup = Clock::now();
  const StartTable& table = composition.start;
  const CarriedState of_file{table.state, table.name, table.position, table.from, std::nullopt};
  if (carried == nullptr && table.state != nullptr) carried = &of_file;
  SceneOutcome built = build_scene(composition, session->solver->traits(), carried);
  refusal.errors = std::move(built.errors);
  refusal.plugin_failure = std::move(built.plugin_failure);
  if (refusal.any()) return nullptr;
  session->scene = std::move(built.scene);
  check_losses(composition, *session->scene, refusal);
  if (refusal.any()) return nullptr;
  Start& start = session->start;
  if (carried != nullptr) {
    std::vector<DocumentFlaw> flaws;
    start.q = carried_coordinates(*session->scene, *carried, built.carried, flaws, start.warnings);
    for (DocumentFlaw& flaw : flaws) {
      refusal.errors.push_back(
          {carried->position, std::move(flaw.found), std::move(flaw.expected), std::move(flaw.mend)});
    }
    if (refusal.any()) return nullptr;
  }
  for (const auto& curve : session->scene->curves) start.previous.push_back(curve->previous);
  try {
    session->assembly = std::make_unique<Assembly>(*session->scene, start.q);
  } catch (const std::exception& error) {
    if (start.q.empty()) {
      refusal.plugin_failure = Status::failure(Code::failed, error.what());
    } else {
      refusal.errors.push_back({carried->position,
                                "this scene cannot begin at the state of " + carried->name + ": " + error.what(),
                                "a state of this scene", "remove [start]"});
    }
    return nullptr;
  }
  if (carried != nullptr) {
    start.origin = {carried->file, carried->state->sha256};
    start.multipliers =
        carried_multipliers(*session->scene, session->assembly->row_origins(), *carried, built.carried, start.warnings);
  }
  check_pair(*session, refusal);
  session->seconds.setup = since(setup);
  session->seconds.total = since(begin);
  return refusal.any() ? nullptr : std::move(session);
}

namespace {

/// A new constraint in the place of one that rows have been bound by.
void renew(ConstraintUse& use, const ComponentChoice& choice) {
  Status status;
  use.constraint = create<Constraint>(choice, status);
  use.rows = {};
  if (status.ok()) status = use.constraint->declare(use.scene, use.rows);
  if (!status.ok()) throw std::runtime_error("constraint '" + use.label + "': " + status.text);
  if (const std::string flaw = flaw_of(use.rows); !flaw.empty()) {
    throw std::runtime_error("constraint '" + use.label + "' " + flaw);
  }
}

}  // namespace

void bind_anew(Session& session, const std::vector<double>& q) {
  Scene& scene = *session.scene;
  std::vector<std::pair<Owned<Constraint>, RowDeclaration>> before;
  std::size_t next = 0;
  try {
    for (ConstraintUse& use : scene.constraints) {
      before.emplace_back(Owned<Constraint>{nullptr, nullptr}, use.rows);
      if (use.plugin.empty()) continue;  // rows of ends, which remember nothing
      before.back().first = std::move(use.constraint);
      renew(use, session.composition.constraints[next++].component);
    }
    session.assembly = std::make_unique<Assembly>(scene, q, session.assembly.get());
  } catch (...) {
    for (std::size_t c = 0; c < before.size(); ++c) {
      if (before[c].first != nullptr) scene.constraints[c].constraint = std::move(before[c].first);
      scene.constraints[c].rows = std::move(before[c].second);
    }
    throw;
  }
}

namespace {

/// Whether the solver was stopped from outside, or by what the user allows it.
bool was_stopped(const Session& session, const Solution& solution, bool by_user, double seconds) {
  const ParameterSet& parameters = session.composition.solver.parameters;
  const ParameterValue* iterations = parameters.find("max-iterations");
  const ParameterValue* limit = parameters.find("time-limit");
  return by_user || (iterations != nullptr && solution.solver.iterations >= iterations->integer) ||
         (limit != nullptr && seconds >= limit->number);
}

/// Whether all that the point lacks is the bias that its enforcement tells of: no other start mends that.
bool is_merely_biased(const Solution& solution, const CertificateTable& thresholds) {
  const Certificate& found = solution.certificate;
  return solution.solver.claim == Claim::optimal && solution.solver.enforcement.penetration.has_value() &&
         found.stationarity <= thresholds.stationarity && found.minimum_multiplier >= thresholds.multiplier &&
         found.folds.empty() && found.wire_folds.empty() && found.crossings.empty();
}

/// Accepts and certifies what the solver found; where it found nothing, its start.
void judge(Session& session, const std::vector<double>& start, Solution& solution) {
  const auto judging = Clock::now();
  Assembly& assembly = *session.assembly;
  solution.q = solution.solver.q.empty() ? start : solution.solver.q;
  solution.multipliers = solution.solver.multipliers;
  solution.estimated_multipliers = solution.multipliers.size() != static_cast<std::size_t>(assembly.rows());
  Status status = assembly.accept(solution.q);
  if (status.ok() && solution.estimated_multipliers) {
    status = estimate_multipliers(assembly, solution.q, contact_reach, solution.multipliers);
  }
  if (!status.ok()) solution.multipliers.assign(static_cast<std::size_t>(assembly.rows()), 0.0);
  if (status.ok()) {
    status = certify(assembly, solution.q, solution.multipliers, session.composition.certificate, solution.solver.claim,
                     solution.solver.reason, solution.certificate);
  }
  if (!status.ok()) {
    solution.certificate = unknown_certificate();
    solution.certificate.reason = solution.solver.claim == Claim::failed ? solution.solver.reason : status.text;
  }
  session.seconds.certificate += since(judging);
  const ParameterValue* tolerance = session.composition.solver.parameters.find("tolerance");
  const Certificate& certificate = solution.certificate;
  if (certificate.first_order && tolerance != nullptr && certificate.stationarity > tolerance->number) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "the solver's tolerance %.1e was missed: stationarity is %.1e N (rounding leaves about %.1e N)",
                  tolerance->number, certificate.stationarity, certificate.rounding_floor);
    solution.warnings.emplace_back(text);
  }
}

Solution solve_from(Session& session, const std::vector<double>& q, Span<const double> multipliers,
                    const std::function<bool(const IterationRecord&)>& progress) {
  const auto begin = Clock::now();
  Solution solution;
  Assembly& assembly = *session.assembly;
  SolverContext context;
  context.on_iteration = progress;
  context.multipliers = multipliers;
  Status status = session.enforcement->solve(assembly, *session.solver, q, context, solution.solver);
  if (const std::string flaw = flaw_of(solution.solver, assembly); status.ok() && !flaw.empty()) {
    status = Status::failure(Code::failed, "it " + flaw);
    solution.solver.q.clear();
    solution.solver.multipliers.clear();
  }
  if (!status.ok()) {
    solution.solver.claim = Claim::failed;
    solution.solver.reason = "solver '" + session.composition.solver.name + "': " + status.text;
  }
  session.seconds.solve += since(begin);
  judge(session, q, solution);
  return solution;
}

/// A solution of a scene that could not be made ready for it.
Solution unsolved(const Session& session, const std::vector<double>& q, const std::string& why) {
  Solution out;
  out.q = q;
  out.multipliers.assign(static_cast<std::size_t>(session.assembly->rows()), 0.0);
  out.solver.reason = why;
  out.certificate = unknown_certificate();
  out.certificate.reason = why;
  return out;
}

}  // namespace

Solution solve(Session& session, const std::function<bool(const IterationRecord&)>& progress, const Start* start) {
  const auto begin = Clock::now();
  session.seconds.solve = session.seconds.certificate = 0.0;
  const Start& from = start != nullptr ? *start : session.start;
  bool by_user = false;
  const auto watched = [&](const IterationRecord& record) {
    by_user = by_user || (progress && !progress(record));
    return !by_user;
  };
  const std::vector<double> own = session.scene->start_coordinates();
  const std::vector<double>& first = from.q.empty() ? own : from.q;
  Solution solution;
  try {
    if (start != nullptr || !session.bound) {
      if (!show_previous(session, from.previous)) {
        throw std::runtime_error("a term declares other laws after another step before: prepare the scene anew");
      }
      bind_anew(session, from.q);
    }
    session.bound = false;
    solution = solve_from(session, first, from.multipliers, watched);
    const Certificate& found = solution.certificate;
    if (!from.q.empty() && !from.only && found.verdict != Verdict::converged &&
        !is_merely_biased(solution, session.composition.certificate) &&
        !was_stopped(session, solution, by_user, session.seconds.solve)) {
      const std::string first_verdict = verdict_name(found.verdict), first_reason = found.reason;
      bind_anew(session, {});
      Solution second = solve_from(session, own, {}, watched);
      second.warnings.push_back("from the given start the solve ended '" + first_verdict + "' (" + first_reason +
                                "); this is what it came to from the scene's own start");
      solution = std::move(second);
    }
  } catch (const std::exception& error) {
    bind_anew(session, {});
    solution = unsolved(session, first, error.what());
  }
  if (!from.q.empty()) solution.start = from.origin;
  std::vector<std::string> warnings = session.composition.warnings;
  const auto add = [&](const std::vector<std::string>& more) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  };
  add(session.scene->warnings);
  add(from.warnings);
  add(solution.warnings);
  solution.warnings = std::move(warnings);
  session.seconds.total += since(begin);
  return solution;
}

Solution certified(Session& session, SolverResult found) {
  session.seconds.certificate = 0.0;
  session.bound = false;
  Solution solution;
  solution.solver = std::move(found);
  judge(session, solution.solver.q, solution);
  return solution;
}

}  // namespace bowstring
