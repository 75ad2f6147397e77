#include "plugins/sdk/plugin.hpp"
#include "solvers/newton/hand_over_solver.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    backend::max_iterations_key("300", "over all epochs and both methods"),
    backend::time_limit_key,
    backend::step_guard_key,
};

/// From cold the barrier method hands over as soon as the active set has taken shape.
struct ActiveSet {
  static constexpr const char* name = "active-set";
  static constexpr double hand_overs[] = {1e-3, 1e-5, 1e-7};  // N mm
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::newton::HandOverSolver<bowstring::ActiveSet>>(
    bowstring::Kind::solver, bowstring::ActiveSet::name,
    "Newton's method on the complementarity system, made for warm starts; from cold after a barrier method",
    bowstring::schema))
