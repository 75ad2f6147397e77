#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bowstring::study {

/// Points of the unit cube, count × dimension, each coordinate in (0, 1). Equal arguments give equal bits on every
/// machine.
///
/// Sobol: the sequence of Boost.Random (direction numbers of Joe and Kuo 2008), point 0 included, with a random digital
/// shift (one 53-bit exclusive or per coordinate) drawn from `seed`; a power of two for `count` keeps its balance.
std::vector<double> sobol_points(int count, int dimension, std::uint64_t seed);

/// Latin hypercube (McKay, Beckman, Conover 1979): per coordinate one point in each of `count` equal strata, at random
/// within it, in a random order.
std::vector<double> latin_hypercube_points(int count, int dimension, std::uint64_t seed);

}  // namespace bowstring::study
