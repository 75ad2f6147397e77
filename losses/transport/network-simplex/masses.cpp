#include "losses/transport/network-simplex/masses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "core/transport/check_measure.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::simplex {
namespace {

constexpr std::int64_t whole = std::int64_t{1} << 60;
/// A weight is a double, so that what is equal in sum may differ by 2^-53 of the whole.
constexpr std::int64_t noise_of_whole = whole >> 50;

struct Side {
  double sum = 0.0, largest = 0.0, smallest = 0.0;  ///< of the positive weights
  std::int64_t places = 0;                          ///< with mass

  bool alike() const noexcept { return largest - smallest <= 4e-16 * largest; }
};

Side look_at(Span<const double> weight, const char* which) {
  Side out;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (!(weight[k] >= 0.0 && std::isfinite(weight[k]))) {
      throw StatusError(Code::invalid_input, std::string("weight ") + std::to_string(k) + " of the " + which +
                                                 " measure is negative or not finite; expected a number >= 0");
    }
    if (weight[k] == 0.0) continue;
    out.smallest = out.places == 0 ? weight[k] : std::min(out.smallest, weight[k]);
    out.largest = std::max(out.largest, weight[k]);
    out.sum += weight[k];
    ++out.places;
  }
  if (out.places > 0) return out;
  throw StatusError(Code::invalid_input, std::string("the ") + which +
                                             " measure has no mass; expected at least one weight that is not zero");
}

std::vector<std::int64_t> counts(Span<const double> weight, std::int64_t each) {
  std::vector<std::int64_t> out(weight.size());
  std::transform(weight.begin(), weight.end(), out.begin(), [each](double w) { return w > 0.0 ? each : 0; });
  return out;
}

/// What rounding leaves of the whole goes to the heaviest place.
std::vector<std::int64_t> quantised(Span<const double> weight, double sum) {
  std::vector<std::int64_t> out(weight.size());
  std::transform(weight.begin(), weight.end(), out.begin(),
                 [sum](double w) { return std::llround(w / sum * static_cast<double>(whole)); });
  *std::max_element(out.begin(), out.end()) += whole - std::accumulate(out.begin(), out.end(), std::int64_t{0});
  return out;
}

}  // namespace

Masses masses_of(Span<const double> weight_a, Span<const double> weight_b) {
  const Side a = look_at(weight_a, "first"), b = look_at(weight_b, "second");
  const std::string mismatch = sum_mismatch({weight_a.begin(), weight_a.end()}, {weight_b.begin(), weight_b.end()});
  if (!mismatch.empty()) throw StatusError(Code::invalid_input, mismatch + "; expected equal sums");
  const double sum = 0.5 * (a.sum + b.sum);
  if (a.alike() && b.alike()) {
    const std::int64_t all = std::lcm(a.places, b.places);
    return {counts(weight_a, all / a.places), counts(weight_b, all / b.places), sum / static_cast<double>(all), 0};
  }
  return {quantised(weight_a, a.sum), quantised(weight_b, b.sum), sum / static_cast<double>(whole), noise_of_whole};
}

}  // namespace bowstring::simplex
