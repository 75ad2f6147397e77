#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::kkt {

/// Linearised rows of one place, J_D δ_D + J_P δ_P = b, where no other row reads the d local unknowns D. With
/// J_D = Q (R; 0) they say
///   δ_D = R⁻¹(Qᵀb)₁ − A δ_P,  A = R⁻¹(QᵀJ_P)₁,   and   B δ_P = (Qᵀb)₂,  B = (QᵀJ_P)₂:
/// the null-space form (Nocedal and Wright, Numerical Optimization, 15.3 and 16.2), place by place, without loss for
/// any Hessian. An edge's closure gives up its direction and its length in this way.
struct LocalBlock {
  int first_row = 0, rows = 0;
  int first_local = 0, locals = 0;       ///< into LocalElimination::local
  int first_retained = 0, retained = 0;  ///< into LocalElimination::retained
  int first_q = 0, first_r = 0, first_a = 0, first_b = 0;
  int left() const noexcept { return rows - locals; }
};

class LocalElimination {
 public:
  static constexpr int most_rows = 4, most_retained = 24;

  /// Chooses each place's local unknowns at these values: those of the problem's that its rows feel (not the turn about
  /// an edge's own axis). Allocates.
  void analyse(const Problem& problem, Span<const double> jacobian);
  /// Whether the choice was made for this problem and its places are as they were.
  bool fits(const Problem& problem) const noexcept;
  /// False: a chosen unknown no longer moves its rows, and another choice is due.
  bool update(Span<const double> jacobian) noexcept;

  const std::vector<LocalBlock>& blocks() const noexcept { return blocks_; }
  const int* local(const LocalBlock& block) const noexcept { return local_.data() + block.first_local; }
  const int* retained(const LocalBlock& block) const noexcept { return retained_.data() + block.first_retained; }
  /// locals × retained and left() × retained, row by row.
  const double* a(const LocalBlock& block) const noexcept { return a_.data() + block.first_a; }
  const double* b(const LocalBlock& block) const noexcept { return b_.data() + block.first_b; }
  int block_of_unknown(int unknown) const noexcept { return block_of_unknown_[static_cast<std::size_t>(unknown)]; }
  int place_in_block(int unknown) const noexcept { return place_in_block_[static_cast<std::size_t>(unknown)]; }
  int block_of_row(int row) const noexcept { return block_of_row_[static_cast<std::size_t>(row)]; }

  /// right ← Qᵀ right with R⁻¹ applied to its first part: what δ_D is without δ_P, then the rows that are left.
  void rotate(const LocalBlock& block, double* right) const noexcept;
  /// The multipliers of a place: λ = Q (R⁻ᵀ pull; left). `pull`: locals numbers; `left`: left() numbers.
  void multipliers(const LocalBlock& block, const double* pull, const double* left, double* out) const noexcept;

 private:
  bool choose(const Problem& problem, const LocalRows& rows, Span<const double> jacobian);

  const Problem* problem_ = nullptr;
  std::vector<LocalBlock> blocks_;
  std::vector<int> local_, retained_;
  std::vector<int> entry_;  // per Jacobian entry of a block's rows: ≥ 0 place among retained, −1 − k: local k
  std::vector<int> entry_begin_, jacobian_begin_;  // per block's row
  std::vector<int> block_of_unknown_, place_in_block_, block_of_row_;
  std::vector<double> q_, r_, a_, b_;
};

}  // namespace bowstring::kkt
