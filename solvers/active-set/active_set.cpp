#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/hand_over.hpp"
#include "solvers/newton/native_backend.hpp"

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
  explicit ActiveSet(const ParameterSet& parameters) : backend_(parameters) {}

  SolverTraits traits() const noexcept override { return newton::NativeBackend::traits(); }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] { backend::check_equalities("active-set", summary); });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return backend_.solve(
        problem, start, context, out,
        [](newton::Point& point, newton::Progress& progress, std::vector<double>& multipliers) {
          return newton::solve_by_hand_over(point, progress, {hand_overs, std::size(hand_overs)}, multipliers);
        });
  }

  Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept override {
    return backend_.solve_kkt(right_hand_side, out);
  }

 private:
  newton::NativeBackend backend_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::ActiveSet>(
    bowstring::Kind::solver, "active-set",
    "Newton's method on the complementarity system, made for warm starts; from cold after a barrier method",
    bowstring::schema))
