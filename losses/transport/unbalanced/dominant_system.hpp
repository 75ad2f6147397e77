#pragma once

#include <Eigen/Core>

namespace bowstring::unbalanced {

using Vector = Eigen::ArrayXd;
using Matrix = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Equations of rows u and columns v that are coupled by positive numbers D (rows × columns, rows ≤ columns):
///   (h_i + Σ_j D_ij) u_i + Σ_j D_ij v_j = r_i,    (k_j + Σ_i D_ij) v_j + Σ_i D_ij u_i = t_j,    h, k > 0.
/// In (u, −v) this is a diagonally dominant M-matrix, given by its off-diagonal entries and by what each row sum is in
/// excess. Eliminated in these numbers, without a subtraction (W. K. Grassmann, M. I. Taksar, D. P. Heyman, Operations
/// Research 33 (1985) 1107), every entry of the factors is right to a few digits less than a double has, however far
/// D is above h and k: an interior-point method ends, and large marginal weights begin, where it is by 1e20.
class DominantSystem {
 public:
  /// O(rows² columns + rows³). Keeps references to nothing.
  void factor(const Matrix& coupling, const Vector& excess_row, const Vector& excess_column);
  void solve(const Vector& right_row, const Vector& right_column, Vector& row, Vector& column) const;

  std::size_t memory_bytes() const noexcept {
    return static_cast<std::size_t>(coupling_.size() + upper_.size()) * sizeof(double);
  }

 private:
  void eliminate(Eigen::Index begin, Eigen::Index end);

  Matrix coupling_;
  Vector of_column_;  // k_j + Σ_i D_ij
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> upper_;
  Vector excess_, pivot_;
};

}  // namespace bowstring::unbalanced
