#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/transport/check_measure.hpp"
#include "problems.hpp"

using namespace exact_test;

namespace {

/// Costs of which a share between `least` and 1 is known beforehand.
class DearCosts final : public PairCosts {
 public:
  DearCosts(std::mt19937& random, std::vector<double> cost, int columns, double least)
      : cost_(std::move(cost)), columns_(columns) {
    for (const double value : cost_) bound_.push_back(value * (least + (1.0 - least) * uniform(random)));
  }

  int row_count() const noexcept override { return static_cast<int>(cost_.size()) / columns_; }
  int column_count() const noexcept override { return columns_; }
  bool dear() const noexcept override { return true; }
  const double* matrix() const noexcept override { return nullptr; }

  Status rows(int begin, int end, Span<double> value) noexcept override {
    evaluated_ += (end - begin) * columns_;
    std::copy(cost_.begin() + begin * columns_, cost_.begin() + end * columns_, value.begin());
    return {};
  }
  Status lower_bounds(int begin, int end, Span<double> value) noexcept override {
    std::copy(bound_.begin() + begin * columns_, bound_.begin() + end * columns_, value.begin());
    return {};
  }
  Status evaluate(Span<const int> pairs, Span<double> value) noexcept override {
    if (breaks_) return Status::failure(Code::failed, "the geodesic was not found");
    for (std::size_t k = 0; k < value.size(); ++k) {
      value[k] = cost_[static_cast<std::size_t>(pairs[2 * k] * columns_ + pairs[2 * k + 1])];
    }
    evaluated_ += static_cast<int>(value.size());
    return {};
  }
  int evaluated() const { return evaluated_; }
  void break_down() { breaks_ = true; }

 private:
  std::vector<double> cost_, bound_;
  int columns_, evaluated_ = 0;
  bool breaks_ = false;
};

TransportAnswer solve(Transport& method, const MatrixProblem& problem, PairCosts& costs) {
  TransportProblem dear;
  dear.weight_a = problem.a;
  dear.weight_b = problem.b;
  dear.between = &costs;
  TransportAnswer out;
  const Status status = method.solve(dear, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

}  // namespace

TEST_CASE("dear costs are evaluated where plans use them, and give what the whole matrix gives") {
  std::mt19937 random(14);
  for (const std::string& name : exact_methods()) {
    for (const double least : {0.0, 0.5, 0.9, 1.0}) {
      for (const bool curves : {false, true}) {
        CAPTURE(name);
        CAPTURE(least);
        CAPTURE(curves);
        const int rows = 45, columns = curves ? 45 : 38;
        const MatrixProblem problem{
            curves ? uniform_weights(45) : random_weights(random, rows),
            curves ? uniform_weights(45) : random_weights(random, columns),
            squared_distances(curves ? random_curve(random, rows) : random_cloud(random, rows),
                              curves ? random_curve(random, columns) : random_cloud(random, columns))};
        const Owned<Transport> method = open_method(name);
        DearCosts costs(random, problem.cost, columns, least);
        const TransportAnswer answer = solve(*method, problem, costs), whole = solve_cold(name, problem);
        CHECK(answer.value == doctest::Approx(whole.value).epsilon(1e-10));
        check_proof(problem, answer);
        if (name == "exact") {
          MESSAGE("bounds from " << least << ", curves " << curves << ": evaluated "
                                 << 100.0 * costs.evaluated() / (rows * columns) << " %, pivots " << answer.iterations);
          CHECK(costs.evaluated() <= (least >= 0.9 ? 0.25 : least >= 0.5 ? 0.5 : 0.9) * rows * columns);
        }
        DearCosts again(random, problem.cost, columns, least);
        CHECK(solve(*method, problem, again).value == doctest::Approx(whole.value).epsilon(1e-10));
      }
    }
  }
}

TEST_CASE("a cost that cannot be evaluated is told, and nothing is kept") {
  std::mt19937 random(15);
  const MatrixProblem problem{uniform_weights(6), uniform_weights(6),
                              squared_distances(random_cloud(random, 6), random_cloud(random, 6))};
  const Owned<Transport> method = open_method("exact");
  DearCosts costs(random, problem.cost, 6, 0.5);
  costs.break_down();
  TransportProblem dear;
  dear.weight_a = problem.a;
  dear.weight_b = problem.b;
  dear.between = &costs;
  TransportAnswer out;
  const Status status = method->solve(dear, out);
  CHECK(status.code == Code::failed);
  CHECK(status.text == "the geodesic was not found");
  DearCosts whole(random, problem.cost, 6, 0.5);
  CHECK_FALSE(solve(*method, problem, whole).warm);
}
