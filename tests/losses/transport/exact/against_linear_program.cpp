#include <doctest/doctest.h>
#include <glpk.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/transport/check_measure.hpp"
#include "problems.hpp"

using namespace exact_test;

namespace {

/// The least ⟨cost, plan⟩ by GLPK's simplex method, with sums scaled to one. That of the heaviest column follows from
/// the others and is left to itself: all of them together can be met only up to rounding.
double by_linear_program(const MatrixProblem& problem) {
  glp_term_out(GLP_OFF);
  const std::unique_ptr<glp_prob, decltype(&glp_delete_prob)> program(glp_create_prob(), &glp_delete_prob);
  const int rows = static_cast<int>(problem.a.size()), columns = static_cast<int>(problem.b.size());
  glp_set_obj_dir(program.get(), GLP_MIN);
  glp_add_rows(program.get(), rows + columns);
  glp_add_cols(program.get(), rows * columns);
  const double sum_a = std::accumulate(problem.a.begin(), problem.a.end(), 0.0);
  const double sum_b = std::accumulate(problem.b.begin(), problem.b.end(), 0.0);
  const int heaviest = static_cast<int>(std::max_element(problem.b.begin(), problem.b.end()) - problem.b.begin());
  for (int i = 0; i < rows; ++i) {
    const double sum = problem.a[static_cast<std::size_t>(i)] / sum_a;
    glp_set_row_bnds(program.get(), 1 + i, GLP_FX, sum, sum);
  }
  for (int j = 0; j < columns; ++j) {
    const double sum = problem.b[static_cast<std::size_t>(j)] / sum_b;
    glp_set_row_bnds(program.get(), 1 + rows + j, j == heaviest ? GLP_FR : GLP_FX, sum, sum);
  }
  for (int k = 0; k < rows * columns; ++k) {
    const int at[] = {0, 1 + k / columns, 1 + rows + k % columns};
    const double one[] = {0.0, 1.0, 1.0};
    glp_set_mat_col(program.get(), 1 + k, 2, at, one);
    glp_set_col_bnds(program.get(), 1 + k, GLP_LO, 0.0, 0.0);
    glp_set_obj_coef(program.get(), 1 + k, problem.cost[static_cast<std::size_t>(k)]);
  }
  glp_smcp settings;
  glp_init_smcp(&settings);
  settings.tol_bnd = 1e-12;
  settings.tol_dj = 1e-12;
  REQUIRE(glp_simplex(program.get(), &settings) == 0);
  REQUIRE(glp_get_status(program.get()) == GLP_OPT);
  return sum_a * glp_get_obj_val(program.get());
}

std::vector<double> with_zeros(std::mt19937& random, std::vector<double> weights) {
  for (double& weight : weights) {
    if (below(random, 3) == 0) weight = 0.0;
  }
  if (*std::max_element(weights.begin(), weights.end()) == 0.0) weights.back() = 1.0;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Whole numbers of shares of 1, so that partial sums meet.
std::vector<double> shares(std::mt19937& random, int count, int whole) {
  std::vector<double> out(static_cast<std::size_t>(count), 0.0);
  for (int k = 0; k < whole; ++k) out[static_cast<std::size_t>(below(random, count))] += 1.0;
  for (double& weight : out) weight /= whole;
  return out;
}

/// Problems of all kinds in turn: clouds, curves in order, ties, zero weights, shares, single places, sums that differ
/// by 1e-12.
MatrixProblem problem_of(std::mt19937& random, int number) {
  const int kind = number % 8;
  int rows = 1 + below(random, 14), columns = kind % 2 == 0 ? rows : 1 + below(random, 14);
  if (kind == 5) (below(random, 2) == 0 ? rows : columns) = 1;
  MatrixProblem out{
      uniform_weights(static_cast<std::size_t>(rows)), uniform_weights(static_cast<std::size_t>(columns)), {}};
  const bool curves = kind == 2;
  out.cost = squared_distances(curves ? random_curve(random, rows) : random_cloud(random, rows),
                               curves ? random_curve(random, columns) : random_cloud(random, columns));
  if (kind == 1 || kind == 5) {
    out.a = random_weights(random, rows);
    out.b = random_weights(random, columns);
  }
  if (kind == 3 || kind == 4) {
    for (double& cost : out.cost) cost = below(random, 4);
  }
  if (kind == 4 || kind == 6) {
    out.a = with_zeros(random, random_weights(random, rows));
    out.b = with_zeros(random, uniform_weights(static_cast<std::size_t>(columns)));
  }
  if (kind == 7) {
    const int whole = 1 + below(random, 12);
    out.a = shares(random, rows, whole);
    out.b = shares(random, columns, whole);
  }
  if (number % 5 == 0) {
    for (double& weight : out.b) weight *= 1.0 + 1e-12;
  }
  if (number % 7 == 0) {
    for (std::vector<double>* side : {&out.a, &out.b}) {
      for (double& weight : *side) weight *= 1e6;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a thousand problems of every kind: the linear program's value, with a proof") {
  std::mt19937 random(20);
  double worst = 0.0, mean_value = 0.0;
  for (int number = 0; number < 1000; ++number) {
    CAPTURE(number);
    const MatrixProblem problem = problem_of(random, number);
    const double expected = by_linear_program(problem);
    mean_value += expected / 1000.0;
    for (const std::string& method : exact_methods()) {
      CAPTURE(method);
      const TransportAnswer answer = solve_cold(method, problem);
      const double mass = std::accumulate(problem.a.begin(), problem.a.end(), 0.0);
      const double scale = std::max(std::fabs(expected), 1e-3 * mass * answer.certificate.cost_scale);
      const double error = scale > 0.0 ? std::fabs(answer.value - expected) / scale : std::fabs(answer.value);
      CHECK(error <= 1e-10);
      worst = std::max(worst, error);
      check_proof(problem, answer, number % 5 == 0 ? 2e-12 : 1e-12);
      CHECK(answer.plan.value.size() < problem.a.size() + problem.b.size());
    }
  }
  CHECK(mean_value > 1.0);
  MESSAGE("largest relative difference from the linear program: " << worst);
}

TEST_CASE("sums that differ by a thousandth are refused, with both") {
  for (const std::string& method : exact_methods()) {
    TransportComparison comparison = open_comparison(method);
    TransportAnswer answer;
    const Status status = solve_into(comparison, {{0.5, 0.5}, {0.5, 0.5005}, {0.0, 1.0, 1.0, 0.0}}, answer);
    CHECK(status.code == Code::invalid_input);
    CHECK(status.text.find("1.0005") != std::string::npos);
    CHECK(status.text.find("expected equal sums") != std::string::npos);
  }
}
