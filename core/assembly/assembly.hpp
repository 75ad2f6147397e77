#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/assembly/constraint_rows.hpp"
#include "core/assembly/key_order.hpp"
#include "core/assembly/law_batch.hpp"
#include "core/assembly/pattern.hpp"
#include "core/interfaces/problem.hpp"
#include "core/model/scene.hpp"

namespace bowstring {

/// One entry of a field: a node's position, an edge's orientation, a length.
struct FieldEntry {
  Manifold manifold = Manifold::real;
  int dimension = 1;
  int coordinate = 0;         ///< first number in q
  int unknown = 0;            ///< first scene-wide tangent number
  int block = -1;             ///< of the free unknowns, −1 where all are fixed
  double arc_fraction = 0.0;  ///< place along its curve, 0…1
};

/// Where a group of rows comes from.
struct RowOrigin {
  int curve = -1;       ///< of closure rows
  int constraint = -1;  ///< of constraint rows
  int first = 0, count = 0;
  std::string name;
};

/// The scene as a problem: reads places, asks laws, terms and kinematics, owns every chain rule, and scatters into
/// patterns that stay until the next epoch. Nothing in `evaluate` and `lagrangian_hessian` allocates. Everything is
/// summed in a fixed order.
class Assembly final : public Problem, public PlaceTables {
 public:
  /// The scene outlives the assembly. `start`: the coordinates that rows are bound at; empty: the scene's own start,
  /// which they have been declared at. Throws std::runtime_error naming the curve or constraint that fails at State 1
  /// or at the start. `like`: another assembly, whose patterns are taken over where its rows read the same places.
  explicit Assembly(Scene& scene, Span<const double> start = {}, const Assembly* like = nullptr);

  const ProblemSummary& summary() const noexcept override { return summary_; }
  int unknowns() const noexcept override { return free_count_; }
  int coordinates() const noexcept override { return scene_.coordinates; }
  int rows() const noexcept override { return static_cast<int>(row_lower_.size()); }
  Span<const double> row_lower() const noexcept override { return row_lower_; }
  Span<const double> row_upper() const noexcept override { return row_upper_; }
  Span<const double> lower() const noexcept override { return lower_; }
  Span<const double> upper() const noexcept override { return upper_; }
  SparsityPattern jacobian_pattern() const noexcept override { return jacobian_pattern_.view(); }
  SparsityPattern hessian_pattern() const noexcept override { return hessian_pattern_.view(); }
  Span<const int> order() const noexcept override { return order_; }
  int border() const noexcept override { return border_; }
  Span<const LocalRows> local_rows() const noexcept override { return local_rows_; }
  Span<const int> local_unknowns() const noexcept override { return local_unknowns_; }
  Span<const double> stationarity_scale() const noexcept override { return scale_; }
  Status evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept override;
  Status lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override;
  void values(Span<const double> q, Span<double> out) const noexcept override;
  void retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept override;
  Status accept(Span<const double> q) noexcept override;
  void set_guard(double fraction_of_clearance) noexcept override { guard_ = fraction_of_clearance; }
  double travelled() const noexcept override { return travelled_; }
  double rounding_floor() const noexcept override;
  bool epoch_due() const noexcept override;
  Status new_epoch() noexcept override;
  int epochs() const noexcept override { return epochs_; }
  std::unique_ptr<EuclideanProblem> chart(Span<const double> base) override;
  double largest_motion(Span<const double> from, Span<const double> to) const noexcept override;

  /// Table of y at the state last evaluated; null where the site does not exist.
  const double* table(int curve, Site site) const noexcept override;
  std::uint64_t state() const noexcept override { return state_; }

  // What the certificate and the result document read. Each brings the state up to date first.

  /// Energies of the scene's terms, in their order, N mm.
  Status term_energies(Span<const double> q, std::vector<double>& out);
  /// Lagrangian gradient over all tangent numbers, the fixed ones included: what supports carry.
  Status full_gradient(Span<const double> q, Span<const double> multipliers, std::vector<double>& out);
  /// Stress at the places of a site, of the energies alone: moments at stations, tension at edges or lengths.
  Status site_stress(Span<const double> q, int curve, Site site, std::vector<double>& out);
  Status report(Span<const double> q, int constraint, std::vector<RowReport>& out);

  // One of the scene's energies by itself, without rows.

  /// Over all tangent numbers, the fixed ones included.
  Status term_gradient(Span<const double> q, int term, std::vector<double>& out);
  /// In the order of `hessian_pattern`.
  Status term_hessian(Span<const double> q, int term, Span<double> values);

  const Scene& scene() const noexcept { return scene_; }
  const std::vector<RowOrigin>& row_origins() const noexcept { return origins_; }
  const std::vector<FieldEntry>& entries() const noexcept { return entries_; }
  const std::vector<int>& free_of_unknown() const noexcept { return free_; }
  const BlockLayout& blocks() const noexcept { return blocks_; }
  const HessianPattern& hessian_blocks() const noexcept { return hessian_pattern_; }

 private:
  struct LawSlot {
    int energy = 0;
    int table = 0;
    LawAssembly law;
  };

  SiteTable* find_table(int curve, Site site) noexcept;
  const SiteTable* find_table(int curve, Site site) const noexcept;
  void number_unknowns();
  void make_tables();
  void number_rows();
  /// Lets every constraint choose its rows' places anew.
  using Binding = Status (*)(Constraint&, const PlaceTables&, RowDeclaration&);
  Status place_rows(Binding bind);
  void place_rows_at(Span<const double> q);
  Status bind_rows() noexcept;
  /// Reads the constraints' declarations. Answers whether that made tables be read that nothing had read before.
  bool read_rows();
  /// Whether the constraints' declarations are those that were read last.
  bool rows_stay() const noexcept;
  std::string missing_place(const ConstraintUse& use, int row) const;
  /// What of the patterns lasts from epoch to epoch, as long as no further tables are read.
  void make_lasting_patterns();
  void make_patterns();
  bool reads_like(const Assembly& other) const noexcept;
  void take_patterns(const Assembly& other);
  /// A row of a closure site: its entries begin at `first` of the table's Jacobian and stand at `position`.
  void note_closure_row(int table, int first, const int* position);
  /// What closure rows alone say of the unknowns.
  void count_closure_readers();
  void find_local_rows();
  void make_order();
  /// Of a curve whose rows search places along another one: (its own arc fraction, that of the other curve).
  void pair_places();
  /// Per free unknown: where along a vessel it stands, 0…1.
  void place_along();
  void make_scales();

  /// With `derivatives` the places' Jacobians too, which costs less than asking for them later.
  Status update_places(Span<const double> q, bool derivatives = false);
  /// The places that nothing reads in an evaluation, for what is read of an accepted state.
  Status update_idle_places();
  Status update_energy();
  Status update_jacobians();
  Status check_guard();
  bool folds(const SiteTable& table) const noexcept;
  Status update_rows(bool jacobian, bool beyond_window = false);
  Status update_constraint(std::size_t index, bool jacobian, bool beyond_window);
  /// values += Σ multiplier ∇²r of the constraints.
  Status add_row_hessians(Span<const double> multipliers, Span<double> values);
  /// Brings every place's stress, and with `modulus` its modulus, to those of one energy alone.
  Status sum_term(Span<const double> q, int term, bool modulus);
  /// What a constraint said of its rows' supports.
  Status check_supports(std::size_t index, const std::vector<RowSupport>& support, int first, int end) const;
  Status not_finite(std::size_t index, const char* what, int row) const;
  void add_closure_jacobian(Span<double> out) const noexcept;
  /// Of the Lagrangian: energies, closure and constraints, at every place, or only where y is not linear in the
  /// unknowns.
  void set_total_stress(double energy_factor, Span<const double> multipliers, bool everywhere) noexcept;
  Span<const double> curve_q(int curve) const noexcept;
  const Curve& curve_of(const SiteTable& table) const noexcept;

  Scene& scene_;
  std::vector<FieldEntry> entries_;
  std::vector<int> free_;  // scene-wide tangent number → free unknown or −1
  int free_count_ = 0;
  BlockLayout blocks_;
  std::vector<SiteTable> tables_;
  std::vector<int> table_of_;  // curve × site
  std::vector<LawSlot> laws_;
  std::vector<ConstraintRows> constraints_;
  std::vector<RowOrigin> origins_;
  std::vector<double> row_lower_, row_upper_, lower_, upper_, scale_;
  std::vector<int> closure_position_;  // of closure Jacobians, table after table
  /// Consecutive entries of a closure Jacobian that stand in the same order in the scene's.
  struct Run {
    int table = 0, first = 0, position = 0, count = 0;
  };
  std::vector<Run> closure_runs_;     // longest ones
  std::vector<char> closure_in_run_;  // per row
  std::vector<int> order_;
  int border_ = 0;
  std::vector<char> whole_curve_;                        // per free unknown: read by every closure place of its curve
  std::vector<char> is_position_;                        // per free unknown
  std::vector<int> closure_readers_, equality_readers_;  // per free unknown: closure places, and all equality rows
  int closure_rows_ = 0;
  bool local_rows_found_ = false, local_rows_of_constraints_ = false;  // with what the latter's equalities read
  std::vector<LocalRows> local_rows_;
  std::vector<int> local_unknowns_;
  HessianPattern lasting_pattern_, hessian_pattern_;
  JacobianPattern jacobian_pattern_;
  RowBlocks row_blocks_;
  std::vector<int> lasting_position_;  // per entry of lasting_pattern_: its position in hessian_pattern_
  std::vector<double> key_;            // per unknown and row
  KeyOrder key_order_;
  std::vector<std::vector<double>> node_fraction_;                     // per curve
  std::vector<std::vector<std::pair<double, double>>> paired_places_;  // per curve
  ProblemSummary summary_;
  double guard_ = std::numeric_limits<double>::infinity();
  int epochs_ = 1;
  Status epoch_failure_;  // after one, constraints and patterns no longer fit each other: nothing reads rows any more

  // The state that the tables hold, and what of it has been computed.
  std::vector<double> q_;
  std::uint64_t place_state_ = 0;  // of SiteEvaluation: new with q_
  std::uint64_t state_ = 0;        // of RowEvaluation: new with q_, with what is accepted and bound
  bool has_places_ = false, has_idle_places_ = false, has_energy_ = false, has_jacobians_ = false, has_rows_ = false,
       has_row_jacobians_ = false;
  bool rows_beyond_window_ = false;  // row_status_ is that of a search beyond the windows
  Status guard_status_, row_status_;
  bool guard_checked_ = false;
  double travelled_ = 0.0;
  double energy_ = 0.0;
  std::vector<double> term_energy_, row_;
};

}  // namespace bowstring
