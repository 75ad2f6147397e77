#include "losses/transport/sliced/directions.hpp"

#include <cmath>
#include <random>

namespace bowstring::sliced {
namespace {

constexpr double two_pi = 6.283185307179586477;

/// In [0, 1), by the 53 upper bits: distributions of the standard library differ between implementations.
double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

/// K. Shoemake, "Uniform random rotations", Graphics Gems III (1992) 124.
lie::Rotation uniform_rotation(std::mt19937_64& generator) {
  const double share = uniform(generator), one = two_pi * uniform(generator), two = two_pi * uniform(generator);
  const double r = std::sqrt(1.0 - share), s = std::sqrt(share);
  return {s * std::cos(two), r * std::sin(one), r * std::cos(one), s * std::sin(two)};
}

}  // namespace

std::vector<Vector3> directions(int count, long seed) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  std::vector<Vector3> out;
  while (static_cast<int>(out.size()) < count) {
    const Matrix3 axes = uniform_rotation(generator).matrix();
    for (int k = 0; k < 3 && static_cast<int>(out.size()) < count; ++k) {
      out.push_back({{axes(0, k), axes(1, k), axes(2, k)}});
    }
  }
  return out;
}

}  // namespace bowstring::sliced
