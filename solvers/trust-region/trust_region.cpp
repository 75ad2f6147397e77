#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/native_backend.hpp"
#include "solvers/trust-region/method.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    backend::max_iterations_key("500", "accepted steps, over all epochs"),
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
  explicit TrustRegion(const ParameterSet& parameters) : backend_(parameters) {
    if (parameters.has("first-radius")) settings_.first_radius = parameters.scalar("first-radius");
    settings_.leave_saddles = parameters.flag("leave-saddles");
  }

  SolverTraits traits() const noexcept override {
    SolverTraits traits = newton::NativeBackend::traits();
    traits.inequalities = false;
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
    return backend_.solve(problem, start, context, out,
                          [&](newton::Point& point, newton::Progress& progress, std::vector<double>& multipliers) {
                            return trust_region::Method(point, progress, settings_).run(multipliers);
                          });
  }

  Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept override {
    return backend_.solve_kkt(right_hand_side, out);
  }

 private:
  newton::NativeBackend backend_;
  trust_region::Settings settings_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::TrustRegion>(
    bowstring::Kind::solver, "trust-region",
    "Trust region on manifolds for problems without inequality rows: exact Hessians, negative curvature is used, and "
    "saddles are left",
    bowstring::schema))
