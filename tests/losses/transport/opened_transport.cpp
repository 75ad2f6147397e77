#include "tests/losses/transport/opened_transport.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/transport/check_measure.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::testing {
namespace {

PluginHost& plugins() {
  static PluginHost host;
  return host;
}

TransportRequest request_of(const std::string& method, const Settings& settings) {
  TransportRequest out;
  out.method = method;
  for (const auto& [key, value] : settings) out.settings.push_back({key, value, "", ""});
  return out;
}

/// Of fourth order.
template <class Change>
double difference(double step, const Change& value_at) {
  return (8.0 * (value_at(step) - value_at(-step)) - (value_at(2.0 * step) - value_at(-2.0 * step))) / (12.0 * step);
}

void check_positions(TransportComparison& transport, const Measure& a, const Measure& b, bool of_first,
                     const std::vector<double>& gradient, double tolerance) {
  const Measure& moved = of_first ? a : b;
  REQUIRE(gradient.size() == moved.position.size());
  const double scale = std::sqrt(squared_norm(gradient));
  REQUIRE(scale > 1e-6);
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    const double expected = difference(1e-4, [&](double by) {
      Measure there = moved;
      there.position[k] += by;
      return of_first ? value_of(transport, there, b) : value_of(transport, a, there);
    });
    CHECK(std::fabs(gradient[k] - expected) <= tolerance * scale);
  }
}

void check_weights(TransportComparison& transport, const Measure& a, const Measure& b, bool of_first,
                   const std::vector<double>& gradient, bool together, double tolerance) {
  const Measure& heavier = of_first ? a : b;
  REQUIRE(gradient.size() == heavier.count());
  const double scale = std::sqrt(squared_norm(gradient));
  REQUIRE(scale > 1e-6);
  for (std::size_t k = together ? 1 : 0; k < gradient.size(); ++k) {
    const double expected = difference(1e-4, [&](double by) {
      Measure there = heavier;
      there.weight[k] += by;
      if (together) there.weight[0] -= by;
      return of_first ? value_of(transport, there, b) : value_of(transport, a, there);
    });
    CHECK(std::fabs(gradient[k] - (together ? gradient[0] : 0.0) - expected) <= tolerance * scale);
  }
}

}  // namespace

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.17g", value);
  const std::string digits = out;
  return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
}

TransportComparison open_transport(const std::string& method, const Settings& settings) {
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open(request_of(method, settings), plugins(), refusal);
  REQUIRE_MESSAGE(out, refusal.text());
  return *std::move(out);
}

std::string refusal_of(const std::string& method, const Settings& settings) {
  Refusal refusal;
  CHECK_FALSE(TransportComparison::open(request_of(method, settings), plugins(), refusal));
  return refusal.text();
}

TransportResult compare(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult out;
  const Status status = transport.compare(a, b, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

double value_of(TransportComparison& transport, const Measure& a, const Measure& b) {
  TransportResult out;
  const Status status = transport.compare(a, b, out, false);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out.answer.value;
}

TransportAnswer compare(TransportComparison& transport, const std::vector<double>& a, const std::vector<double>& b,
                        const std::vector<double>& cost) {
  TransportResult out;
  const Status status = transport.compare(a, b, cost, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return std::move(out.answer);
}

double uniform(std::mt19937& random) { return (static_cast<double>(random()) + 0.5) * 0x1p-32; }

std::vector<double> random_numbers(std::mt19937& random, std::size_t count, double low, double high) {
  std::vector<double> out(count);
  for (double& number : out) number = low + (high - low) * uniform(random);
  return out;
}

Measure random_cloud(std::mt19937& random, std::size_t count) {
  Measure out;
  out.position = random_numbers(random, 3 * count, 0.0, 1.0);
  out.weight = random_numbers(random, count, 0.5, 1.5);
  return out;
}

Measure probability_cloud(std::size_t count, unsigned seed, double edge, bool equal_weights) {
  std::mt19937 random(seed);
  Measure out = random_cloud(random, count);
  if (equal_weights) out.weight = uniform_weights(count);
  for (double& x : out.position) x *= edge;
  const double sum = std::accumulate(out.weight.begin(), out.weight.end(), 0.0);
  for (double& weight : out.weight) weight /= sum;
  return out;
}

Measure shifted(Measure measure, double x, double y, double z) {
  const double shift[] = {x, y, z};
  for (std::size_t k = 0; k < measure.position.size(); ++k) measure.position[k] += shift[k % 3];
  return measure;
}

Measure with_frames(std::mt19937& random, Measure points) {
  for (std::size_t i = 0; i < points.count(); ++i) {
    const std::vector<double> q = random_numbers(random, 4, -1.0, 1.0);
    for (const double part : q) points.orientation.push_back(part / std::sqrt(squared_norm(q)));
  }
  return points;
}

double squared_norm(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

void check_place_gradients(TransportComparison& transport, const Measure& a, const Measure& b, double tolerance) {
  const TransportResult at = compare(transport, a, b);
  check_positions(transport, a, b, true, at.gradient_a.position, tolerance);
  check_positions(transport, a, b, false, at.gradient_b.position, tolerance);
}

void check_weight_gradients(TransportComparison& transport, const Measure& a, const Measure& b, bool together,
                            double tolerance) {
  const TransportAnswer at = compare(transport, a, b).answer;
  check_weights(transport, a, b, true, at.weight_gradient_a, together, tolerance);
  check_weights(transport, a, b, false, at.weight_gradient_b, together, tolerance);
}

}  // namespace bowstring::testing
