#include "core/session/session.hpp"

#include <chrono>
#include <cstdio>
#include <limits>

#include "core/certificate/multipliers.hpp"
#include "core/model/declarations.hpp"

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

std::unique_ptr<Session> prepare(const CompositionRequest& request, Registry& registry, Refusal& refusal) {
  const auto begin = Clock::now();
  CompositionOutcome loaded = load_composition(request, registry);
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
  SceneOutcome built = build_scene(composition, session->solver->traits());
  refusal.errors = std::move(built.errors);
  refusal.plugin_failure = std::move(built.plugin_failure);
  if (refusal.any()) return nullptr;
  session->scene = std::move(built.scene);
  try {
    session->assembly = std::make_unique<Assembly>(*session->scene);
  } catch (const std::exception& error) {
    refusal.plugin_failure = Status::failure(Code::failed, error.what());
    return nullptr;
  }
  check_pair(*session, refusal);
  session->seconds.setup = since(setup);
  session->seconds.total = since(begin);
  return refusal.any() ? nullptr : std::move(session);
}

Solution solve(Session& session, const std::function<bool(const IterationRecord&)>& progress) {
  const auto begin = Clock::now();
  Solution solution;
  solution.warnings = session.composition.warnings;
  solution.warnings.insert(solution.warnings.end(), session.scene->warnings.begin(), session.scene->warnings.end());
  Assembly& assembly = *session.assembly;
  const std::vector<double> start = session.scene->start_coordinates();
  SolverContext context;
  context.on_iteration = progress;
  Status status = session.enforcement->solve(assembly, *session.solver, start, context, solution.solver);
  if (const std::string flaw = flaw_of(solution.solver, assembly); status.ok() && !flaw.empty()) {
    status = Status::failure(Code::failed, "it " + flaw);
    solution.solver.q.clear();
    solution.solver.multipliers.clear();
  }
  if (!status.ok()) {
    solution.solver.claim = Claim::failed;
    solution.solver.reason = "solver '" + session.composition.solver.name + "': " + status.text;
  }
  session.seconds.solve = since(begin);

  solution.q = solution.solver.q.empty() ? start : solution.solver.q;
  solution.multipliers = solution.solver.multipliers;
  solution.estimated_multipliers = solution.multipliers.size() != static_cast<std::size_t>(assembly.rows());
  status = assembly.accept(solution.q);
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
  const ParameterValue* tolerance = session.composition.solver.parameters.find("tolerance");
  const Certificate& certificate = solution.certificate;
  if (certificate.first_order && tolerance != nullptr && certificate.stationarity > tolerance->number) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "the solver's tolerance %.1e was missed: stationarity is %.1e N (rounding leaves about %.1e N)",
                  tolerance->number, certificate.stationarity, certificate.rounding_floor);
    solution.warnings.emplace_back(text);
  }
  session.seconds.total += since(begin);
  return solution;
}

}  // namespace bowstring
