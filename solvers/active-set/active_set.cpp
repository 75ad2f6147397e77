#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/hand_over.hpp"
#include "solvers/newton/lent_system.hpp"
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

/// From cold the barrier method hands over as soon as the active set has taken shape. N mm
constexpr double hand_overs[] = {1e-3, 1e-5, 1e-7};

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
      const newton::Ending ending =
          newton::solve_by_hand_over(point, progress, {hand_overs, std::size(hand_overs)}, multipliers);
      lent_.keep(problem, point.q, multipliers);
      out.q = point.q;
      out.multipliers = multipliers;
      out.claim = ending.claim;
      out.reason = ending.reason;
    });
  }

  Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept override {
    return guard([&] {
      if (Status status = lent_.solve(right_hand_side, out); !status.ok()) throw StatusError(status);
    });
  }

 private:
  newton::Limits limits_;
  newton::LentSystem lent_;
  double guard_ = 0.5;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::ActiveSet>(
    bowstring::Kind::solver, "active-set",
    "Newton's method on the complementarity system, made for warm starts; from cold after a barrier method",
    bowstring::schema))
