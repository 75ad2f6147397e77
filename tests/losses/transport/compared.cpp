#include "tests/losses/transport/compared.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/transport/check_measure.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::testing {
namespace {

double largest(const std::vector<double>& numbers) {
  double out = 0.0;
  for (const double number : numbers) out = std::max(out, std::fabs(number));
  return out;
}

/// Central difference of the value as one number of a measure moves; `from` loses what `to` gains where it is given.
double difference(TransportComparison& transport, Measure a, Measure b, std::vector<double>& (*part)(Measure&),
                  bool of_b, std::size_t to, long from, double step) {
  const auto at = [&](double size) {
    Measure moved_a = a, moved_b = b;
    std::vector<double>& numbers = part(of_b ? moved_b : moved_a);
    numbers[to] += size;
    if (from >= 0) numbers[static_cast<std::size_t>(from)] -= size;
    return value_of(transport, moved_a, moved_b);
  };
  return (at(step) - at(-step)) / (2.0 * step);
}

std::vector<double>& positions(Measure& measure) { return measure.position; }
std::vector<double>& weights(Measure& measure) { return measure.weight; }

}  // namespace

TransportComparison opened(const std::string& method, const std::vector<Override>& settings, const std::string& cost) {
  static PluginHost plugins;
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open({method, cost, settings}, plugins, refusal);
  INFO(refusal.text());
  REQUIRE(out);
  return std::move(*out);
}

TransportResult compared(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult result;
  const Status status = transport.compare(a, b, result);
  INFO(status.text);
  REQUIRE(status.ok());
  return result;
}

double value_of(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult result;
  const Status status = transport.compare(a, b, result, false);
  INFO(status.text);
  REQUIRE(status.ok());
  return result.answer.value;
}

Measure random_cloud(int count, unsigned seed, double size, bool uniform) {
  std::mt19937_64 generator(seed);
  const auto draw = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  Measure out;
  for (int i = 0; i < 3 * count; ++i) out.position.push_back(size * (draw() - 0.5));
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += out.weight.emplace_back(0.2 + draw());
  for (double& weight : out.weight) weight /= sum;
  if (uniform) out.weight = uniform_weights(out.count());
  return out;
}

Measure shifted(Measure measure, double x, double y, double z) {
  const double shift[] = {x, y, z};
  for (std::size_t i = 0; i < measure.position.size(); ++i) measure.position[i] += shift[i % 3];
  return measure;
}

double gradient_error(TransportComparison& transport, const Measure& a, const Measure& b, double step, double least) {
  transport.forget();
  const TransportResult result = compared(transport, a, b);
  double by_place = 0.0, by_weight = 0.0;
  for (const bool of_b : {false, true}) {
    const std::vector<double>& reported = of_b ? result.gradient_b.position : result.gradient_a.position;
    REQUIRE(largest(reported) > least);
    for (std::size_t k = 0; k < reported.size(); ++k) {
      const double found = difference(transport, a, b, positions, of_b, k, -1, step);
      by_place = std::max(by_place, std::fabs(found - reported[k]) / largest(reported));
    }
    const std::vector<double>& weighed = of_b ? result.answer.weight_gradient_b : result.answer.weight_gradient_a;
    REQUIRE(largest(weighed) > least);
    for (std::size_t k = 1; k < weighed.size(); ++k) {
      const double found = difference(transport, a, b, weights, of_b, k, 0, step * 1e-1);
      by_weight = std::max(by_weight, std::fabs(found - (weighed[k] - weighed[0])) / largest(weighed));
    }
  }
  return std::max(by_place, by_weight);
}

}  // namespace bowstring::testing
