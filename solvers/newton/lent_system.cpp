#include "solvers/newton/lent_system.hpp"

#include <cmath>
#include <limits>

#include "solvers/newton/diagnosis.hpp"
#include "solvers/newton/sides.hpp"

namespace bowstring::newton {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double on_bound = 1e-6;  // of a bound's size, at least of 1
constexpr int refinements = 10;
constexpr double enough = 1e-6;  // relative residual

}  // namespace

void LentSystem::keep(Problem& problem, const std::vector<double>& q, const std::vector<double>& multipliers) {
  problem_ = &problem;
  epoch_ = problem.epochs();
  factorised_ = false;
  q_ = q;
  multipliers_ = multipliers;
  multipliers_.resize(at(problem.rows()), 0.0);
}

Status LentSystem::factor() {
  Problem& problem = *problem_;
  std::vector<double> rows(at(problem.rows())), value(at(problem.unknowns()));
  problem.values(q_, value);
  for (const Side& side : sides_of_unknowns(problem)) {
    if (-side.violation(value[at(side.index)]) > on_bound * std::max(1.0, std::fabs(side.bound))) continue;
    return Status::failure(Code::unsupported, "unknown " + std::to_string(side.index) +
                                                  " lies on its bound, and the system that is lent knows no bounds");
  }
  jacobian_.assign(at(problem.jacobian_pattern().entries()), 0.0);
  hessian_.assign(at(problem.hessian_pattern().entries()), 0.0);
  ProblemEvaluation wanted;
  wanted.rows = rows;
  wanted.jacobian = jacobian_;
  if (Status status = problem.evaluate(q_, wanted); !status.ok()) return status;
  // A row holds where its force is more than its distance: what a barrier leaves of either is small.
  std::vector<char> held(at(problem.rows()), 0);
  for (const int row : equality_rows(problem)) held[at(row)] = 1;
  for (const Side& side : sides_of_rows(problem)) {
    const double force = side.sign * multipliers_[at(side.index)];
    if (force > 0.0 && force > -side.violation(rows[at(side.index)])) held[at(side.index)] = 1;
  }
  for (int r = 0; r < problem.rows(); ++r) {
    if (held[at(r)] == 0) multipliers_[at(r)] = 0.0;
  }
  if (Status status = problem.lagrangian_hessian(q_, 1.0, multipliers_, hessian_); !status.ok()) return status;
  softness_.assign(at(problem.rows()), std::numeric_limits<double>::infinity());
  system_.analyse(problem, jacobian_, held);
  kkt::KktSystem::Values values;
  values.hessian = hessian_;
  values.jacobian = jacobian_;
  values.softness = softness_;
  const kkt::KktSystem::Outcome outcome = system_.factor(values);
  if (outcome.exists) {
    factorised_ = true;
    return {};
  }
  const std::string where = outcome.singular_row >= 0 ? " (" + row_name(problem, outcome.singular_row) + ")"
                            : outcome.singular_unknown >= 0
                                ? " (unknown " + std::to_string(outcome.singular_unknown) + ")"
                                : "";
  return Status::failure(Code::failed, "the KKT system is singular at the result" + where);
}

Status LentSystem::solve(Span<const double> right_hand_side, Span<double> out) {
  if (problem_ == nullptr) {
    return Status::failure(Code::unsupported, "nothing was solved yet, so that there is no system to lend");
  }
  if (problem_->epochs() != epoch_) {
    return Status::failure(Code::unsupported, "rows were bound anew since the solve: its system is gone");
  }
  const std::size_t n = at(problem_->unknowns()), m = at(problem_->rows());
  if (right_hand_side.size() != n + m || out.size() != n + m) {
    return Status::failure(Code::invalid_input, "a right-hand side has " + std::to_string(n) + " + " +
                                                    std::to_string(m) + " numbers, and so has what is solved for");
  }
  if (!factorised_) {
    if (Status status = factor(); !status.ok()) return status;
  }
  const double left = system_.solve({right_hand_side.data(), n}, {right_hand_side.data() + n, m}, {}, refinements,
                                    {out.data(), n}, {out.data() + n, m});
  if (left <= enough) return {};
  return Status::failure(Code::failed, "the KKT system at the result is too near a singular one to be solved");
}

}  // namespace bowstring::newton
