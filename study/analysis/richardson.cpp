#include "study/analysis/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/tools/toms748_solve.hpp>

#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double rounding = 1e-12;  // of a value: what two equal values may differ by
constexpr double least_order = 0.3, most_order = 6.0;
constexpr double least_root = -20.0, most_root = 40.0;

Extrapolation refused(const std::string& why) { return {unknown, unknown, unknown, why}; }

std::string listed(const double value[3]) {
  return figure(value[0], 7) + ", " + figure(value[1], 7) + ", " + figure(value[2], 7);
}

Extrapolation from_three(const double x[3], const double f[3]) {
  const double coarse = f[1] - f[0], fine = f[2] - f[1];
  const double blur = rounding * std::max(std::fabs(f[1]), std::fabs(f[2]));
  if (std::fabs(fine) <= blur) return {f[2], unknown, std::max(std::fabs(fine), blur), ""};
  if (coarse * fine <= 0.0) return refused("the three finest values, " + listed(f) + ", are not monotone");
  const double order = order_of_two({x[0], x[1], std::fabs(coarse)}, {x[1], x[2], std::fabs(fine)});
  if (order < least_order || order > most_order) {
    return refused("the three finest values, " + listed(f) + ", have order " + figure(order, 2) +
                   ", outside 0.3…6: they do not settle as a refinement does");
  }
  const double rest = fine / std::expm1(order * std::log(x[2] / x[1]));
  return {f[2] + rest, order, std::fabs(rest), ""};
}

}  // namespace

double difference_shape(const Difference& difference, double order) {
  const double start = -order * std::log(difference.a);
  if (!std::isfinite(difference.b)) return start;
  const double step = std::log(difference.b / difference.a), turned = order * step;
  return start + std::log(std::fabs(turned) < 1e-8 ? step : -std::expm1(-turned) / order);
}

double order_of_two(const Difference& coarse, const Difference& fine) {
  const double wanted = std::log(coarse.size / fine.size);
  const auto miss = [&](double p) { return difference_shape(coarse, p) - difference_shape(fine, p) - wanted; };
  const double low = miss(least_root), high = miss(most_root);  // it rises with p
  if (!(low < 0.0)) return least_root;
  if (!(high > 0.0)) return most_root;
  std::uintmax_t steps = 200;
  const auto bracket = boost::math::tools::toms748_solve(miss, least_root, most_root, low, high,
                                                         boost::math::tools::eps_tolerance<double>(50), steps);
  return 0.5 * (bracket.first + bracket.second);
}

Extrapolation extrapolate(const std::vector<double>& resolution, const std::vector<double>& value) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::isfinite(value[i]) && std::isfinite(resolution[i]) && resolution[i] > 0.0) order.push_back(i);
  }
  if (order.size() < 3) return refused(std::to_string(order.size()) + " values: an extrapolation needs three");
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return resolution[a] < resolution[b]; });
  const std::size_t used = std::min<std::size_t>(order.size(), 4), first = order.size() - used;
  double x[4], f[4];
  for (std::size_t k = 0; k < used; ++k) x[k] = resolution[order[first + k]], f[k] = value[order[first + k]];
  for (std::size_t k = 1; k < used; ++k) {
    if (x[k] == x[k - 1]) return refused("two values at the same resolution, " + figure(x[k], 7));
  }
  Extrapolation out = from_three(x + used - 3, f + used - 3);
  if (!out.ok() || used < 4 || std::isnan(out.order)) return out;
  const Extrapolation before = from_three(x, f);
  if (before.ok()) out.error = std::fabs(out.limit - before.limit);
  return out;
}

}  // namespace bowstring::study
