#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/enforcement/row_choice.hpp"
#include "core/enforcement/softened_problem.hpp"
#include "core/interfaces/enforcement.hpp"
#include "enforcement/penalty/law.hpp"
#include "enforcement/shared/bias.hpp"
#include "enforcement/shared/keys.hpp"
#include "enforcement/shared/row_sides.hpp"
#include "enforcement/shared/solves.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

using namespace penalty;
using softening::RowSides;

constexpr ParameterDeclaration schema[] = {
    {.key = "weight",
     .type = ParameterType::scalar,
     .unit = "N/mm",
     .default_text = "\"1e4 N/mm\"",
     .description = "stiffness of a row: one that presses with a force gives way by the force over this",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "form",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"quadratic\"",
     .description =
         "quadratic: nothing until a row is violated; log-quadratic: a logarithmic barrier that goes on as a "
         "parabola, twice differentiable",
     .choices = "quadratic|log-quadratic"},
    {.key = "smoothing-force",
     .type = ParameterType::scalar,
     .unit = "N",
     .default_text = "\"0.01 N\"",
     .description = "of log-quadratic: where a row's barrier presses with it the parabola begins; without effect with "
                    "quadratic",
     .lower = 0.0,
     .lower_exclusive = true},
    softening::first_weight_key,
    softening::on_key,
    {.key = "bias",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"estimated\"",
     .description = "what exact rows would change: estimated from the multipliers, or also measured by another solve, "
                    "with exact rows, that the result does not take part in",
     .choices = "estimated|measured"},
};

constexpr double weight_rises = 10.0;
constexpr double intermediate = 0.1;  // of the largest force: the stationarity that ends a solve with a smaller weight

/// Rows become energies of a given stiffness. See README.md.
class Penalty final : public Enforcement {
 public:
  explicit Penalty(const ParameterSet& parameters)
      : weight_(parameters.scalar("weight")),
        first_weight_(parameters.scalar("first-weight")),
        smoothing_force_(parameters.scalar("smoothing-force")),
        smooth_(parameters.text("form") == "log-quadratic"),
        measured_(parameters.text("bias") == "measured"),
        on_(softening::named_constraints(parameters)) {}

  Status remaining(const ProblemSummary& problem, ProblemSummary& out) const noexcept override {
    return guard([&] { return without_rows(problem, on_, out); });
  }

  Status solve(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] { return run(problem, solver, start, context, out); });
  }

 private:
  std::unique_ptr<WeightedLaw> make_law() const {
    if (smooth_) {
      return std::make_unique<PenaltyLaw<LogQuadratic>>(*sides_, LogQuadratic{weight_, smoothing_force_});
    }
    return std::make_unique<PenaltyLaw<Quadratic>>(*sides_, Quadratic{weight_});
  }

  Status run(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
             SolverResult& out) {
    sides_ = std::make_unique<RowSides>(problem);
    law_ = make_law();
    remaining_ = std::make_unique<SoftenedProblem>(problem, chosen_rows(problem, on_), *law_);
    out = {};
    softening::Solves solves(context, *sides_, out);
    std::vector<double> kept(context.multipliers.empty() ? 0 : remaining_->kept_rows().size());
    if (!kept.empty()) remaining_->gather(context.multipliers, kept);
    out.q.assign(start.begin(), start.end());
    const bool near = !context.multipliers.empty() || remaining_->soft_rows().empty();
    if (Status status = climb(solver, solves, near, kept, out); !status.ok()) return status;
    return judge(problem, solver, kept, context, out);
  }

  /// Solves with weights that rise to the one asked for, which is the first one where the start is `near` a solution.
  Status climb(Solver& solver, softening::Solves& solves, bool near, std::vector<double>& kept, SolverResult& out) {
    double weight = near ? weight_ : std::min(weight_, first_weight_);
    for (int k = 1;; ++k, weight = std::min(weight_, weight_rises * weight)) {
      law_->set_weight(weight);
      const auto enough = [&](const IterationRecord& record) {
        return weight < weight_ && record.stationarity <= intermediate * largest_force();
      };
      SolverResult found;
      if (Status status = solves.run(*remaining_, solver, out.q, kept, enough, found); !status.ok()) return status;
      out.q = found.q;
      out.claim = found.claim;
      out.reason = found.reason;
      out.enforcement.outer_iterations = k;
      out.enforcement.weight = weight;
      if (weight == weight_ || (!solves.was_enough() && out.claim != Claim::optimal)) return {};
    }
  }

  /// N, of the rows taken away, at the point that was last evaluated.
  double largest_force() const noexcept {
    double largest = 0.0;
    for (const int r : remaining_->soft_rows()) {
      largest = std::max(largest, std::fabs(law_->at(r, remaining_->last_rows()[static_cast<std::size_t>(r)]).force));
    }
    return largest;
  }

  /// What the rows are left with, and what that costs.
  Status judge(Problem& problem, Solver& solver, const std::vector<double>& kept, const SolverContext& context,
               SolverResult& out) {
    std::vector<double> rows(static_cast<std::size_t>(problem.rows())), multipliers(rows.size(), 0.0);
    double energy = 0.0;
    ProblemEvaluation wanted;
    wanted.energy = &energy;
    wanted.rows = rows;
    if (Status status = problem.evaluate(out.q, wanted); !status.ok()) return status;
    const bool all_known = kept.size() == remaining_->kept_rows().size();
    if (all_known) remaining_->spread(kept, multipliers);
    for (const int r : remaining_->soft_rows()) {
      const auto row = static_cast<std::size_t>(r);
      multipliers[row] = law_->at(r, rows[row]).force;
    }
    if (all_known) out.multipliers = multipliers;

    const softening::Bias bias = softening::bias_of(*remaining_, *sides_, rows, multipliers);
    out.enforcement.penetration = bias.violation;
    out.enforcement.energy = bias.energy;
    std::string measured;
    if (measured_ && all_known && out.claim == Claim::optimal) {
      if (Status status = measure(problem, solver, energy, multipliers, context, out, measured); !status.ok()) {
        return status;
      }
    }
    if (remaining_->soft_rows().empty()) return {};
    if (out.claim == Claim::optimal && *out.enforcement.weight == weight_) {
      out.reason += describe(bias, measured);
    } else {
      out.reason += ", with the penalty's weight at " + softening::number(*out.enforcement.weight) + " of " +
                    softening::number(weight_) + " N/mm";
    }
    return {};
  }

  std::string describe(const softening::Bias& bias, const std::string& measured) const {
    using softening::number;
    return "; the penalty's weight " + number(weight_) + " N/mm leaves a bias: rows are violated by up to " +
           number(bias.violation) + " mm, complementarity is up to " + number(bias.complementarity) +
           " N mm, and exact rows would add about " + number(bias.energy) + " N mm to the energy" + measured +
           "; for less take a larger weight (the bias falls as 1/weight) or type = \"augmented-lagrangian\", or accept "
           "it by setting 'penetration' and 'complementarity' of [certificate] above these";
  }

  /// Solves with exact rows from the state found, and leaves that as the accepted one.
  Status measure(Problem& problem, Solver& solver, double energy, const std::vector<double>& multipliers,
                 const SolverContext& context, SolverResult& out, std::string& said) const {
    Status able = solver.can(problem.summary());
    if (able.ok() && !solver.traits().inequalities && problem.summary().inequalities > 0) {
      able = Status::failure(Code::unsupported, "it takes no inequality rows");
    }
    if (!able.ok()) {
      said = " (not measured: with exact rows the solver refuses the problem: " + able.text + ")";
      return {};
    }
    SolverContext exact_context;
    exact_context.multipliers = multipliers;
    exact_context.on_iteration = [&](const IterationRecord& solved) {
      IterationRecord record = solved;
      record.iteration += out.iterations;
      return solved.iteration == 0 || !context.on_iteration || context.on_iteration(record);
    };
    SolverResult exact;
    Status status = solver.solve(problem, out.q, exact_context, exact);
    if (status.ok() && exact.claim == Claim::optimal) {
      double exact_energy = 0.0;
      ProblemEvaluation wanted;
      wanted.energy = &exact_energy;
      status = problem.evaluate(exact.q, wanted);
      if (status.ok()) {
        const double motion = problem.largest_motion(out.q, exact.q);
        out.enforcement.measured_energy = exact_energy - energy;
        if (std::isfinite(motion)) out.enforcement.measured_motion = motion;
      }
    }
    if (!status.ok() || exact.claim != Claim::optimal) {
      said =
          " (not measured: the solve with exact rows ended with: " + (status.ok() ? exact.reason : status.text) + ")";
    }
    status = problem.accept(out.q);
    return status.ok() && problem.epoch_due() ? problem.new_epoch() : status;
  }

  double weight_, first_weight_, smoothing_force_;
  bool smooth_, measured_;
  std::vector<std::string> on_;
  // Of the last solve: a solver may lend its system afterwards.
  std::unique_ptr<RowSides> sides_;
  std::unique_ptr<WeightedLaw> law_;
  std::unique_ptr<SoftenedProblem> remaining_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Enforcement, bowstring::Penalty>(
    bowstring::Kind::enforcement, "penalty",
    "Rows become energies of a given stiffness, with a bias that falls as 1/weight", bowstring::schema))
