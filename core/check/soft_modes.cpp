#include "core/check/soft_modes.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <Eigen/SparseLU>

#include "core/certificate/multipliers.hpp"
#include "core/check/mode_names.hpp"
#include "core/check/states.hpp"
#include "core/check/unknowns.hpp"

namespace bowstring::checking {

namespace {

using Dense = Eigen::MatrixXd;
using Numbers = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
constexpr int block = 12;        // modes that are looked for
constexpr int sweeps = 8;        // of inverse iteration
constexpr double shift = 1e-11;  // of the largest stiffness, so that the matrix has an inverse
constexpr double slack = 1e-10;  // of 1/stiffness, by which equality rows give way, so that they may be redundant

/// Unknowns in mm: x = scale · δ.
class SoftSearch {
 public:
  SoftSearch(Assembly& assembly, const std::vector<double>& q) : assembly_(assembly), n_(assembly.unknowns()) {
    scale_ = Numbers(n_);
    for (int u = 0; u < n_; ++u) scale_[u] = assembly.stationarity_scale()[at(u)];
    status_ = find_hessian(q);
    if (status_.ok()) status_ = find_rows(q);
  }

  std::vector<CheckLine> run(const std::vector<double>& q, const std::vector<std::vector<double>>& known) {
    if (!status_.ok()) return {line(CheckVerdict::note, "not judged: " + status_.text)};
    if (n_ == 0) return {};
    if (!(stiffness_ > 0.0))
      return {line(CheckVerdict::note, "not judged: no energy has a second derivative at the start")};
    for (const auto& rate : known) add_row(rate);
    Dense modes = near_null_space();
    if (!factorised_) return {line(CheckVerdict::note, "not judged: the matrix could not be factorised")};
    if (modes.cols() == 0) return {line(CheckVerdict::ok, "no other mode is near zero")};
    return name_modes(assembly_, q, scale_, std::move(modes), full_);
  }

 private:
  static CheckLine line(CheckVerdict verdict, const std::string& text) {
    return {verdict, "the scene", "soft modes", unjudged, "", text};
  }

  Status find_hessian(const std::vector<double>& q) {
    std::vector<double> multipliers;
    constexpr double equalities_alone = -1e300;
    if (Status status = estimate_multipliers(assembly_, q, equalities_alone, multipliers); !status.ok()) return status;
    const SparsityPattern pattern = assembly_.hessian_pattern();
    std::vector<double> values(at(pattern.entries()));
    if (Status status = assembly_.lagrangian_hessian(q, 1.0, multipliers, values); !status.ok()) return status;
    Entries entries;
    for (int j = 0; j < n_; ++j) {
      for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
        const int i = pattern.inner[at(k)];
        const double value = values[at(k)] / (scale_[i] * scale_[j]);
        if (value == 0.0) continue;
        entries.emplace_back(i, j, value);
        if (i != j) entries.emplace_back(j, i, value);
        stiffness_ = std::max(stiffness_, i == j ? std::fabs(value) : 0.0);
      }
    }
    hessian_ = Sparse(n_, n_);
    hessian_.setFromTriplets(entries.begin(), entries.end());
    return {};
  }

  Status find_rows(const std::vector<double>& q) {
    const SparsityPattern pattern = assembly_.jacobian_pattern();
    std::vector<double> jacobian(at(pattern.entries()));
    ProblemEvaluation wanted;
    wanted.jacobian = jacobian;
    if (Status status = assembly_.evaluate(q, wanted); !status.ok()) return status;
    for (int r = 0; r < assembly_.rows(); ++r) {
      if (assembly_.row_lower()[at(r)] != assembly_.row_upper()[at(r)]) continue;
      double squared = 0.0;
      const auto entry = [&](int k) { return jacobian[at(k)] / scale_[pattern.inner[at(k)]]; };
      for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) squared += entry(k) * entry(k);
      if (squared == 0.0) continue;
      for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
        rows_.emplace_back(row_count_, pattern.inner[at(k)], entry(k) / std::sqrt(squared));
      }
      ++row_count_;
    }
    return {};
  }

  /// What is sought is orthogonal to a motion that is known.
  void add_row(const std::vector<double>& rate) {
    const std::vector<double> own = free_part(assembly_, rate);
    Numbers row(n_);
    for (int u = 0; u < n_; ++u) row[u] = scale_[u] * own[at(u)];
    const double size = row.norm();
    if (size == 0.0) return;
    for (int u = 0; u < n_; ++u) {
      if (row[u] != 0.0) rows_.emplace_back(row_count_, u, row[u] / size);
    }
    ++row_count_;
  }

  /// Softer than the longest wave of a rod of so many nodes: (π/N)⁴/16 of the stiffest, by a hundred.
  double near_zero() const {
    int nodes = 3;
    for (const auto& curve : assembly_.scene().curves) nodes = std::max(nodes, curve->view.nodes);
    const double longest = std::pow(3.14159265358979323846 / nodes, 4) / 16.0;
    return stiffness_ * std::clamp(0.01 * longest, 1e-13, 1e-11);
  }

  /// Inverse iteration with the rows as a bordered matrix; the orthonormal modes with |μ| near zero.
  Dense near_null_space() {
    Entries entries;
    for (int j = 0; j < n_; ++j) {
      for (Sparse::InnerIterator it(hessian_, j); it; ++it) entries.emplace_back(it.row(), j, it.value());
      entries.emplace_back(j, j, shift * stiffness_);
    }
    for (const auto& e : rows_) {
      entries.emplace_back(n_ + e.row(), e.col(), stiffness_ * e.value());
      entries.emplace_back(e.col(), n_ + e.row(), stiffness_ * e.value());
    }
    for (int r = 0; r < row_count_; ++r) entries.emplace_back(n_ + r, n_ + r, -slack * stiffness_);
    Sparse matrix(n_ + row_count_, n_ + row_count_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Sparse> lu(matrix);
    if (lu.info() != Eigen::Success) {
      factorised_ = false;
      return Dense(n_, 0);
    }
    Sparse rows(row_count_, n_);
    rows.setFromTriplets(rows_.begin(), rows_.end());
    const int count = std::min(block, n_);
    const std::vector<double> seed = random_numbers(n_ * count, 5);
    Dense x = Eigen::Map<const Dense>(seed.data(), n_, count);
    Numbers value(count);
    for (int s = 0; s < sweeps; ++s) {
      Dense right = Dense::Zero(n_ + row_count_, count);
      right.topRows(n_) = x;
      const Dense solved = lu.solve(right);
      x = Eigen::HouseholderQR<Dense>(solved.topRows(n_)).householderQ() * Dense::Identity(n_, count);
      // What leaves the rows' null space counts as stiff, or it would mix with the modes where they are few.
      const Dense off = rows * x;
      const Eigen::SelfAdjointEigenSolver<Dense> ritz(x.transpose() * (hessian_ * x) +
                                                      stiffness_ * off.transpose() * off);
      x = (x * ritz.eigenvectors()).eval();
      value = ritz.eigenvalues();
    }
    return select(x, value);
  }

  Dense select(const Dense& x, const Numbers& value) {
    Dense out(n_, x.cols());
    int kept = 0;
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      if (std::fabs(value[k]) <= near_zero()) out.col(kept++) = x.col(k);
    }
    full_ = kept == block && kept < n_;
    return out.leftCols(kept);
  }

  Assembly& assembly_;
  int n_;
  Numbers scale_;
  Sparse hessian_;
  Entries rows_;
  int row_count_ = 0;
  double stiffness_ = 0.0;  // largest diagonal entry, N/mm
  bool factorised_ = true, full_ = false;
  Status status_;
};

}  // namespace

std::vector<CheckLine> find_soft_modes(Assembly& assembly, const std::vector<double>& q,
                                       const std::vector<std::vector<double>>& known) {
  return SoftSearch(assembly, q).run(q, known);
}

}  // namespace bowstring::checking
