#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring {

/// φ(r) of one row, N mm, with φ' = `force` (N: the multiplier that the row then has) and φ'' = `stiffness` (N/mm).
struct RowEnergy {
  double energy = 0.0, force = 0.0, stiffness = 0.0;
};

/// What rows cost that no longer have to hold.
class RowLaw {
 public:
  virtual ~RowLaw() = default;
  /// `row`: its number among all rows, `value`: r, mm.
  virtual RowEnergy at(int row, double value) const noexcept = 0;
  /// N/mm: no φ'' is larger.
  virtual double stiffest() const noexcept = 0;
};

/// A problem without some of its rows, whose energy counts them instead: E + Σ φ(r), with
///   ∇ = ∇E + Σ φ' ∇r  and  ∇² = ∇²E + Σ (φ' ∇²r + φ'' ∇r ∇rᵀ)
/// on manifolds as on charts. The other rows keep their order and are numbered anew. Windows, epochs and the step guard
/// are the problem's own, and watch the rows taken away like the others. Rows of the same place as an edge's own
/// (`local_rows`) cannot be taken.
///
/// Evaluations allocate nothing; an epoch allocates where patterns grow.
class SoftenedProblem final : public Problem {
 public:
  /// `soft`: per row whether it is taken away. Problem and law outlive this; the law may change between evaluations.
  SoftenedProblem(Problem& problem, std::vector<char> soft, const RowLaw& law);

  const ProblemSummary& summary() const noexcept override { return summary_; }
  int unknowns() const noexcept override { return problem_.unknowns(); }
  int coordinates() const noexcept override { return problem_.coordinates(); }
  int rows() const noexcept override { return static_cast<int>(kept_.size()); }
  Span<const double> row_lower() const noexcept override { return row_lower_; }
  Span<const double> row_upper() const noexcept override { return row_upper_; }
  Span<const double> lower() const noexcept override { return problem_.lower(); }
  Span<const double> upper() const noexcept override { return problem_.upper(); }
  SparsityPattern jacobian_pattern() const noexcept override { return {begin_, inner_}; }
  SparsityPattern hessian_pattern() const noexcept override { return problem_.hessian_pattern(); }
  Span<const int> order() const noexcept override { return order_; }
  int border() const noexcept override { return border_; }
  Span<const LocalRows> local_rows() const noexcept override { return local_rows_; }
  Span<const int> local_unknowns() const noexcept override { return problem_.local_unknowns(); }
  Span<const double> stationarity_scale() const noexcept override { return problem_.stationarity_scale(); }
  Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept override;
  Status lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override;
  void values(Span<const double> q, Span<double> out) const noexcept override { problem_.values(q, out); }
  void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept override {
    problem_.retract(q, delta, out);
  }
  Status accept(Span<const double> q) noexcept override;
  void set_guard(double fraction_of_clearance) noexcept override { problem_.set_guard(fraction_of_clearance); }
  double travelled() const noexcept override { return problem_.travelled(); }
  /// A row is known to rounding of the scene's extent, and its force to that times the stiffness.
  double rounding_floor() const noexcept override;
  bool epoch_due() const noexcept override { return problem_.epoch_due(); }
  Status new_epoch() noexcept override;
  int epochs() const noexcept override { return problem_.epochs(); }
  std::unique_ptr<EuclideanProblem> chart(Span<const double> base) override;
  double largest_motion(Span<const double> from, Span<const double> to) const noexcept override {
    return problem_.largest_motion(from, to);
  }

  const std::vector<int>& soft_rows() const noexcept { return soft_rows_; }
  const std::vector<int>& kept_rows() const noexcept { return kept_; }
  /// Of all rows, mm, at the point last evaluated whose energy, gradient or rows were asked for, on whatever chart.
  const std::vector<double>& last_rows() const noexcept { return own_.rows; }
  /// mm: what rounding leaves of a row at the point last accepted.
  double row_rounding() const noexcept;

  /// Those of all rows, from those of the rows that are left: numbers of others are not touched.
  void spread(Span<const double> kept, Span<double> all) const noexcept;
  /// And back.
  void gather(Span<const double> all, Span<double> kept) const noexcept;

 private:
  friend class SoftenedChart;

  struct Buffers {
    std::vector<double> rows, jacobian, weights;
  };

  void fit_patterns();
  Status fit() noexcept;
  /// `inner`: the problem, or a chart of it, and a point of that.
  template <class Inner>
  Status evaluate(Inner& inner, Span<const double> point, const ProblemEvaluation& evaluation) noexcept;
  template <class Inner>
  Status lagrangian_hessian(Inner& inner, Span<const double> point, double energy_factor,
                            Span<const double> multipliers, Span<double> values) noexcept;
  /// values += stiffness ∇r ∇rᵀ of one row; false: the pattern lacks a pair of its unknowns.
  bool add_outer(int row, double stiffness, Span<double> values) const noexcept;

  Problem& problem_;
  const RowLaw& law_;
  std::vector<int> soft_rows_, kept_;
  std::vector<int> kept_number_;  // per row; −1: taken away
  ProblemSummary summary_;
  std::vector<double> row_lower_, row_upper_;
  std::vector<int> begin_, inner_, order_;
  int border_ = 0;
  std::vector<LocalRows> local_rows_;
  double extent_ = 0.0;
  Buffers own_;
};

}  // namespace bowstring
