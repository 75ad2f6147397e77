#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/interfaces/curve.hpp"
#include "core/interfaces/parameter.hpp"
#include "core/interfaces/place.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// What a constraint sees of the scene when it declares its rows.
struct ConstraintScene {
  int dimension = 3;
  std::vector<CurveView> on;          ///< the curves named in `on`, in that order
  std::vector<const double*> radius;  ///< per curve of `on`: nodal radius, mm, or null where none is known
  bool starts_along = false;          ///< the first curve starts along the second …
  double start_arc = 0.0;             ///< … from this arc coordinate of it, mm …
  double end_arc = 0.0;               ///< … to this one, mm
  int window_segments = 2;            ///< what the solver asks for where the user says nothing: the larger of this …
  double window_length = 0.0;         ///< … and this, mm
};

struct RowDeclaration {
  int rows = 0;
  std::vector<int> place_begin;      ///< rows + 1: row r reads places [place_begin[r], place_begin[r+1])
  std::vector<Place> places;         ///< `curve` is the scene's index (CurveView::index)
  std::vector<double> lower, upper;  ///< per row; ±infinity where unbounded; equal: an equality
  /// The first curve, a wire, belongs inside of the second's lumen: the certificate then looks whether it passes
  /// through the wall between its rows.
  bool inside_lumen = false;
  /// `evaluate` can be asked for some of the rows alone (RowEvaluation::first), so that second derivatives of many rows
  /// need not be held at once.
  bool in_parts = false;
  std::vector<std::string> warnings;
  std::vector<IdleParameter> without_effect;
};

/// The state that rows are evaluated at: per curve and site the table of y, count × values.
class PlaceTables {
 public:
  virtual ~PlaceTables() = default;
  virtual const double* table(int curve, Site site) const noexcept = 0;
  /// The number of that state, as in RowEvaluation::state: `accept` and `travel` come after an evaluation at the same
  /// places, whose results may serve again. 0: unknown.
  virtual std::uint64_t state() const noexcept { return 0; }
};

/// Which of its places a row depends on at one state: its first `lead` ones, and `count` ones from its place `first`
/// on.
struct RowSupport {
  int lead = 0, first = 0, count = 0;
  int places() const noexcept { return lead + count; }
  /// The k-th of them, counted among all places of the row.
  int place(int k) const noexcept { return k < lead ? k : first + k - lead; }
};

/// Outputs are caller-owned and left alone when empty. Row r's numbers come in the order of its places.
struct RowEvaluation {
  const PlaceTables* at = nullptr;
  Span<double> residual;      ///< rows
  Span<double> jacobian;      ///< row after row: ∂r/∂y over all places of the row
  Span<const double> weight;  ///< rows, read only for `hessian`
  Span<double> hessian;       ///< row after row: packed lower triangle of weight·∂²r/∂y²
  /// rows; all places of each row, or empty. A row that depends on fewer of them at this state (its window covers more
  /// than the segment of its closest point) may narrow its entry: of its numbers in `jacobian` and `hessian`, which
  /// begin where they always do, those of these places then come first, packed, and the rest is not read.
  Span<RowSupport> support;
  /// Only where the declaration says `in_parts`: rows first … first + count − 1 alone are asked for, and every span
  /// above is theirs. −1: all rows.
  int first = 0, count = -1;
  /// The same number means that `at` holds the same places as in the last call that had it, and that nothing was
  /// accepted or bound in between: what was found then may serve again. No two states of a process share one. 0:
  /// unknown.
  std::uint64_t state = 0;
  /// Only where residuals alone are asked for: a row may look for its place outside of what it covers.
  bool beyond_window = false;
};

/// The largest motion of a row's point relative to its wall, transverse to it, since the last `accept`.
struct Travel {
  double fraction_of_clearance = 0.0;
  int row = -1;
};

/// One row as the result document reports it.
struct RowReport {
  int wire_curve = -1, vessel_curve = -1;  ///< the curve that touches, and what it touches; −1: no vessel
  double wire_coordinate = 0.0;            ///< in edges of the wire: 2.25 is a quarter along the third
  double vessel_coordinate = 0.0;          ///< in edges of the vessel
  double gap = 0.0;                        ///< mm, ≤ 0 inside
  double clearance = 0.0;                  ///< mm
  double direction[3] = {0.0, 0.0, 0.0};   ///< unit: of the force that the vessel exerts on the wire
  double force_per_multiplier = 1.0;       ///< N per unit of the row's multiplier; a bilateral row's force may reverse
};

/// kind `constraint`: rows lower ≤ r(y) ≤ upper that couple places. Within its declared places a row is smooth;
/// when it needs other places, `evaluate` answers `left_window` and `rebind` gives a new declaration.
class Constraint {
 public:
  virtual ~Constraint() = default;
  virtual Status declare(const ConstraintScene& scene, RowDeclaration& out) noexcept = 0;
  virtual Status evaluate(const RowEvaluation& evaluation) const noexcept = 0;
  /// `at` becomes the accepted point, from which the next `travel` and closest-point searches start. It may have been
  /// found `beyond_window`; then `rebind_due` says so.
  virtual Status accept(const PlaceTables& at) noexcept {
    (void)at;
    return {};
  }
  virtual Travel travel(const PlaceTables& at) const noexcept {
    (void)at;
    return {};
  }
  /// A closest point has come so near the edge of what its row covers that an epoch is due.
  virtual bool rebind_due() const noexcept { return false; }
  /// Binds every row anew at the accepted point.
  virtual Status rebind(RowDeclaration& out) noexcept {
    (void)out;
    return {};
  }
  /// Binds every row at a state that may lie far from the one where it was declared, as if it had been accepted step by
  /// step on the way there: rows must find their places on the vessel by following it, not by a search that could find
  /// another limb. Row count and meaning stay.
  virtual Status bind(const PlaceTables& at, RowDeclaration& out) noexcept {
    Status status = accept(at);
    return status.ok() ? rebind(out) : status;
  }
  /// Contact rows describe themselves; other constraints leave `out` empty.
  virtual Status report(const PlaceTables& at, std::vector<RowReport>& out) const noexcept {
    (void)at;
    out.clear();
    return {};
  }
};

}  // namespace bowstring
