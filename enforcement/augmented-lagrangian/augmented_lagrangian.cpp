#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/enforcement/row_choice.hpp"
#include "core/enforcement/softened_problem.hpp"
#include "core/interfaces/enforcement.hpp"
#include "enforcement/augmented-lagrangian/law.hpp"
#include "enforcement/shared/bias.hpp"
#include "enforcement/shared/keys.hpp"
#include "enforcement/shared/row_sides.hpp"
#include "enforcement/shared/solves.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

using augmented::AugmentedLaw;
using softening::RowSides;

constexpr ParameterDeclaration schema[] = {
    softening::first_weight_key,
    {.key = "growth",
     .type = ParameterType::scalar,
     .unit = "",
     .default_text = "10",
     .description =
         "the weight grows by this where a solve has not brought rows four times nearer to what they have to "
         "be; 1: never",
     .lower = 1.0},
    {.key = "tolerance",
     .type = ParameterType::scalar,
     .unit = "",
     .default_text = "1e-8",
     .description = "absolute target: rows in mm, complementarity in N mm; that of stationarity is the solver's",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "max-outer-iterations",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "50",
     .description = "solves of what remains; the solver's own limits are of each of them",
     .lower = 1.0},
    softening::on_key,
};

constexpr double enough_progress = 0.25;  // of what rows miss, from solve to solve
constexpr double first_share = 0.1;       // of the change of multipliers: the stationarity that ends a solve
constexpr double share_falls = 0.5, least_share = 1e-3;
constexpr double settled_multipliers = 1e-7;  // of the largest one
constexpr double settling = 0.5;              // a change that falls by less is at its rounding
constexpr double rounding_share = 0.1;        // of the tolerance that rounding of rows may make of forces

/// How far rows and multipliers are from where they belong.
struct Distance {
  double change = 0.0;           ///< N, largest change of a multiplier that is due
  double largest = 0.0;          ///< N, of the multipliers after it
  double violation = 0.0;        ///< mm
  double complementarity = 0.0;  ///< N mm, with the multipliers after it
};

/// The method of multipliers. See README.md.
class AugmentedLagrangian final : public Enforcement {
 public:
  explicit AugmentedLagrangian(const ParameterSet& parameters)
      : first_weight_(parameters.scalar("first-weight")),
        growth_(parameters.scalar("growth")),
        tolerance_(parameters.scalar("tolerance")),
        most_solves_(static_cast<int>(parameters.integer("max-outer-iterations"))),
        on_(softening::named_constraints(parameters)) {}

  Status remaining(const ProblemSummary& problem, ProblemSummary& out) const noexcept override {
    return guard([&] { return without_rows(problem, on_, out); });
  }

  Status solve(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] { return run(problem, solver, start, context, out); });
  }

 private:
  void begin(Problem& problem, const SolverContext& context, std::vector<double>& kept) {
    sides_ = std::make_unique<RowSides>(problem);
    law_ = std::make_unique<AugmentedLaw>(*sides_, problem.rows());
    law_->weight = first_weight_;
    remaining_ = std::make_unique<SoftenedProblem>(problem, chosen_rows(problem, on_), *law_);
    if (context.multipliers.size() != law_->multipliers.size()) return;
    std::copy(context.multipliers.begin(), context.multipliers.end(), law_->multipliers.begin());
    kept.resize(remaining_->kept_rows().size());
    remaining_->gather(context.multipliers, kept);
  }

  /// At the rows that were last evaluated.
  Distance distance() const noexcept {
    Distance out;
    for (const int r : remaining_->soft_rows()) {
      const auto row = static_cast<std::size_t>(r);
      const double value = remaining_->last_rows()[row], force = law_->at(r, value).force;
      out.change = std::max(out.change, std::fabs(force - law_->multipliers[row]));
      out.largest = std::max(out.largest, std::fabs(force));
      out.violation = std::max(out.violation, sides_->violation(r, value));
      if (force != 0.0) {
        out.complementarity = std::max(out.complementarity, std::fabs(force * sides_->excess(r, value, force)));
      }
    }
    return out;
  }

  bool holds(const Distance& now) const noexcept {
    return now.violation <= tolerance_ && now.complementarity <= tolerance_;
  }

  Status run(Problem& problem, Solver& solver, Span<const double> start, const SolverContext& context,
             SolverResult& out) {
    out = {};
    std::vector<double> kept;
    begin(problem, context, kept);
    softening::Solves solves(context, *sides_, out);
    out.q.assign(start.begin(), start.end());
    double share = first_share, missed = 0.0, change = 0.0;
    for (int k = 1;; ++k) {
      // A solve need be no more exact than the multipliers that it is to correct.
      const auto enough = [&](const IterationRecord& record) {
        const Distance now = distance();
        return !holds(now) && record.stationarity <= share * now.change;
      };
      SolverResult found;
      if (Status status = solves.run(*remaining_, solver, out.q, kept, enough, found); !status.ok()) return status;
      out.q = found.q;
      out.claim = found.claim;
      out.reason = found.reason;
      std::vector<double> rows(static_cast<std::size_t>(remaining_->rows()));
      ProblemEvaluation wanted;
      wanted.rows = rows;
      if (Status status = remaining_->evaluate(out.q, wanted); !status.ok()) return status;
      const Distance now = distance();
      update_multipliers();
      report(k, kept, out);
      if (!solves.was_enough() && out.claim != Claim::optimal) {
        out.reason += in_solve(k, now);
        return {};
      }
      const bool settled = now.change <= settled_multipliers * now.largest || (k > 1 && now.change > settling * change);
      if (out.claim == Claim::optimal && holds(now) && settled) {
        out.reason += in_solve(k, now);
        return {};
      }
      if (k == most_solves_) {
        out.claim = Claim::stalled;
        out.reason = "the limit of outer iterations was reached" + in_solve(k, now);
        return {};
      }
      if (k > 1 && now.change / law_->weight > enough_progress * missed) grow();
      missed = now.change / law_->weight;
      change = now.change;
      share = std::max(least_share, share_falls * share);
    }
  }

  void update_multipliers() {
    for (const int r : remaining_->soft_rows()) {
      const auto row = static_cast<std::size_t>(r);
      law_->multipliers[row] = law_->at(r, remaining_->last_rows()[row]).force;
    }
  }

  /// As far as rounding of rows lets it.
  void grow() {
    const double most = rounding_share * tolerance_ / std::max(remaining_->row_rounding(), 1e-300);
    law_->weight = std::max(law_->weight, std::min(growth_ * law_->weight, most));
  }

  void report(int solves, const std::vector<double>& kept, SolverResult& out) const {
    out.multipliers.clear();
    if (kept.size() == remaining_->kept_rows().size()) {
      out.multipliers = law_->multipliers;
      remaining_->spread(kept, out.multipliers);
    }
    const softening::Bias bias = softening::bias_of(*remaining_, *sides_, remaining_->last_rows(), law_->multipliers);
    out.enforcement.outer_iterations = solves;
    out.enforcement.weight = law_->weight;
    out.enforcement.penetration = bias.violation;
    out.enforcement.energy = bias.energy;
  }

  std::string in_solve(int k, const Distance& now) const {
    using softening::number;
    return ", in solve " + std::to_string(k) + " of the augmented Lagrangian: weight " + number(law_->weight) +
           " N/mm, rows to " + number(now.violation) + " mm, complementarity " + number(now.complementarity) +
           " N mm, multipliers to " + number(now.change) + " N";
  }

  double first_weight_, growth_, tolerance_;
  int most_solves_;
  std::vector<std::string> on_;
  // Of the last solve: a solver may lend its system afterwards.
  std::unique_ptr<RowSides> sides_;
  std::unique_ptr<AugmentedLaw> law_;
  std::unique_ptr<SoftenedProblem> remaining_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Enforcement, bowstring::AugmentedLagrangian>(
    bowstring::Kind::enforcement, "augmented-lagrangian",
    "Rows become energies with multipliers that are corrected until the rows hold", bowstring::schema))
