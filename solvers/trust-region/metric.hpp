#pragma once

#include <vector>

#include "core/interfaces/problem.hpp"

namespace bowstring::trust_region {

/// How far a step goes, in mm, whatever the mesh: the root mean square over all unknowns of displacements, and of
/// rotations times a length of the scene. S = diag(weight), |δ|² = δᵀSδ.
class Metric {
 public:
  /// `q`: the start; its extent is the scene's length.
  void set_up(const Problem& problem, Span<const double> q);

  const std::vector<double>& weight() const noexcept { return weight_; }
  double length() const noexcept { return length_; }  ///< mm
  double norm(Span<const double> delta) const noexcept;
  double product(Span<const double> one, Span<const double> other) const noexcept;

 private:
  std::vector<double> weight_;
  double length_ = 1.0;
};

}  // namespace bowstring::trust_region
