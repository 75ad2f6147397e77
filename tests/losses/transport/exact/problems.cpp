#include "problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plugins/host/plugin_host.hpp"

namespace exact_test {
namespace {

PluginHost& plugins() {
  static PluginHost host;
  return host;
}

bool offered(const std::string& method) {
  const std::vector<std::string> names = plugins().names(Kind::transport);
  return std::find(names.begin(), names.end(), method) != names.end();
}

}  // namespace

const std::vector<std::string>& exact_methods() {
  static const std::vector<std::string> methods =
      offered("exact-lemon") ? std::vector<std::string>{"exact", "exact-lemon"} : std::vector<std::string>{"exact"};
  return methods;
}

TransportComparison open_comparison(const std::string& method, const std::string& cost) {
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open({method, cost, {}}, plugins(), refusal);
  REQUIRE_MESSAGE(out, refusal.text());
  return *std::move(out);
}

Owned<Transport> open_method(const std::string& method) {
  Status status;
  Owned<Transport> out = create<Transport>(open_comparison(method).choice().method, status);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

Status solve_into(TransportComparison& comparison, const MatrixProblem& problem, TransportAnswer& out) {
  TransportResult result;
  const Status status = comparison.compare(problem.a, problem.b, problem.cost, result);
  out = std::move(result.answer);
  return status;
}

TransportAnswer solve_cold(const std::string& method, const MatrixProblem& problem) {
  TransportComparison comparison = open_comparison(method);
  TransportAnswer out;
  const Status status = solve_into(comparison, problem, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  CHECK_FALSE(out.warm);
  return out;
}

void check_proof(const MatrixProblem& problem, const TransportAnswer& answer, double tolerance) {
  const std::size_t columns = problem.b.size();
  const double mass = std::accumulate(problem.a.begin(), problem.a.end(), 0.0);
  const double scale = answer.certificate.cost_scale;
  REQUIRE(answer.certified);
  CHECK(answer.certificate.marginal_a <= tolerance * mass);
  CHECK(answer.certificate.marginal_b <= tolerance * mass);
  CHECK(answer.certificate.dual_violation <= tolerance * scale);
  CHECK(std::fabs(answer.certificate.gap) <= tolerance * scale * mass);

  std::vector<double> left_a = problem.a, left_b = problem.b;
  double value = 0.0, dual = 0.0;
  for (std::size_t k = 0; k < answer.plan.value.size(); ++k) {
    const auto i = static_cast<std::size_t>(answer.plan.row[k]), j = static_cast<std::size_t>(answer.plan.column[k]);
    CHECK(answer.plan.value[k] > 0.0);
    left_a[i] -= answer.plan.value[k];
    left_b[j] -= answer.plan.value[k];
    value += answer.plan.value[k] * problem.cost[i * columns + j];
  }
  double violation = 0.0, sum_a = 0.0, sum_b = 0.0;
  for (std::size_t i = 0; i < problem.a.size(); ++i) {
    sum_a += problem.a[i] * answer.dual_a[i];
    for (std::size_t j = 0; j < columns; ++j) {
      violation = std::max(violation, answer.dual_a[i] + answer.dual_b[j] - problem.cost[i * columns + j]);
    }
  }
  for (std::size_t j = 0; j < columns; ++j) sum_b += problem.b[j] * answer.dual_b[j];
  dual = sum_a + sum_b;
  for (const std::vector<double>* left : {&left_a, &left_b}) {
    for (const double error : *left) CHECK(std::fabs(error) <= tolerance * mass);
  }
  CHECK(violation <= tolerance * scale);
  CHECK(std::fabs(value - answer.value) <= tolerance * scale * mass);
  CHECK(std::fabs(dual - answer.value) <= tolerance * scale * mass);
  CHECK(std::fabs(sum_a - sum_b) <= tolerance * scale * mass);
}

double uniform(std::mt19937& random) { return (static_cast<double>(random()) + 0.5) / 4294967296.0; }

int below(std::mt19937& random, int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); }

std::vector<double> random_cloud(std::mt19937& random, int count) {
  std::vector<double> out(static_cast<std::size_t>(3 * count));
  for (double& x : out) x = 10.0 * (uniform(random) + uniform(random) + uniform(random));
  return out;
}

std::vector<double> random_curve(std::mt19937& random, int count) {
  const double turns = 3.0 + 3.0 * uniform(random), phase = 6.0 * uniform(random), tilt = uniform(random) - 0.5;
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count, angle = 6.283 * turns * t + phase;
    const double x = 30.0 * std::cos(angle), y = 30.0 * std::sin(angle), z = 20.0 * t;
    out.insert(out.end(), {x, y * std::cos(tilt) - z * std::sin(tilt), y * std::sin(tilt) + z * std::cos(tilt)});
  }
  return out;
}

std::vector<double> squared_distances(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out;
  out.reserve(a.size() * b.size() / 9);
  for (std::size_t i = 0; i < a.size(); i += 3) {
    for (std::size_t j = 0; j < b.size(); j += 3) {
      const double x = a[i] - b[j], y = a[i + 1] - b[j + 1], z = a[i + 2] - b[j + 2];
      out.push_back(x * x + y * y + z * z);
    }
  }
  return out;
}

std::vector<double> random_weights(std::mt19937& random, int count) {
  std::vector<double> out(static_cast<std::size_t>(count));
  for (double& weight : out) weight = uniform(random);
  const double sum = std::accumulate(out.begin(), out.end(), 0.0);
  for (double& weight : out) weight /= sum;
  return out;
}

}  // namespace exact_test
