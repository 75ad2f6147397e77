#pragma once

#include <vector>

#include "core/assembly/pattern.hpp"
#include "core/assembly/site_table.hpp"
#include "core/interfaces/constraint.hpp"

namespace bowstring {

/// The rows of one constraint: derivatives as it writes them, with respect to the y that they read, and the chain rule
/// from there to the unknowns.
struct ConstraintRows {
  /// One place of a row.
  struct Read {
    int table = 0, index = 0, values = 0, width = 0;
    int first_value = 0, first_unknown = 0;  ///< among the row's
    int block = 0;                           ///< of SiteTable::block
    bool identity = true;                    ///< B = I
  };

  /// The unknowns of a row's places, where each place has `block` of them, all held or consecutive ones of a block that
  /// no other place of the row reads. Then the entry (i, j) of places p ≥ s stands at base + i + j L − j (j + 1)/2,
  /// with L the length of the column of j = 0: columns of one block in a compressed lower triangle become shorter by
  /// one each. Where p's unknowns come before s's, i and j change places and the base is stored as its complement.
  struct Blocks {
    int block = 0;       ///< 0: the row is not of this kind (B = I is missing), and `hessian_position` has its entries
    int first_base = 0;  ///< into `base`: packed over the row's places
    int first_length = 0;  ///< into `length`: per place
  };

  int first_row = 0;
  bool in_parts = false;                                      ///< rows can be evaluated a few at a time
  std::vector<Read> reads;                                    ///< of all rows, in declaration order
  std::vector<int> read_begin;                                ///< rows + 1
  std::vector<double> jacobian, hessian;                      ///< as the constraint writes them; `hessian` of one part
  std::vector<int> jacobian_begin, hessian_begin;             ///< rows + 1
  std::vector<RowSupport> all_places;                         ///< per row
  std::vector<RowSupport> jacobian_support, hessian_support;  ///< per row: as the constraint says
  std::vector<int> unknown, unknown_begin;                    ///< per row: free unknowns that it reads, −1 where held
  std::vector<int> jacobian_position;                         ///< per entry of `unknown`
  std::vector<Blocks> blocks;                                 ///< per row
  std::vector<int> by_block;                                  ///< per read: a row's places by increasing block
  std::vector<int> base, length;
  std::vector<int> hessian_position, hessian_position_begin;  ///< per row: packed over its unknowns
  bool identity = true;                                       ///< every place of every row has B = I

  int rows() const noexcept { return static_cast<int>(read_begin.size()) - 1; }
  /// The row after the last of the part that begins with `row`: how many rows' second derivatives are held at once.
  int part_end(int row) const noexcept;

  /// Whether these are the rows' places.
  bool reads_as(const RowDeclaration& declaration, const std::vector<int>& table_of) const noexcept;
  /// Makes them so, and marks their tables as read; `table_of`: curve × site. −1, or the first row that reads a place
  /// that there is not. Where rows have read as many places before, nothing is allocated, here and in what follows.
  int bind(const RowDeclaration& declaration, const std::vector<int>& table_of, std::vector<SiteTable>& tables);
  /// Adds the rows to both patterns; those of the Jacobian become final.
  void add_patterns(const BlockLayout& layout, RowBlocks& row_blocks, JacobianPattern& jacobian_pattern);
  void locate(const BlockLayout& layout, const HessianPattern& hessian_pattern);

  /// Those that `locate` has found for the same rows.
  void take_positions(const ConstraintRows& other);

  /// Whether a constraint may say so of a row.
  bool fits(int row, const RowSupport& support) const noexcept;
  /// The first row with a derivative that is not finite; −1: none.
  int flawed_jacobian_row() const noexcept;
  int flawed_hessian_row(int first, int end) const noexcept;

  /// out += ∂r/∂y B.
  void add_jacobian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  /// out += Bᵀ H B of the rows of one part, H being the weighted second derivatives in `hessian`.
  void add_hessian(int first, int end, const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  /// total_stress += multiplier · ∂r/∂y at every place that is read: what the rows pull with.
  void add_stress(Span<const double> multipliers, std::vector<SiteTable>& tables) const noexcept;

 private:
  /// The k-th place that a row depends on.
  const Read& read_of(int row, const RowSupport& support, int k) const noexcept;
  int values_of(int row, const RowSupport& support) const noexcept;
  void reserve_derivatives();
  void sort_places(int row) noexcept;
  int block_of(int row) const noexcept;
  bool repeats(int row) const noexcept;
  void locate_blocks(int row, const BlockLayout& layout, const HessianPattern& pattern);
  void locate_entries(int row, const BlockLayout& layout, const HessianPattern& pattern);
  void add_row_hessian(int row, const double* h, const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  void fetch_ahead(int row, const RowSupport& support, const double* out) const noexcept;
  template <int fixed_block>
  void add_block_hessian(int row, const double* h, double* out) const noexcept;

  std::vector<int> row_blocks_;  // of one row
  std::vector<int> last_pair_;   // per column block: the one found last that begins a run
};

}  // namespace bowstring
