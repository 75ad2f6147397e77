#pragma once

#include <cstddef>
#include <vector>

namespace bowstring {

/// Weighted points of space, with orientations where they are frames: what a curve or an observation becomes.
struct Measure {
  std::vector<double> position;     ///< count × 3, mm
  std::vector<double> orientation;  ///< count × 4 unit quaternions (w, x, y, z), first axis along the curve; or empty
  std::vector<double> weight;       ///< count, not negative

  std::size_t count() const noexcept { return position.size() / 3; }
  bool has_frames() const noexcept { return !orientation.empty(); }
};

}  // namespace bowstring
