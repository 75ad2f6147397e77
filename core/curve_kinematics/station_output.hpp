#pragma once

#include <algorithm>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/lie/small_matrix.hpp"

namespace bowstring {

/// Where one evaluation of the site `station` writes its numbers: y = (ζ[, ds, s]) over stencils whose last unknown is
/// L on a sliding wire. `m` components of ζ, over at most `columns` other unknowns.
template <int m, int columns>
class StationOutput {
 public:
  /// `length`: L at this state, read on a sliding wire only.
  StationOutput(const CurveMesh& mesh, double length, const SiteEvaluation& out) noexcept
      : out_(&out), length_(length), varying_(mesh.sliding() ? 1 : 0) {}

  bool wants_values() const noexcept { return !out_->values.empty(); }
  bool wants_jacobian() const noexcept { return !out_->jacobian.empty(); }
  bool wants_curvature() const noexcept { return !out_->curvature.empty(); }

  void write_values(int index, const Station& station, const Vector<m>& strain) const noexcept {
    double* y = out_->values.data() + index * values();
    strain.store(y);
    if (varying_ == 0) return;
    y[m] = station.ds.at(length_);
    y[m + 1] = station.arc.at(length_);
  }

  void write_jacobian(int index, const Station& station, const Matrix<m, columns>& by_unknowns) const noexcept {
    double* b = out_->jacobian.data() + index * values() * width();
    std::fill(b, b + values() * width(), 0.0);
    for (int a = 0; a < m; ++a) {
      for (int j = 0; j < columns; ++j) b[a * width() + j] = by_unknowns(a, j);
    }
    if (varying_ == 0) return;
    b[m * width() + columns] = station.ds.slope;
    b[(m + 1) * width() + columns] = station.arc.slope;
  }

  /// Of ζ's part of the stress.
  Vector<m> stress(int index) const noexcept { return Vector<m>::load(out_->stress.data() + index * values()); }

  /// Lower triangle. ds and s are linear in L, which the site declares.
  void write_curvature(int index, const Matrix<columns, columns>& by_unknowns) const noexcept {
    double* h = out_->curvature.data() + index * packed_size(columns);
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j <= i; ++j) *h++ = by_unknowns(i, j);
    }
  }

 private:
  int values() const noexcept { return m + 2 * varying_; }
  int width() const noexcept { return columns + varying_; }

  const SiteEvaluation* out_;
  double length_;
  int varying_;
};

}  // namespace bowstring
