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
     .description = "over all epochs",
     .lower = 1.0},
    backend::time_limit_key,
    backend::step_guard_key,
};

/// The last subproblems of the barrier are left to an active-set method: their rows are known by then. N mm
constexpr double hand_overs[] = {1e-4, 1e-6};

class InteriorPoint final : public Solver {
 public:
  explicit InteriorPoint(const ParameterSet& parameters) : backend_(parameters) {}

  SolverTraits traits() const noexcept override { return newton::NativeBackend::traits(); }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] { backend::check_equalities("interior-point", summary); });
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

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::InteriorPoint>(
    bowstring::Kind::solver, "interior-point",
    "Primal-dual interior point with a filter, exact Hessians, and factors in the order along the curves",
    bowstring::schema))
