#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring {

struct IterationRecord {
  int iteration = 0;
  double energy = 0.0;        ///< N mm
  double stationarity = 0.0;  ///< N, as the solver measures it
  double penetration = 0.0;   ///< mm, largest violation of a row
  double step = 0.0;          ///< fraction of the full step that was taken
};

/// What every solver is told.
struct SolverContext {
  /// Called after each iteration; false asks the solver to stop with its best point (`interrupted`).
  std::function<bool(const IterationRecord&)> on_iteration;
  Span<const double> multipliers;  ///< m, to start from; may be empty
};

/// What the solver believes. The kernel judges for itself.
enum class Claim : int { optimal, stalled, infeasible, diverged, failed };

/// How an enforcement imposed its rows, and what that leaves of them. What is not known is left out.
struct EnforcementReport {
  int outer_iterations = 1;               ///< solves of what remains
  std::optional<double> weight;           ///< N/mm: the last one of a method that has weights
  std::optional<double> penetration;      ///< mm: largest violation that the weight leaves
  std::optional<double> energy;           ///< N mm: what exact rows would add to the energy found, estimated …
  std::optional<double> measured_energy;  ///< … and measured, by a solve with exact rows
  std::optional<double> measured_motion;  ///< mm: how far that solve moved a node at most
};

struct SolverResult {
  Claim claim = Claim::failed;
  std::string reason;
  std::vector<double> q;            ///< best point, coordinates
  std::vector<double> multipliers;  ///< m, or empty where the method has none
  int iterations = 0;
  int factorizations = 0;
  int evaluations = 0;
  double evaluation_seconds = 0.0;     ///< in the problem's evaluations
  double factorization_seconds = 0.0;  ///< in factorizations and solves; 0 where the backend hides it
  std::vector<IterationRecord> history;
  EnforcementReport enforcement;  ///< an enforcement's to fill in
};

struct SolverTraits {
  bool equalities = true;    ///< takes equality rows
  bool inequalities = true;  ///< takes inequality rows
  bool bounds = true;        ///< takes bounds on unknowns
  /// The contact window that suits it: the larger of so many segments each side and so many mm.
  int window_segments = 2;
  double window_length = 0.0;
};

/// kind `solver`.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual SolverTraits traits() const noexcept = 0;
  /// `unsupported` with a reason refuses the problem before anything is solved.
  virtual Status can(const ProblemSummary& problem) const noexcept = 0;
  virtual Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
                       SolverResult& out) noexcept = 0;
  /// Lends the KKT system at the last result: (a, b) → (δ, λ), n + m numbers each, W δ + Jᵀλ = a and J δ = b of the
  /// rows that are active, λ = 0 of the others. The problem of that solve has to be there still, in the epoch it ended
  /// in.
  virtual Status solve_kkt(Span<const double> right_hand_side, Span<double> out) noexcept {
    (void)right_hand_side;
    (void)out;
    return Status::failure(Code::unsupported, "this solver lends no factorization");
  }
};

}  // namespace bowstring
