#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/active_set_method.hpp"
#include "solvers/shared/backend.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    {.key = "max-iterations",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "300",
     .description = "over all epochs and both methods",
     .lower = 1.0},
    backend::time_limit_key,
    backend::step_guard_key,
};

/// The barrier parameters at which the barrier method hands its point over, the next one where the active set does not
/// settle.
constexpr double hand_overs[] = {1e-3, 1e-5, 1e-7};
constexpr double warm_barrier = 1e-4;

class ActiveSet final : public Solver {
 public:
  explicit ActiveSet(const ParameterSet& parameters) {
    limits_.tolerance = parameters.scalar("tolerance");
    limits_.max_iterations = static_cast<int>(parameters.integer("max-iterations"));
    limits_.time_limit = backend::time_limit(parameters);
    guard_ = backend::step_guard(parameters);
  }

  SolverTraits traits() const noexcept override {
    SolverTraits traits;
    traits.window_segments = 2;
    traits.window_length = 0.0;
    return traits;
  }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] { backend::check_equalities("active-set", summary); });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] {
      const backend::Guarded guarded(problem, guard_);
      newton::Point point(problem, out);
      point.q.assign(start.begin(), start.end());
      newton::Progress progress(limits_, context, out);
      std::vector<double> multipliers(context.multipliers.begin(), context.multipliers.end());
      const newton::Ending ending = run(point, progress, multipliers);
      out.q = point.q;
      out.multipliers = multipliers;
      out.claim = ending.claim;
      out.reason = ending.reason;
    });
  }

 private:
  static newton::Ending run(newton::Point& point, newton::Progress& progress, std::vector<double>& multipliers) {
    bool warm = !multipliers.empty();
    if (warm) {
      bool new_epoch = false;
      Status status = point.accept(new_epoch);
      if (status.ok()) status = point.expand();
      if (!status.ok()) throw StatusError(status);
      newton::ActiveSetMethod method(point, progress);
      newton::Ending ending = method.run(multipliers);
      if (ending.claim != Claim::stalled || method.interrupted()) return ending;
    }
    for (const double barrier : hand_overs) {
      newton::BarrierSettings settings;
      if (warm) settings.first_barrier = std::max(warm_barrier, barrier);
      settings.warm = warm;
      settings.hand_over_barrier = barrier;
      newton::BarrierMethod first(point, progress, settings);
      newton::Ending ending = first.run(multipliers);
      if (ending.claim != Claim::optimal) return ending;
      newton::ActiveSetMethod second(point, progress);
      ending = second.run(multipliers);
      if (ending.claim != Claim::stalled || second.interrupted()) return ending;
      warm = true;
    }
    newton::BarrierSettings settings;
    settings.warm = true;
    settings.first_barrier = hand_overs[2];
    newton::BarrierMethod last(point, progress, settings);
    return last.run(multipliers);
  }

  newton::Limits limits_;
  double guard_ = 0.5;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::ActiveSet>(
    bowstring::Kind::solver, "active-set",
    "Newton's method on the complementarity system, made for warm starts; from cold after a barrier method",
    bowstring::schema))
