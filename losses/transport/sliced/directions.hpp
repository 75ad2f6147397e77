#pragma once

#include <vector>

#include "core/lie/so3.hpp"

namespace bowstring::sliced {

/// `count` unit vectors, the same for a seed on every machine. They come as the axes of uniformly drawn rotations,
/// three at a time: Σ θθᵀ over each three is the identity, so that the mean of (θ·t)² is |t|²/3 exactly where `count`
/// is divisible by 3, and varies less than with independent vectors where it is not.
std::vector<Vector3> directions(int count, long seed);

}  // namespace bowstring::sliced
