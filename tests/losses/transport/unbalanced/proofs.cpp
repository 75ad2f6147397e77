#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/model/component.hpp"
#include "tests/losses/transport/unbalanced/problems.hpp"

using namespace bowstring;
using namespace bowstring::testing;

namespace {

/// Σ weight ρ (1 − e^{−u/ρ}).
double penalised(const std::vector<double>& weight, const std::vector<double>& dual, double rho) {
  double sum = 0.0;
  for (std::size_t k = 0; k < weight.size(); ++k) sum -= weight[k] * rho * std::expm1(-dual[k] / rho);
  return sum;
}

double dot(const std::vector<double>& weight, const std::vector<double>& dual) {
  double sum = 0.0;
  for (std::size_t k = 0; k < weight.size(); ++k) sum += weight[k] * dual[k];
  return sum;
}

double largest_violation(const TransportAnswer& answer, const std::vector<double>& cost) {
  double largest = 0.0;
  for (std::size_t i = 0; i < answer.dual_a.size(); ++i) {
    for (std::size_t j = 0; j < answer.dual_b.size(); ++j) {
      largest = std::max(largest, answer.dual_a[i] + answer.dual_b[j] - cost[i * answer.dual_b.size() + j]);
    }
  }
  return largest;
}

std::vector<double> random_costs(std::mt19937& random, std::size_t count) {
  std::vector<double> out = random_numbers(random, count, 0.0, 1.0);
  if (random() % 3 == 0) {
    for (double& cost : out) cost = std::round(3.0 * cost);  // ties
  }
  return out;
}

/// Costs that are dear, with lower bounds, and that count how many of them were asked for.
class DearCosts final : public PairCosts {
 public:
  DearCosts(std::vector<double> cost, int rows, int columns) : cost_(std::move(cost)), rows_(rows), columns_(columns) {}

  int row_count() const noexcept override { return rows_; }
  int column_count() const noexcept override { return columns_; }
  bool dear() const noexcept override { return true; }
  const double* matrix() const noexcept override { return nullptr; }
  Status rows(int begin, int end, Span<double> value) noexcept override {
    evaluated += (end - begin) * columns_;
    std::copy(cost_.begin() + begin * columns_, cost_.begin() + end * columns_, value.begin());
    return {};
  }
  Status lower_bounds(int begin, int end, Span<double> value) noexcept override {
    std::transform(cost_.begin() + begin * columns_, cost_.begin() + end * columns_, value.begin(),
                   [](double cost) { return 0.97 * cost; });
    return {};
  }
  Status evaluate(Span<const int> pairs, Span<double> value) noexcept override {
    evaluated += static_cast<int>(value.size());
    for (std::size_t k = 0; k < value.size(); ++k) {
      value[k] = cost_[static_cast<std::size_t>(pairs[2 * k] * columns_ + pairs[2 * k + 1])];
    }
    return {};
  }

  int evaluated = 0;

 private:
  std::vector<double> cost_;
  int rows_, columns_;
};

}  // namespace

TEST_CASE("of dear costs total variation asks for those that its plan uses, and none beyond twice the weight") {
  std::mt19937 random(6);
  const std::vector<double> a = random_numbers(random, 60, 0.5, 1.5), b = random_numbers(random, 50, 0.5, 1.5);
  const std::vector<double> cost = random_numbers(random, 3000, 0.0, 1.0);
  for (const double rho : {0.01, 0.2, 1.0}) {
    TransportComparison transport = unbalanced("total-variation", rho);
    const TransportAnswer expected = compare(transport, a, b, cost);
    Status status;
    Owned<Transport> method = create<Transport>(transport.choice().method, status);
    REQUIRE(status.ok());
    DearCosts dear(cost, 60, 50);
    TransportProblem problem;
    problem.weight_a = a;
    problem.weight_b = b;
    problem.between = &dear;
    TransportAnswer answer;
    REQUIRE(method->solve(problem, answer).ok());
    CHECK(answer.value == doctest::Approx(expected.value).epsilon(1e-13));
    CHECK(std::fabs(answer.gap) <= 1e-12 * answer.value);
    CHECK(dear.evaluated >= static_cast<int>(answer.plan.value.size()));
    CHECK(dear.evaluated < 600);
  }
}

TEST_CASE("plan and duals prove each other, of any shape, weights and marginal weight") {
  std::mt19937 random(1);
  const int repeats = std::getenv("BOWSTRING_TEST_SHORT") != nullptr ? 20 : 200;
  double largest = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const std::size_t rows = 1 + random() % 40, columns = 1 + random() % 40;
    const std::vector<double> a = random_numbers(random, rows, 0.0, 2.0), b = random_numbers(random, columns, 0.0, 5.0);
    const std::vector<double> cost = random_costs(random, rows * columns);
    const double rho = std::pow(10.0, -3.0 + 6.0 * uniform(random));
    CAPTURE(repeat);
    CAPTURE(rho);
    const double whole = rho * (dot(a, std::vector<double>(rows, 1.0)) + dot(b, std::vector<double>(columns, 1.0)));

    TransportComparison smooth = unbalanced("kl", rho);
    const TransportAnswer kl = compare(smooth, a, b, cost);
    CHECK(largest_violation(kl, cost) <= 1e-15 * (rho + 1.0) * 8.0);
    CHECK(std::fabs(kl.value - penalised(a, kl.dual_a, rho) - penalised(b, kl.dual_b, rho)) <= 1e-13 * whole);
    CHECK(kl.gap >= -1e-15 * whole);
    CHECK(kl.gap <= 1e-14 * whole);
    CHECK(kl.certified);
    CHECK(kl.certificate.gap == kl.gap);
    largest = std::max(largest, kl.gap / whole);

    TransportComparison linear = unbalanced("total-variation", rho);
    const TransportAnswer tv = compare(linear, a, b, cost);
    CHECK(largest_violation(tv, cost) <= 1e-14 * (rho + 3.0));
    for (const std::vector<double>* duals : {&tv.dual_a, &tv.dual_b}) {
      for (const double dual : *duals) CHECK(dual <= rho * (1.0 + 1e-14) + 1e-14);
    }
    CHECK(std::fabs(tv.value - dot(a, tv.dual_a) - dot(b, tv.dual_b)) <= 1e-13 * whole);
    CHECK(std::fabs(tv.gap) <= 1e-13 * whole);
    CHECK(tv.plan.value.size() <= rows + columns);
  }
  MESSAGE("largest gap of KL, relative to rho and the masses: " << largest);
}

TEST_CASE("a plan without ties is thin: a forest") {
  std::mt19937 random(2);
  for (const double rho : {0.01, 0.3, 1e3}) {
    const Measure a = random_cloud(random, 40), b = random_cloud(random, 30);
    TransportComparison transport = unbalanced("kl", rho);
    CHECK(compare(transport, a, b).answer.plan.value.size() <= 69);
  }
}

TEST_CASE("turned around, the value is the same and the duals change sides") {
  std::mt19937 random(3);
  const Measure a = random_cloud(random, 13), b = random_cloud(random, 21);
  for (const double epsilon : {0.0, 0.1}) {
    TransportComparison transport = unbalanced("kl", 0.4, epsilon);
    const TransportAnswer there = compare(transport, a, b).answer, back = compare(transport, b, a).answer;
    CHECK(there.value == doctest::Approx(back.value).epsilon(1e-13));
    for (std::size_t i = 0; i < a.count(); ++i) {
      CHECK(there.weight_gradient_a[i] == doctest::Approx(back.weight_gradient_b[i]).epsilon(1e-10));
    }
  }
}

TEST_CASE("costs and marginal weight in another unit: the value in that unit") {
  std::mt19937 random(4);
  const std::vector<double> a = random_numbers(random, 8, 0.0, 1.0), b = random_numbers(random, 5, 0.0, 1.0);
  const std::vector<double> cost = random_numbers(random, 40, 0.0, 1.0);
  std::vector<double> other = cost;
  for (double& entry : other) entry *= 1e8;
  for (const char* penalty : {"kl", "total-variation"}) {
    TransportComparison one = unbalanced(penalty, 0.3), large = unbalanced(penalty, 0.3e8);
    CHECK(compare(large, a, b, other).value == doctest::Approx(1e8 * compare(one, a, b, cost).value).epsilon(1e-13));
  }
}

TEST_CASE("the same input gives the same bits; a kept tree saves pivots and changes nothing") {
  std::mt19937 random(5);
  const Measure a = random_cloud(random, 60), b = random_cloud(random, 50);
  Measure moved = a;
  for (double& x : moved.position) x += 1e-3 * uniform(random);
  for (const double epsilon : {0.0, 0.05}) {
    TransportComparison transport = unbalanced("kl", 0.2, epsilon);
    const TransportAnswer first = compare(transport, a, b).answer, again = compare(transport, a, b).answer;
    CHECK(first.value == again.value);
    CHECK(first.plan.value == again.plan.value);
  }
  TransportComparison warm = unbalanced("total-variation", 0.1), cold = unbalanced("total-variation", 0.1);
  compare(warm, a, b);
  const TransportAnswer after = compare(warm, moved, b).answer, anew = compare(cold, moved, b).answer;
  CHECK(after.warm);
  CHECK_FALSE(anew.warm);
  CHECK(5 * after.iterations < anew.iterations);
  CHECK(after.value == doctest::Approx(anew.value).epsilon(1e-14));
  CHECK(after.uniqueness_known);
  warm.forget();
  CHECK(compare(warm, moved, b).answer.iterations == anew.iterations);
}
