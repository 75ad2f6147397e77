#include "core/interfaces/enforcement.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

/// Rows are left to the solver as they stand: the exact treatment, whose multipliers are the contact forces
/// (preprint eq. (22) and the KKT conditions after it).
class Kkt final : public Enforcement {
 public:
  explicit Kkt(const ParameterSet&) {}

  Status remaining(const ProblemSummary& problem, ProblemSummary& out) const noexcept override {
    return guard([&] { out = problem; });
  }

  Status solve(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return solver.solve(problem, start, context, out);
  }
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Enforcement, bowstring::Kkt>(
    bowstring::Kind::enforcement, "kkt", "Rows are left to the solver: exact, with multipliers as contact forces"))
