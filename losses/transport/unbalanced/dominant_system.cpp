#include "losses/transport/unbalanced/dominant_system.hpp"

#include <algorithm>

namespace bowstring::unbalanced {

void DominantSystem::factor(const Matrix& coupling, const Vector& excess_row, const Vector& excess_column) {
  const Eigen::Index rows = coupling.rows();
  coupling_ = coupling;
  of_column_ = excess_column + coupling.colwise().sum().transpose();
  excess_ = excess_row + (coupling.matrix() * (excess_column / of_column_).matrix()).array();
  pivot_.resize(rows);
  upper_.setZero(rows, rows);
  const Matrix scaled = coupling.rowwise() * of_column_.sqrt().inverse().transpose();
  upper_.selfadjointView<Eigen::Upper>().rankUpdate(scaled.matrix());

  constexpr Eigen::Index block = 48;
  for (Eigen::Index begin = 0; begin < rows; begin += block) {
    const Eigen::Index end = std::min(begin + block, rows), rest = rows - end;
    eliminate(begin, end);
    if (rest == 0) break;
    const Eigen::MatrixXd panel = upper_.block(begin, end, end - begin, rest).transpose() *
                                  pivot_.segment(begin, end - begin).sqrt().inverse().matrix().asDiagonal();
    upper_.bottomRightCorner(rest, rest).selfadjointView<Eigen::Upper>().rankUpdate(panel);
  }
}

/// These rows, to their ends; of the rows below only what is in excess.
void DominantSystem::eliminate(Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index rows = upper_.rows();
  for (Eigen::Index k = begin; k < end; ++k) {
    const Eigen::Index after = rows - k - 1;
    const auto row = upper_.row(k).tail(after);
    pivot_[k] = excess_[k] + row.sum();
    excess_.tail(after) += row.transpose().array() * (excess_[k] / pivot_[k]);
    for (Eigen::Index i = k + 1; i < end; ++i) {
      upper_.row(i).tail(rows - i - 1) += upper_(k, i) / pivot_[k] * upper_.row(k).tail(rows - i - 1);
    }
  }
}

void DominantSystem::solve(const Vector& right_row, const Vector& right_column, Vector& row, Vector& column) const {
  const Eigen::Index rows = upper_.rows();
  const Vector of_columns = right_column / of_column_;
  row = right_row - (coupling_.matrix() * of_columns.matrix()).array();
  for (Eigen::Index k = 0; k < rows; ++k) {
    row[k] /= pivot_[k];
    row.tail(rows - k - 1) += row[k] * upper_.row(k).tail(rows - k - 1).transpose().array();
  }
  for (Eigen::Index k = rows; k-- > 0;) {
    row[k] += upper_.row(k).tail(rows - k - 1).dot(row.tail(rows - k - 1).matrix()) / pivot_[k];
  }
  column = of_columns - (coupling_.matrix().transpose() * row.matrix()).array() / of_column_;
}

}  // namespace bowstring::unbalanced
