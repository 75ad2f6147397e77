#include "solvers/newton/inertia_correction.hpp"

#include <algorithm>

#include "solvers/newton/stopwatch.hpp"

namespace bowstring::newton {

namespace {

// N/mm
constexpr double first_shift = 1e-4, smallest_shift = 1e-12, largest_shift = 1e12;
constexpr double first_growth = 100.0, growth = 8.0, decay = 1.0 / 3.0;

}  // namespace

bool InertiaCorrection::factor(kkt::KktSystem& system, kkt::KktSystem::Values values, double least_shift,
                               SolverResult& count) {
  const Stopwatch watch(count.factorization_seconds);
  const auto attempt = [&](double shift) {
    values.shift = shift_ = shift;
    outcome_ = system.factor(values);
    ++count.factorizations;
    return outcome_.exists && outcome_.saddle_directions == 0;
  };
  bool good = attempt(least_shift);
  const bool shifted = !good;
  double shift = std::max(last_ == 0.0 ? first_shift : std::max(smallest_shift, decay * last_), growth * least_shift);
  while (!good && shift <= largest_shift) {
    good = attempt(shift);
    if (!good) shift *= last_ == 0.0 ? first_growth : growth;
  }
  if (good && shifted) last_ = shift_;
  return good;
}

}  // namespace bowstring::newton
