#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/lent_system.hpp"
#include "solvers/shared/backend.hpp"
#include "solvers/trust-region/method.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    {.key = "max-iterations",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "500",
     .description = "accepted steps, over all epochs",
     .lower = 1.0},
    backend::time_limit_key,
    backend::step_guard_key,
    {.key = "first-radius",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = "",
     .description =
         "how far the first step may go: root mean square of displacements, and of rotations times 1/2π of the "
         "scene's extent; without it a twentieth of that extent",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "leave-saddles",
     .type = ParameterType::flag,
     .unit = "",
     .default_text = "true",
     .description = "go on along negative curvature where all forces balance; false: stop there and say what it is"},
};

class TrustRegion final : public Solver {
 public:
  explicit TrustRegion(const ParameterSet& parameters) {
    limits_.tolerance = parameters.scalar("tolerance");
    limits_.max_iterations = static_cast<int>(parameters.integer("max-iterations"));
    limits_.time_limit = backend::time_limit(parameters);
    guard_ = backend::step_guard(parameters);
    if (parameters.has("first-radius")) settings_.first_radius = parameters.scalar("first-radius");
    settings_.leave_saddles = parameters.flag("leave-saddles");
  }

  SolverTraits traits() const noexcept override {
    SolverTraits traits;
    traits.inequalities = false;
    traits.window_segments = 2;
    traits.window_length = 0.0;
    return traits;
  }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] {
      if (summary.inequalities > 0) {
        throw StatusError(Code::unsupported,
                          "trust-region takes no inequality rows (" + std::to_string(summary.inequalities) +
                              "), such as those of contact: use 'interior-point', or an enforcement that turns them "
                              "into energies");
      }
      backend::check_equalities("trust-region", summary);
    });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] {
      const backend::Guarded guarded(problem, guard_);
      newton::Point point(problem, out);
      point.q.assign(start.begin(), start.end());
      newton::Progress progress(limits_, context, out);
      std::vector<double> multipliers(context.multipliers.begin(), context.multipliers.end());
      trust_region::Method method(point, progress, settings_);
      const newton::Ending ending = method.run(multipliers);
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
  trust_region::Settings settings_;
  double guard_ = 0.5;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::TrustRegion>(
    bowstring::Kind::solver, "trust-region",
    "Trust region on manifolds for problems without inequality rows: exact Hessians, negative curvature is used, and "
    "saddles are left",
    bowstring::schema))
