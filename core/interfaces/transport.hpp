#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/interfaces/measure.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// The costs between the places of two measures, of which a method asks for as many as it needs. +∞ forbids a pair.
class PairCosts {
 public:
  virtual ~PairCosts() = default;
  virtual int row_count() const noexcept = 0;
  virtual int column_count() const noexcept = 0;

  /// There are lower bounds, and an evaluation is dear: evaluate few pairs.
  virtual bool dear() const noexcept = 0;
  /// The whole matrix, row major, where it stands in memory for as long as the problem does; else null.
  virtual const double* matrix() const noexcept = 0;

  /// Rows [begin, end), row major: (end − begin) × column_count().
  virtual Status rows(int begin, int end, Span<double> value) noexcept = 0;
  /// Lower bounds of the same, of costs that are `dear`.
  virtual Status lower_bounds(int begin, int end, Span<double> value) noexcept = 0;
  /// `pairs`: (row, column). `value`: one per pair.
  virtual Status evaluate(Span<const int> pairs, Span<double> value) noexcept = 0;
};

/// min over plans of ⟨C, γ⟩, or what a method makes of it.
struct TransportProblem {
  Span<const double> weight_a, weight_b;  ///< not negative; of equal sums unless the method lets mass go
  PairCosts* between = nullptr;           ///< rows: the places of a; columns: those of b
  /// The costs within each measure, and the measures themselves; null where costs were given as a matrix alone.
  PairCosts* within_a = nullptr;
  PairCosts* within_b = nullptr;
  const Measure* a = nullptr;
  const Measure* b = nullptr;
  const char* ground_cost = "";  ///< the component's name; "" where costs were given as a matrix
};

/// The nonzero entries of a matrix.
struct SparseEntries {
  std::vector<int> row, column;
  std::vector<double> value;
};

/// What an exact solve proves of its plan, computed from costs and weights, not from the method's word. Absolute.
struct TransportCertificate {
  double marginal_a = 0.0, marginal_b = 0.0;  ///< largest error of a marginal, in mass
  double dual_violation = 0.0;                ///< largest u_i + v_j − c_ij, or 0
  double gap = 0.0;                           ///< primal minus dual value
  double cost_scale = 0.0;                    ///< the largest cost that the plan could have used, for comparison
};

struct TransportAnswer {
  double value = 0.0;                  ///< of what the method minimises: exact, ⟨C, γ⟩ = W₂²
  double transport_cost = 0.0;         ///< ⟨C, γ⟩
  SparseEntries plan;                  ///< mass from row to column
  std::vector<double> dual_a, dual_b;  ///< one per place

  /// ∂value/∂weight. With fixed sums it is known up to a constant; the one is chosen that makes Σ w ∂value/∂w over both
  /// measures equal in each.
  std::vector<double> weight_gradient_a, weight_gradient_b;
  /// ∂value/∂c, from which the kernel computes the gradient with respect to places. Of `between` it is the plan where
  /// `by_cost` is empty.
  SparseEntries by_cost, by_cost_within_a, by_cost_within_b;
  /// Of a method that reads points instead of costs: ∂value/∂position, count × 3, global axes; else empty.
  std::vector<double> position_gradient_a, position_gradient_b;

  bool certified = false;  ///< `certificate` stands
  TransportCertificate certificate;
  double gap = 0.0;  ///< primal minus dual value of what the method minimises

  /// Whether another plan has the same value, and a lower bound of what any other vertex costs more, per unit of the
  /// largest change of an entry of the plan; +∞ where there is no other. Only of methods whose plan is a vertex:
  /// `uniqueness_known`.
  bool uniqueness_known = false;
  bool multiple = false;
  double slack = 0.0;

  bool warm = false;                                    ///< it went on from what was kept of the call before
  long iterations = 0;                                  ///< pivots of a simplex method
  std::size_t memory_bytes = 0;                         ///< what the method holds at most
  std::vector<std::pair<std::string, double>> figures;  ///< the method's own: "marginal_error" …
};

/// kind `transport`: a transport method. It may keep a basis from call to call; one object serves one thread.
class Transport {
 public:
  virtual ~Transport() = default;
  /// `unsupported` with the reason where the method cannot take this problem.
  virtual Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept = 0;
  /// Sums of weights may differ.
  virtual bool lets_mass_go() const noexcept { return false; }
  /// Drops what is kept: the next call starts cold.
  virtual void forget() noexcept {}
};

}  // namespace bowstring
