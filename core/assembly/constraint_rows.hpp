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
    bool identity = true;                    ///< B = I
  };

  int first_row = 0;
  std::vector<Read> reads;                                    ///< of all rows, in declaration order
  std::vector<int> read_begin;                                ///< rows + 1
  std::vector<double> jacobian, hessian;                      ///< as the constraint writes them
  std::vector<int> jacobian_begin, hessian_begin;             ///< rows + 1
  std::vector<RowSupport> all_places;                         ///< per row
  std::vector<RowSupport> jacobian_support, hessian_support;  ///< per row: as the constraint says
  std::vector<int> unknown, unknown_begin;                    ///< per row: free unknowns that it reads, −1 where held
  std::vector<int> jacobian_position;                         ///< per entry of `unknown`
  std::vector<int> hessian_position, hessian_position_begin;  ///< per row: packed over its unknowns
  std::vector<char> free;                                     ///< per row: none of its unknowns is held
  bool identity = true;                                       ///< every place of every row has B = I

  int rows() const noexcept { return static_cast<int>(read_begin.size()) - 1; }

  void reserve_derivatives();
  void locate(const BlockLayout& blocks, const HessianPattern& hessian_pattern,
              const JacobianPattern& jacobian_pattern);

  /// Whether a constraint may say so of a row.
  bool fits(int row, const RowSupport& support) const noexcept;
  /// The first row with a derivative that is not finite; −1: none.
  int flawed_jacobian_row() const noexcept;
  int flawed_hessian_row() const noexcept;

  /// out += ∂r/∂y B.
  void add_jacobian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  /// out += Bᵀ H B, H being the weighted second derivatives in `hessian`.
  void add_hessian(const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  /// total_stress += multiplier · ∂r/∂y at every place that is read: what the rows pull with.
  void add_stress(Span<const double> multipliers, std::vector<SiteTable>& tables) const noexcept;

 private:
  /// The k-th place that a row depends on.
  const Read& read_of(int row, const RowSupport& support, int k) const noexcept;
  /// Which of a row's numbers those of its support are: the first `lead`, and `tail` that are `shift` places later
  /// among all than among those of the support.
  struct Stretches {
    int lead = 0, shift = 0, tail = 0;
    int values() const noexcept { return lead + tail; }
  };
  Stretches stretches(int row, const RowSupport& support) const noexcept;
  void add_row_hessian(int row, const std::vector<SiteTable>& tables, Span<double> out) const noexcept;
  void add_identity_row_hessian(int row, Span<double> out) const noexcept;
};

}  // namespace bowstring
