#include "study/plan/samples.hpp"

#include <cstddef>
#include <random>
#include <utility>

#include <boost/random/sobol.hpp>

namespace bowstring::study {
namespace {

constexpr int bits = 53;

/// In (0, 1): the middle of the cell that 53 bits name.
double unit_number(std::uint64_t word) {
  return (static_cast<double>(word >> (64 - bits)) + 0.5) / static_cast<double>(std::uint64_t{1} << bits);
}

/// Unbiased, and the same with every standard library, which distributions of <random> are not.
std::uint64_t below(std::uint64_t limit, std::mt19937_64& random) {
  const std::uint64_t rest = (~std::uint64_t{0} % limit + 1) % limit;
  std::uint64_t word = random();
  while (rest != 0 && word >= ~std::uint64_t{0} - rest + 1) word = random();
  return word % limit;
}

}  // namespace

std::vector<double> sobol_points(int count, int dimension, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint64_t> shift;
  for (int k = 0; k < dimension; ++k) shift.push_back(random());
  boost::random::sobol_engine<std::uint64_t, 64> sobol(static_cast<std::size_t>(dimension));
  std::vector<double> out;
  for (int k = 0; k < dimension; ++k) out.push_back(unit_number(shift[static_cast<std::size_t>(k)]));  // point 0 is 0
  for (int i = 1; i < count; ++i) {
    for (int k = 0; k < dimension; ++k) out.push_back(unit_number(sobol() ^ shift[static_cast<std::size_t>(k)]));
  }
  return out;
}

std::vector<double> latin_hypercube_points(int count, int dimension, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto size = static_cast<std::size_t>(count);
  const auto width = static_cast<std::size_t>(dimension);
  std::vector<double> out(size * width);
  for (std::size_t k = 0; k < width; ++k) {
    std::vector<std::size_t> stratum(size);
    for (std::size_t i = 0; i < size; ++i) stratum[i] = i;
    for (std::size_t i = size; i > 1; --i) std::swap(stratum[i - 1], stratum[below(i, random)]);
    for (std::size_t i = 0; i < size; ++i) {
      out[i * width + k] = (static_cast<double>(stratum[i]) + unit_number(random())) / static_cast<double>(count);
    }
  }
  return out;
}

}  // namespace bowstring::study
