#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/hand_over_solver.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    backend::max_iterations_key("300", "over all epochs"),
    backend::time_limit_key,
    backend::step_guard_key,
};

/// The last subproblems of the barrier are left to the active-set method: their rows are known by then.
struct InteriorPoint {
  static constexpr const char* name = "interior-point";
  static constexpr double hand_overs[] = {1e-4, 1e-6};  // N mm
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::newton::HandOverSolver<bowstring::InteriorPoint>>(
    bowstring::Kind::solver, bowstring::InteriorPoint::name,
    "Primal-dual interior point with a filter, exact Hessians, and factors in the order along the curves",
    bowstring::schema))
