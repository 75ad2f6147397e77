#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/enforcement/row_choice.hpp"
#include "core/enforcement/softened_problem.hpp"
#include "core/interfaces/enforcement.hpp"
#include "enforcement/shared/bias.hpp"
#include "enforcement/shared/keys.hpp"
#include "enforcement/shared/row_sides.hpp"
#include "enforcement/shared/solves.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

using softening::RowSides;

constexpr ParameterDeclaration schema[] = {
    {.key = "weight",
     .type = ParameterType::scalar,
     .unit = "N/mm",
     .default_text = "\"1e4 N/mm\"",
     .description = "stiffness of a row: one that presses with a force gives way by the force over this",
     .lower = 0.0,
     .lower_exclusive = true,
     .differentiable = true},
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
    softening::on_key,
    {.key = "bias",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"estimated\"",
     .description = "what exact rows would change: estimated from the multipliers, or also measured by another solve, "
                    "with exact rows, that the result does not take part in",
     .choices = "estimated|measured"},
};

/// Of r ≤ 0: φ = ½ w max(r, 0)².
struct Quadratic {
  double weight = 0.0;
  RowEnergy operator()(double r) const noexcept {
    if (!(r > 0.0)) return {};
    return {0.5 * weight * r * r, weight * r, weight};
  }
};

/// Of r ≤ 0, with d = f/w: φ = −(f²/w) ln(−r/d) up to r = −d, and from there its Taylor polynomial of second order.
struct LogQuadratic {
  double weight = 0.0, force = 0.0;
  RowEnergy operator()(double r) const noexcept {
    const double d = force / weight;
    if (r <= -d) {
      const double barrier = force * d;
      return {-barrier * std::log(-r / d), -barrier / r, barrier / (r * r)};
    }
    const double t = r + d;
    return {force * t + 0.5 * weight * t * t, force + weight * t, weight};
  }
};

/// φ over the finite sides of a row; an equality row has the parabola ½ w r² on both.
template <class Form>
class PenaltyLaw final : public RowLaw {
 public:
  PenaltyLaw(const RowSides& sides, const Form& form) : sides_(sides), form_(form) {}

  RowEnergy at(int row, double value) const noexcept override {
    const double lower = sides_.lower(row), upper = sides_.upper(row);
    if (lower == upper) {
      const double off = value - upper;
      return {0.5 * form_.weight * off * off, form_.weight * off, form_.weight};
    }
    RowEnergy out;
    if (std::isfinite(upper)) out = form_(value - upper);
    if (std::isfinite(lower)) {
      const RowEnergy side = form_(lower - value);
      out.energy += side.energy;
      out.force -= side.force;
      out.stiffness += side.stiffness;
    }
    return out;
  }
  double stiffest() const noexcept override { return form_.weight; }

 private:
  const RowSides& sides_;
  Form form_;
};

/// Rows become energies of a given stiffness. See README.md.
class Penalty final : public Enforcement {
 public:
  explicit Penalty(const ParameterSet& parameters)
      : weight_(parameters.scalar("weight")),
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
  std::unique_ptr<RowLaw> make_law() const {
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
    SolverResult found;
    if (Status status = solves.run(*remaining_, solver, {start.begin(), start.end()}, kept, {}, found); !status.ok()) {
      return status;
    }
    out.q = found.q;
    out.claim = found.claim;
    out.reason = found.reason;
    out.enforcement.weight = weight_;
    return judge(problem, solver, solves, kept, context, out);
  }

  /// What the rows are left with, and what that costs.
  Status judge(Problem& problem, Solver& solver, const softening::Solves& solves, const std::vector<double>& kept,
               const SolverContext& context, SolverResult& out) {
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
    if (measured_ && all_known && !solves.stopped_by_user()) {
      if (Status status = measure(problem, solver, energy, multipliers, context, out, measured); !status.ok()) {
        return status;
      }
    }
    if (!remaining_->soft_rows().empty()) out.reason += describe(bias, measured);
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

  double weight_, smoothing_force_;
  bool smooth_, measured_;
  std::vector<std::string> on_;
  // Of the last solve: a solver may lend its system afterwards.
  std::unique_ptr<RowSides> sides_;
  std::unique_ptr<RowLaw> law_;
  std::unique_ptr<SoftenedProblem> remaining_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Enforcement, bowstring::Penalty>(
    bowstring::Kind::enforcement, "penalty",
    "Rows become energies of a given stiffness, with a bias that falls as 1/weight", bowstring::schema))
