#include "metric_frames.hpp"

#include <cstddef>

namespace bowstring::geodesics {

std::vector<lie::Se3> frames_of(const Measure& measure, double shrink) {
  std::vector<lie::Se3> frames(measure.count());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].position = shrink * Vector3::load(&measure.position[3 * i]);
    if (measure.has_frames()) frames[i].rotation = lie::Rotation::load(&measure.orientation[4 * i]).normalized();
  }
  return frames;
}

}  // namespace bowstring::geodesics
