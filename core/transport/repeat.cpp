#include "core/transport/repeat.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>

#include "core/lie/small_matrix.hpp"

namespace bowstring {
namespace {

constexpr double step_share = 0.1;  // of the spacing
constexpr int most_cold = 5;

/// A unit vector, evenly distributed, of numbers that are the same with every library.
Vector3 drawn_direction(std::mt19937_64& random) {
  const auto number = [&random] { return std::ldexp(static_cast<double>(random() >> 11U), -53); };
  constexpr double pi = 3.14159265358979323846;
  const double z = 2.0 * number() - 1.0, angle = 2.0 * pi * number(), across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {{across * std::cos(angle), across * std::sin(angle), z}};
}

void move_places(Measure& measure, double step, std::mt19937_64& random) {
  for (std::size_t i = 0; i < measure.count(); ++i) {
    double* place = &measure.position[3 * i];
    (Vector3::load(place) + step * drawn_direction(random)).store(place);
  }
}

}  // namespace

Spread spread_of(std::vector<double> numbers) {
  if (numbers.empty()) return {};
  std::sort(numbers.begin(), numbers.end());
  const std::size_t half = numbers.size() / 2;
  const double median = numbers.size() % 2 == 1 ? numbers[half] : 0.5 * (numbers[half - 1] + numbers[half]);
  return {median, numbers.front(), numbers.back()};
}

double mean_spacing(const Measure& measure) {
  const std::size_t count = measure.count();
  if (count < 2) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    double nearest = HUGE_VAL;
    const Vector3 here = Vector3::load(&measure.position[3 * i]);
    for (std::size_t j = 0; j < count; ++j) {
      if (j != i) nearest = std::min(nearest, norm_squared(Vector3::load(&measure.position[3 * j]) - here));
    }
    sum += std::sqrt(nearest);
  }
  return sum / static_cast<double>(count);
}

Status repeat_comparison(TransportComparison& comparison, const Measure& a, const Measure& b, int count, long seed,
                         RepeatRecord& out) {
  out = {};
  out.count = count;
  out.seed = seed;
  out.step = step_share * mean_spacing(a);
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  Measure moved = a;
  std::vector<Measure> last;
  std::vector<double> seconds, iterations;
  TransportResult result;
  for (int k = 0; k < count; ++k) {
    move_places(moved, out.step, random);
    if (const Status status = comparison.compare(moved, b, result, false); !status.ok()) return status;
    seconds.push_back(result.cost_seconds + result.solve_seconds);
    iterations.push_back(static_cast<double>(result.answer.iterations));
    if (k + most_cold >= count) last.push_back(moved);
  }
  out.warm = spread_of(std::exchange(seconds, {}));
  out.iterations = spread_of(std::exchange(iterations, {}));
  for (const Measure& measure : last) {
    comparison.forget();
    if (const Status status = comparison.compare(measure, b, result, false); !status.ok()) return status;
    seconds.push_back(result.cost_seconds + result.solve_seconds);
    iterations.push_back(static_cast<double>(result.answer.iterations));
  }
  out.cold = spread_of(std::move(seconds));
  out.cold_iterations = spread_of(std::move(iterations));
  return {};
}

}  // namespace bowstring
