#include <limits>
#include <memory>
#include <string>

#include "plugins/sdk/plugin.hpp"
#include "solvers/shared/backend.hpp"
#include "solvers/nlopt/program.hpp"

namespace bowstring::nlopt_solver {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    backend::max_iterations_key(
        "", "over all epochs; default 1000 with slsqp, 20000 with mma and ccsaq, where every trial point counts"),
    backend::time_limit_key,
    {.key = "algorithm",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"slsqp\"",
     .description = "sequential quadratic programming; or, of first order and slow, the method of moving asymptotes or "
                    "its quadratic variant, inside an augmented Lagrangian where there are equality rows",
     .choices = "slsqp|mma|ccsaq"},
    {.key = "max-unknowns",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "300",
     .description = "a problem with more free unknowns is refused: matrices are dense here",
     .lower = 1.0},
    backend::step_guard_key,
};

constexpr int slsqp_iterations = 1000;
constexpr int first_order_iterations = 20000;

Settings settings_of(const ParameterSet& parameters) {
  Settings settings;
  const std::string& algorithm = parameters.text("algorithm");
  if (algorithm == "mma") settings.algorithm = Algorithm::mma;
  if (algorithm == "ccsaq") settings.algorithm = Algorithm::ccsaq;
  settings.tolerance = parameters.scalar("tolerance");
  settings.max_iterations = settings.algorithm == Algorithm::slsqp ? slsqp_iterations : first_order_iterations;
  if (parameters.has("max-iterations")) {
    settings.max_iterations = static_cast<int>(parameters.integer("max-iterations"));
  }
  settings.max_unknowns = static_cast<int>(parameters.integer("max-unknowns"));
  settings.time_limit = backend::time_limit(parameters);
  settings.guard = backend::step_guard(parameters);
  return settings;
}

struct Verdict {
  Claim claim;
  std::string reason;
};

/// What NLopt itself says when no callback has stopped it.
Verdict verdict(nlopt::result result, const std::string& message) {
  const std::string code = nlopt_result_to_string(static_cast<nlopt_result>(result));
  const std::string words = message.empty() ? code : code + ": " + message;
  switch (result) {
    case nlopt::MAXTIME_REACHED:
      return {Claim::stalled, "the time limit was reached"};
    case nlopt::ROUNDOFF_LIMITED:
      return {Claim::stalled, "NLopt found no further step (" + words + ")"};
    case nlopt::SUCCESS:
    case nlopt::STOPVAL_REACHED:
    case nlopt::FTOL_REACHED:
    case nlopt::XTOL_REACHED:
    case nlopt::MAXEVAL_REACHED:
      return {Claim::stalled, "NLopt ended short of the tolerance (" + words + ")"};
    default:
      return {Claim::failed, "NLopt failed (" + words + ")"};
  }
}

Verdict verdict(const Program& program, nlopt::result result) {
  switch (program.stop()) {
    case Stop::converged:
      return {Claim::optimal, "the first-order conditions hold within the tolerance"};
    case Stop::iterations:
      return {Claim::stalled, "the iteration limit was reached"};
    case Stop::time:
      return {Claim::stalled, "the time limit was reached"};
    case Stop::user:
      return {Claim::stalled, "stopped by the user"};
    case Stop::quiet:
      return {Claim::stalled, "iterates no longer changed the energy by more than its rounding"};
    case Stop::refused:
      return {Claim::stalled, "every trial step was refused, however short"};
    default:
      return verdict(result, program.message());
  }
}

/// NLopt is re-entrant per object, but for the seed of its random numbers, which none of these algorithms draws:
/// instances may solve at the same time.
class NloptSolver final : public Solver {
 public:
  explicit NloptSolver(const ParameterSet& parameters) : settings_(settings_of(parameters)) {}

  SolverTraits traits() const noexcept override { return backend::traits(); }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] {
      if (summary.unknowns > settings_.max_unknowns) {
        throw StatusError(
            Code::unsupported,
            "it has " + std::to_string(summary.unknowns) +
                " free unknowns, more than max-unknowns = " + std::to_string(settings_.max_unknowns) +
                ", and the dense matrices of this solver cost the cube of that number in each iteration; take another "
                "solver, such as 'ipopt', a larger max-unknowns, fewer nodes, or kinematics with fewer unknowns, such "
                "as 'nodes'");
      }
      backend::check_equalities("NLopt", summary);
    });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] { run(problem, start, context, out); });
  }

 private:
  void run(Problem& problem, Span<const double> start, const SolverContext& context, SolverResult& out) const {
    Progress progress;
    progress.begin = Clock::now();
    const backend::Guarded guarded(problem, settings_.guard);
    out.q.assign(start.begin(), start.end());
    if (Status status = problem.accept(out.q); !status.ok()) throw StatusError(std::move(status));
    for (;;) {
      const double error_before = progress.least_error;
      const std::unique_ptr<EuclideanProblem> chart = problem.chart(out.q);
      Program program(problem, *chart, settings_, context, out, progress);
      const nlopt::result result = program.run();
      const bool limited = program.stop() == Stop::none
                               ? result == nlopt::MAXTIME_REACHED
                               : program.stop() != Stop::quiet && program.stop() != Stop::refused;
      const bool window_left = !limited && program.left_window() && progress.least_error < error_before;
      if (program.stop() == Stop::epoch || window_left) {
        if (Status epoch = problem.new_epoch(); !epoch.ok()) throw StatusError(std::move(epoch));
        continue;
      }
      // A fresh approximation of the second derivatives may lead on from where SLSQP has ended. The other algorithms
      // would begin with the augmented Lagrangian's first penalty, far from where they were.
      const bool slsqp = settings_.algorithm == Algorithm::slsqp;
      if (slsqp && !limited && progress.least_error < 0.5 * error_before) continue;
      conclude(verdict(program, result), progress, out);
      return;
    }
  }

  static void conclude(Verdict verdict, Progress& progress, SolverResult& out) {
    if (verdict.claim != Claim::optimal) {
      out.q = std::move(progress.best);
      if (!progress.failure.ok()) verdict = {Claim::failed, progress.failure.text};
    }
    out.claim = verdict.claim;
    out.reason = std::move(verdict.reason);
  }

  Settings settings_;
};

}  // namespace
}  // namespace bowstring::nlopt_solver

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::nlopt_solver::NloptSolver>(
    bowstring::Kind::solver, "nlopt", "NLopt's SLSQP, MMA and CCSAQ, on a chart: dense, for small problems",
    bowstring::nlopt_solver::schema))
