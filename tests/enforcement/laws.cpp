#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/check/differences.hpp"
#include "enforcement/augmented-lagrangian/law.hpp"
#include "enforcement/penalty/law.hpp"
#include "tests/solvers/row_problem.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rows of every kind: above, below, both sides, equality.
RowProblem problem_of_rows() {
  const std::vector<double> x = {1.0, 0.0, 0.0};
  return RowProblem({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0},
                    {{x, -infinity, 0.5}, {x, -0.25, infinity}, {x, -0.5, 0.75}, {x, 0.125, 0.125}});
}

/// φ' and φ'' against differences at `value`, which no kink is near.
void check_law(const RowLaw& law, int row, double value) {
  CAPTURE(row);
  CAPTURE(value);
  const auto energy = [&](double t) { return law.at(row, value + t).energy; };
  const auto force = [&](double t) { return law.at(row, value + t).force; };
  constexpr double h = 1e-3;
  const RowEnergy found = law.at(row, value);
  const double size = 1.0 + std::fabs(found.energy) + std::fabs(found.force) + found.stiffness;
  CHECK(std::fabs(first_difference(energy(-2.0 * h), energy(-h), energy(h), energy(2.0 * h), h) - found.force) <=
        1e-8 * size);
  CHECK(std::fabs(first_difference(force(-2.0 * h), force(-h), force(h), force(2.0 * h), h) - found.stiffness) <=
        1e-7 * size);
  CHECK(found.stiffness <= 2.0 * law.stiffest());
}

}  // namespace

TEST_CASE("laws of rows: force and stiffness are derivatives of the energy, on every side") {
  const RowProblem problem = problem_of_rows();
  const softening::RowSides sides(problem);
  const penalty::PenaltyLaw<penalty::Quadratic> quadratic(sides, {40.0});
  const penalty::PenaltyLaw<penalty::LogQuadratic> logarithmic(sides, {40.0, 2.0});
  augmented::AugmentedLaw augmented(sides, problem.rows());
  augmented.weight = 40.0;
  augmented.multipliers = {3.0, -2.0, -1.5, 0.75};
  for (const RowLaw* law : {static_cast<const RowLaw*>(&quadratic), static_cast<const RowLaw*>(&logarithmic),
                            static_cast<const RowLaw*>(&augmented)}) {
    for (int row = 0; row < problem.rows(); ++row) {
      double pressed = 0.0;
      for (const double value : {-2.0, -0.65, -0.1, 0.3, 0.9, 3.0}) {
        check_law(*law, row, value);
        pressed = std::max(pressed, std::fabs(law->at(row, value).force));
      }
      CHECK(pressed > 10.0);
      if (row != 1) CHECK(law->at(row, 3.0).force > 0.0);
      if (row != 0) CHECK(law->at(row, -2.0).force < 0.0);
    }
  }
}

TEST_CASE("the logarithmic law is twice differentiable where its parabola begins, and presses with its force there") {
  const RowProblem problem = problem_of_rows();
  const softening::RowSides sides(problem);
  constexpr double weight = 1e4, force = 1e-2, d = force / weight;
  const penalty::PenaltyLaw<penalty::LogQuadratic> law(sides, {weight, force});
  const RowEnergy before = law.at(0, 0.5 - d * (1.0 + 1e-9)), after = law.at(0, 0.5 - d * (1.0 - 1e-9));
  CHECK(before.force == doctest::Approx(force));
  CHECK(std::fabs(before.energy) <= 1e-8 * force * d);
  CHECK(after.force == doctest::Approx(before.force).epsilon(1e-8));
  CHECK(after.stiffness == doctest::Approx(before.stiffness).epsilon(1e-8));
  CHECK(after.stiffness == weight);
  // Far inside a row costs little and presses little: f²/(w |r|).
  CHECK(law.at(0, -0.5).force == doctest::Approx(force * d));
}

TEST_CASE("the augmented law is that of the row's multiplier at zero, and nothing changes where it has come to rest") {
  const RowProblem problem = problem_of_rows();
  const softening::RowSides sides(problem);
  augmented::AugmentedLaw law(sides, problem.rows());
  law.weight = 100.0;
  law.multipliers = {3.0, -2.0, 1.5, -0.75};
  const double bounds[] = {0.5, -0.25, 0.75, 0.125};
  for (int row = 0; row < problem.rows(); ++row) {
    CHECK(law.at(row, bounds[row]).force == law.multipliers[static_cast<std::size_t>(row)]);
    CHECK(std::fabs(law.at(row, bounds[row]).energy) <= 0.1);
  }
  CHECK(law.at(0, 0.4).force == 0.0);  // further inside than its multiplier reaches
}

}  // namespace bowstring::testing
