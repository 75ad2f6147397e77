#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"
#include "core/kkt/local_elimination.hpp"
#include "core/kkt/profile_matrix.hpp"

namespace bowstring::kkt {

/// The system of one Newton step on a problem's first-order conditions,
///   W δ + Jᵀ λ = a,   J δ − E λ = b,
/// with W symmetric and E = diag(e) ≥ 0. A row with e = 0 holds exactly; e = s/z makes an interior-point method's row,
/// and a row that is off takes no part. W is the Hessian handed in; its diagonal may have been added to.
///
/// What is done, in this order, keeps work and memory proportional to the number of nodes:
///  1. places' own rows and unknowns are eliminated where they stand (LocalElimination);
///  2. rows with e > 0, and rows asked to be soft, are condensed: W + JᵀE⁻¹J;
///  3. what is left is factorised as LDLᵀ without pivoting in the problem's order along the curves, each row after its
///     unknowns, unknowns that read whole curves bordered. Rows that are left make W + ρJᵀJ of it, with a consistent
///     right side, and a dual regularisation far below the pivots, without which such factors give wrong inertias;
///  4. iterative refinement against the system as it is stated above.
/// By Sylvester's law the inertia of the whole follows from the pivots: `saddle_directions` counts the negative
/// eigenvalues of W on the null space of the rows that hold exactly.
class KktSystem {
 public:
  /// Patterns and order of the problem's epoch; `jacobian` decides which local unknowns are eliminated. Equality rows
  /// are exact, and those marked in `held` (m, or none); others are soft or off. Allocates.
  void analyse(const Problem& problem, Span<const double> jacobian, Span<const char> held = {});

  struct Values {
    Span<const double> hessian;   ///< of the pattern
    Span<const double> jacobian;  ///< of the pattern
    /// m. Of an inequality row: e > 0, what it is condensed with; infinity: it is off. Of an exact row it is not
    /// read.
    Span<const double> softness;
    double shift = 0.0;  ///< added to W's diagonal, per scale²
  };
  struct Outcome {
    bool exists = false;                           ///< no pivot vanished, growth and all numbers are sound
    int saddle_directions = 0;                     ///< negative eigenvalues of W on the null space of the exact rows
    int singular_unknown = -1, singular_row = -1;  ///< where the first pivot vanished
    double growth = 1.0;
  };
  /// The values have to live until the last `solve`.
  Outcome factor(const Values& values);

  /// Numbers that the factors take.
  std::size_t stored() const noexcept { return matrix_.stored(); }

  /// (a, b) → (δ, λ). `exactness`: m, the e that the answer has for soft rows, or empty: as factorised. λ of a row that
  /// is off is 0. Returns the residual's largest entry relative to the right side's, after refinements until it is no
  /// more than `enough`, but at most `refinements`.
  double solve(Span<const double> a, Span<const double> b, Span<const double> exactness, int refinements,
               Span<double> delta, Span<double> lambda, double enough = 1e-13);

 private:
  struct Pair {  // two places that the Hessian couples: Aᵀ W A goes to all their retained unknowns
    int first = 0, second = 0;
    int first_entry = 0, first_target = 0;
  };
  struct Mixed {  // a place and a retained unknown that the Hessian couples
    int block = 0, unknown = 0;
    int first_entry = 0, first_target = 0;
  };
  struct Direct {
    int entry, target;
  };
  struct Entry {  // of the Hessian, with a local unknown
    int i, j, entry;
  };

  struct Partner {  // of a place, in a linked list
    int partner, index, next;
  };

  int target(int slot, int other) const noexcept;
  double& cell(int target) noexcept {
    return target >= 0 ? matrix_.values()[static_cast<std::size_t>(target)]
                       : border_values_[static_cast<std::size_t>(-1 - target)];
  }
  void number_slots(const Problem& problem);
  void shape_matrix();
  void list_entries();
  /// Puts what goes to the same part of the matrix together, since a fine mesh's does not fit into a cache.
  void sort_by_part();
  void assemble(const Values& values);
  void add_hessian(Span<const double> w);
  void add_pair(const Pair& pair, Span<const double> w);
  void add_mixed(const Mixed& mixed, Span<const double> w);
  void add_row(const double* slot_value, double factor);
  int reduced_row(int row, Span<const double> jacobian, int* slot, double* value) const noexcept;
  void add_outer(const int* slot, const double* value, int count, double factor) noexcept;
  void put_row(int row_slot, const int* slot, const double* value, int count) noexcept;
  void factor_border();
  void solve_once(const double* a, const double* b, double* delta, double* lambda);
  void solve_reduced();
  double residual(Span<const double> a, Span<const double> b, Span<const double> exactness, Span<const double> delta,
                  Span<const double> lambda);

  int n_ = 0, m_ = 0, slots_ = 0, borders_ = 0, exact_rows_ = 0;
  SparsityPattern hessian_, jacobian_;
  std::vector<double> scale_;
  LocalElimination local_;
  std::vector<int> slot_of_unknown_;  // ≥ 0: in the matrix; −1 − k: k-th border; `no_slot`: local
  std::vector<int> slot_of_row_;      // of rows that stay, and of the first one that is left of a place
  std::vector<int> unknown_of_slot_, row_of_slot_;
  std::vector<char> exact_;
  ProfileMatrix matrix_;
  std::vector<double> border_values_;  // borders × slots, then borders × borders
  std::vector<double> border_solved_, schur_inverse_;
  int schur_negative_ = 0;
  std::vector<Direct> direct_;
  std::vector<Entry> mixed_entries_;
  std::vector<Pair> pairs_;
  std::vector<Mixed> mixed_;
  std::vector<int> direct_begin_, pair_begin_, mixed_begin_;  // of each part of the matrix
  std::vector<int> partner_of_block_;
  std::vector<Partner> next_partner_;
  std::vector<int> pair_entry_, pair_target_, mixed_entry_, mixed_target_;
  double weight_ = 0.0;  // ρ
  double slack_ = 0.0;   // dual regularisation of exact rows
  Values values_;
  std::vector<double> right_, border_right_, work_a_, work_b_, left_a_, left_b_, delta_, lambda_, start_;
  std::vector<int> row_slot_;  // of one row at a time: as many as its longest has
  std::vector<double> row_value_;
};

}  // namespace bowstring::kkt
