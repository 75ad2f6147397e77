#pragma once

#include <vector>

#include "geodesic_flow.hpp"

namespace bowstring::geodesics {

/// A geodesic of [0, 1] from the identity to a target.
struct Shot {
  bool converged = false;
  std::vector<Covector> parts;  ///< the covector at the start of each part
  double squared = 0.0;         ///< 2H
  int iterations = 0;
};

/// Newton's method, damped, for the covectors at the start of equal parts of [0, 1], so that the parts follow on each
/// other and end in `target`: one part is single shooting. The tangent leaves its unstable direction like
/// exp(length), which is why longer geodesics need more parts.
///
/// `guess`: one covector per part, at most `most_parts`. `size`: about the distance; what is shorter than 1 is measured
/// in the dilation of that size, bends and forward motion as 1, lateral motion as its square, or √κ of it where that is
/// more.
Shot shoot(const lie::Se3& target, const std::vector<Covector>& guess, const Weights& weights, double size);

inline constexpr int most_parts = 40;

}  // namespace bowstring::geodesics
