#include <doctest/doctest.h>

#include <vector>

#include "core/enforcement/row_choice.hpp"
#include "core/enforcement/softened_problem.hpp"
#include "enforcement/penalty/law.hpp"
#include "tests/allocations.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

TEST_CASE("evaluations of a softened problem and of its charts allocate nothing") {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      SmallScene scene;
      scene.dimension = dimension;
      scene.vessel_kinematics = scene.wire_kinematics = kinematics;
      const auto session = session_of(scene);
      Assembly& assembly = *session->assembly;
      const softening::RowSides sides(assembly);
      const penalty::PenaltyLaw<penalty::LogQuadratic> law(sides, {10.0, 1.0});
      SoftenedProblem softened(assembly, chosen_rows(assembly, {}), law);
      REQUIRE_FALSE(softened.soft_rows().empty());
      softened.set_guard(1e6);
      double energy = 0.0;
      std::vector<double> gradient(at(softened.unknowns())), rows(at(softened.rows())),
          jacobian(at(softened.jacobian_pattern().entries())), hessian(at(softened.hessian_pattern().entries()));
      const std::vector<double> multipliers = random_numbers(softened.rows(), 3);
      ProblemEvaluation wanted;
      wanted.energy = &energy;
      wanted.gradient = gradient;
      wanted.rows = rows;
      wanted.jacobian = jacobian;
      bool good = true;
      const auto round = [&](const std::vector<double>& q) {
        good = good && softened.evaluate(q, wanted).ok();
        good = good && softened.lagrangian_hessian(q, 1.0, multipliers, hessian).ok();
        good = good && softened.accept(q).ok();
      };
      const std::vector<double> q[] = {moved_start(*session, 0.1, 1), moved_start(*session, 0.2, 2)};
      round(q[0]);
      REQUIRE(good);
      CHECK(allocations_of([&] { round(q[1]); }) == 0);
      CHECK(good);
      REQUIRE(largest(hessian) > 0.0);

      const auto chart = softened.chart(q[0]);
      std::vector<double> x(gradient.size()), y;
      chart->start(x);
      y = x;
      const std::vector<double> step = random_numbers(softened.unknowns(), 4);
      for (std::size_t u = 0; u < y.size(); ++u) y[u] += 0.02 * step[u];
      const auto charted = [&](const std::vector<double>& point) {
        good = good && chart->evaluate(point, wanted).ok();
        good = good && chart->lagrangian_hessian(point, 1.0, multipliers, hessian).ok();
      };
      charted(x);
      REQUIRE(good);
      CHECK(allocations_of([&] { charted(y); }) == 0);
      CHECK(good);
    }
  }
}

}  // namespace bowstring::testing
