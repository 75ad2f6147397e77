#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/certificate/multipliers.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr double reach = 1e-6;  // mm, as a session asks

/// |g + Jᵀλ| over all free unknowns, each in N.
double residual(Session& session, const std::vector<double>& q, const std::vector<double>& multipliers) {
  std::vector<double> gradient;
  REQUIRE(session.assembly->full_gradient(q, multipliers, gradient).ok());
  double sum = 0.0;
  for (std::size_t u = 0; u < gradient.size(); ++u) {
    const int free = session.assembly->free_of_unknown()[u];
    if (free < 0) continue;
    const double entry = gradient[u] / session.assembly->stationarity_scale()[at(free)];
    sum += entry * entry;
  }
  return std::sqrt(sum);
}

struct Rows {
  std::vector<int> active, inactive;  ///< inequality rows within reach of their bound, and the others
};

Rows rows_of(Session& session, const std::vector<double>& q) {
  std::vector<double> value(at(session.assembly->rows()));
  ProblemEvaluation evaluation;
  evaluation.rows = value;
  REQUIRE(session.assembly->evaluate(q, evaluation).ok());
  Rows out;
  for (int r = 0; r < session.assembly->rows(); ++r) {
    if (session.assembly->row_lower()[at(r)] == session.assembly->row_upper()[at(r)]) continue;
    (std::fabs(value[at(r)]) <= reach ? out.active : out.inactive).push_back(r);
  }
  return out;
}

}  // namespace

TEST_CASE("at a solution the estimated multipliers are the solver's, to 1e-6 N") {
  const std::vector<std::pair<const char*, std::vector<Override>>> scenes = {
      {"planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "40"}}},
      {"planar-iliac-smooth.toml",
       {{"vessel.iliac.geometry.nodes", "40"},
        {"vessel.iliac.kinematics", "nodes"},
        {"wire.lunderquist.kinematics", "nodes"}}},
      {"helical-iliac-full.toml", {{"vessel.iliac.geometry.nodes", "30"}}},
      {"tortuous-iliac.toml", {{"vessel.iliac.geometry.nodes", "100"}}}};
  for (const auto& [name, variant] : scenes) {
    CAPTURE(std::string(name));
    std::vector<Override> overrides = variant;
    overrides.push_back({"solver.tolerance", "1e-11"});  // so that no barrier is left on the rows
    const auto session = session_of_file(name, overrides);
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    REQUIRE_FALSE(solution.estimated_multipliers);
    REQUIRE(largest(solution.multipliers) > 0.1);
    std::vector<double> estimated;
    const Status status = estimate_multipliers(*session->assembly, solution.q, reach, estimated);
    REQUIRE_MESSAGE(status.ok(), status.text);
    CHECK(largest_difference(estimated, solution.multipliers) <= 1e-6);
  }
}

TEST_CASE("away from a solution the estimate is the non-negative least-squares one") {
  const auto session = session_of_file("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "40"}});
  const Solution solution = solve(*session, nullptr);
  REQUIRE(solution.certificate.verdict == Verdict::converged);
  // The solution's rows, at a vessel under another load: the gradient no longer vanishes.
  const auto other = session_of_file("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "40"},
                                                                  {"energy.anchoring.stiffness", "0.005 N/mm^2"}});
  REQUIRE(other->assembly->accept(solution.q).ok());
  const Rows rows = rows_of(*other, solution.q);
  REQUIRE(rows.active.size() >= 2);
  std::vector<double> best;
  REQUIRE(estimate_multipliers(*other->assembly, solution.q, reach, best).ok());
  for (const int r : rows.active) CHECK(best[at(r)] >= 0.0);
  for (const int r : rows.inactive) CHECK(best[at(r)] == 0.0);
  const double least = residual(*other, solution.q, best);
  REQUIRE(least > 1e-6);
  // No admissible neighbour is better: first-order optimality of a convex problem, in every coordinate.
  for (int r = 0; r < other->assembly->rows(); ++r) {
    if (std::find(rows.inactive.begin(), rows.inactive.end(), r) != rows.inactive.end()) continue;
    for (const double step : {1e-5, -1e-5}) {
      std::vector<double> neighbour = best;
      neighbour[at(r)] += step;
      const bool signed_row = std::find(rows.active.begin(), rows.active.end(), r) != rows.active.end();
      if (signed_row && neighbour[at(r)] < 0.0) continue;
      CHECK(residual(*other, solution.q, neighbour) >= least * (1.0 - 1e-12));
    }
  }
}

}  // namespace bowstring::testing
