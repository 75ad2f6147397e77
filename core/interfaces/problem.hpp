#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// A compressed sparse pattern: entries of outer index o are inner[begin[o]] … inner[begin[o+1] − 1], increasing.
struct SparsityPattern {
  Span<const int> begin;
  Span<const int> inner;
  int entries() const noexcept { return static_cast<int>(inner.size()); }
};

/// Consecutive rows of one origin.
struct RowGroup {
  std::string name;  ///< "iliac.closure" or the constraint's label
  std::string text;  ///< "edge closure of 'iliac' (158)", for people
  int first = 0, count = 0;
  bool closure = false;  ///< a kinematics' own rows, which no enforcement touches
  int inequalities = 0;  ///< so many of them; the others are equalities
};

struct ProblemSummary {
  int unknowns = 0;  ///< free tangent numbers
  int fixed = 0;     ///< eliminated ones
  int equalities = 0;
  int inequalities = 0;
  bool bounded_unknowns = false;
  std::vector<RowGroup> row_groups;
};

/// The equality rows of one place (an edge's closure) and the unknowns that no other equality row reads (that edge's
/// direction and length): these can be eliminated where they stand, before anything else.
struct LocalRows {
  int first_row = 0, rows = 0;
  int first_local = 0, locals = 0;  ///< into Problem::local_unknowns
};

/// Outputs are caller-owned and left alone when null or empty.
struct ProblemEvaluation {
  /// Rows may find their places (closest points) outside of what they cover, as a trial of a step does that is followed
  /// by a new epoch. Without effect where a Jacobian is asked for.
  bool beyond_window = false;
  double* energy = nullptr;
  Span<double> gradient;  ///< unknowns: of δ ↦ E(q · Exp δ) at 0, or of x ↦ E on a chart
  Span<double> rows;      ///< rows
  Span<double> jacobian;  ///< in the order of `jacobian_pattern`
};

/// The same problem for solvers of Rⁿ: coordinates x ∈ Rⁿ around a base point, x = 0 at the base on rotations and
/// directions, the number itself elsewhere. Patterns, rows and bounds are the problem's.
class EuclideanProblem {
 public:
  virtual ~EuclideanProblem() = default;
  virtual void start(Span<double> x) const noexcept = 0;  ///< x of the base point
  virtual void state(Span<const double> x, Span<double> q) const noexcept = 0;
  virtual Status evaluate(Span<const double> x, const ProblemEvaluation& evaluation) noexcept = 0;
  /// Lower triangle of energy_factor·∇²E + Σ multiplier_r ∇²r, with the chart's own second derivatives.
  virtual Status lagrangian_hessian(Span<const double> x, double energy_factor, Span<const double> multipliers,
                                    Span<double> values) noexcept = 0;
  /// A block has turned so far (more than π/2) that the chart must be centred anew.
  virtual bool recentre_due(Span<const double> x) const noexcept = 0;
};

/// What a solver sees: minimise E(q) over a product of manifolds subject to row_lower ≤ r(q) ≤ row_upper and
/// lower ≤ u ≤ upper for the real unknowns. Multipliers λ belong to L = E + λᵀr: λ ≥ 0 on an active upper bound.
/// Every second derivative is a Taylor coefficient of δ ↦ f(q · Exp δ) at 0.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual const ProblemSummary& summary() const noexcept = 0;
  virtual int unknowns() const noexcept = 0;     ///< n
  virtual int coordinates() const noexcept = 0;  ///< numbers in q
  virtual int rows() const noexcept = 0;         ///< m; closure rows first
  virtual Span<const double> row_lower() const noexcept = 0;
  virtual Span<const double> row_upper() const noexcept = 0;
  virtual Span<const double> lower() const noexcept = 0;  ///< n, of the real unknowns' values; −∞ elsewhere
  virtual Span<const double> upper() const noexcept = 0;
  virtual SparsityPattern jacobian_pattern() const noexcept = 0;  ///< outer: rows
  /// Lower triangle; outer: columns. Holds every pair of unknowns that one row of a constraint reads, so that JᵀJ of
  /// such rows can be added in place.
  virtual SparsityPattern hessian_pattern() const noexcept = 0;
  /// Unknowns 0…n−1 and rows n…n+m−1 in an order along the curves, each row after the unknowns it reads.
  virtual Span<const int> order() const noexcept = 0;
  /// The last so many of that order read whole curves (a sliding wire's length): a solver does well to border them.
  virtual int border() const noexcept { return 0; }
  virtual Span<const LocalRows> local_rows() const noexcept { return {}; }
  virtual Span<const int> local_unknowns() const noexcept { return {}; }
  /// Length (mm) that turns a tangent number's gradient into a force: 1 for translations, the mean adjacent edge
  /// length for rotations. n entries.
  virtual Span<const double> stationarity_scale() const noexcept = 0;

  virtual Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept = 0;
  virtual Status lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                                    Span<double> values) noexcept = 0;
  /// The value of the real unknowns (n; 0 for the others), for bounds.
  virtual void values(Span<const double> q, Span<double> out) const noexcept = 0;
  virtual void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept = 0;

  /// Moves the reference of the step guard and of the closest-point searches to q. Until the next call, `evaluate`
  /// answers `refused` where a wire node has moved, relative to its wall, by more than `guard` of its clearance, where
  /// an edge has shortened to less than half, or where a station has turned by more than 45°.
  virtual Status accept(Span<const double> q) noexcept = 0;
  virtual void set_guard(double fraction_of_clearance) noexcept = 0;  ///< infinity: no guard
  /// How far, in shares of its clearance, a wire node had moved at the last point that was evaluated under a guard: how
  /// much shorter a step has to be that was refused. 0: unknown.
  virtual double travelled() const noexcept { return 0.0; }
  /// N: what the formulation's own rounding leaves of the stationarity, so that no smaller one can be asked for.
  virtual double rounding_floor() const noexcept { return 0.0; }
  virtual bool epoch_due() const noexcept = 0;
  /// Binds rows anew at the accepted point: patterns and orders change. Row count and meaning stay.
  virtual Status new_epoch() noexcept = 0;
  virtual int epochs() const noexcept = 0;

  virtual std::unique_ptr<EuclideanProblem> chart(Span<const double> base) = 0;

  /// mm: how far the node that moved most stands in one state from where it stands in another; NaN: unknown.
  virtual double largest_motion(Span<const double> from, Span<const double> to) const noexcept {
    (void)from;
    (void)to;
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace bowstring
