#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/interfaces/transport.hpp"
#include "losses/transport/fused-gromov-wasserstein/conditional_gradient.hpp"
#include "losses/transport/fused-gromov-wasserstein/structure.hpp"
#include "losses/transport/network-simplex/dense_costs.hpp"
#include "losses/transport/network-simplex/network_simplex.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::gromov;

constexpr ParameterDeclaration schema[] = {
    {"structure-weight", ParameterType::scalar, "", "0.5",
     "alpha: 0 compares places alone, 1 distances within the measures alone (Gromov-Wasserstein)", 0.0, 1.0},
    {"structure", ParameterType::choice, "", "\"distance\"",
     "what is compared of two places of one measure: the root of their cost, so that its differences squared have the "
     "cost's unit, or the cost",
     -1e308, 1e308, false, false, "distance|squared-distance"},
    {"starts", ParameterType::integer, "", "1",
     "how many starts; the least value counts. The product of the weights, then the plan of the cost alone, then plans "
     "of random costs",
     1.0, 1e6},
    {"seed", ParameterType::integer, "", "1", "of the random costs", 0.0, 4294967295.0},
    {"tolerance", ParameterType::scalar, "", "1e-9",
     "the Frank-Wolfe gap at which a plan counts as stationary, relative to what plans cost", 0.0, 1.0, true},
    {"max-iterations", ParameterType::integer, "", "10000", "steps from each start", 1.0, 1e9},
};

Eigen::Map<const Vector> mapped(Span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

void append(SparseEntries& out, const Matrix& plan, double factor) {
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) <= 0.0) continue;
      out.row.push_back(static_cast<int>(i));
      out.column.push_back(static_cast<int>(j));
      out.value.push_back(factor * plan(i, j));
    }
  }
}

/// Of costs that the method itself may not have looked at.
double cost_of(PairCosts& between, const SparseEntries& plan) {
  std::vector<int> pairs;
  for (std::size_t k = 0; k < plan.value.size(); ++k) pairs.insert(pairs.end(), {plan.row[k], plan.column[k]});
  std::vector<double> cost(plan.value.size());
  if (const Status status = between.evaluate(pairs, cost); !status.ok()) throw StatusError(status);
  return std::inner_product(cost.begin(), cost.end(), plan.value.begin(), 0.0);
}

/// A stationary plan of transport that compares distances within the measures too. Each call starts cold; within it
/// the linear programs go on from each other.
class FusedGromovWasserstein final : public Transport {
 public:
  explicit FusedGromovWasserstein(const ParameterSet& parameters)
      : alpha_(parameters.scalar("structure-weight")),
        form_(parameters.text("structure") == "distance" ? StructureForm::distance : StructureForm::squared_distance),
        starts_(parameters.integer("starts")),
        seed_(static_cast<std::uint32_t>(parameters.integer("seed"))),
        settings_{parameters.scalar("tolerance"), parameters.integer("max-iterations")} {}

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    if (problem.within_a == nullptr || problem.within_b == nullptr) {
      return Status::failure(
          Code::unsupported,
          "'fused-gromov-wasserstein' compares distances within each measure, which a matrix of costs "
          "between them does not tell; expected measures; give their places and a ground cost");
    }
    return guard([&] { solve_or_throw(problem, out); });
  }

 private:
  void solve_or_throw(const TransportProblem& problem, TransportAnswer& out) const {
    const Problem own = read(problem);
    simplex::NetworkSimplex simplex;
    simplex.set_masses(simplex::masses_of(problem.weight_a, problem.weight_b));
    Stationary best;
    std::vector<double> values;
    long iterations = 0, pivots = 0;
    std::size_t memory_bytes = 0;
    std::mt19937 random(seed_);
    for (long k = 0; k < starts_; ++k) {
      Stationary found = descend(own, start(own, k, random, simplex), settings_, simplex);
      iterations += found.iterations;
      pivots += found.pivots;
      memory_bytes = std::max(memory_bytes, found.memory_bytes);
      values.push_back(found.value);
      if (k == 0 || found.value < best.value) best = std::move(found);
    }
    out = {};
    write(own, best, *problem.between, out);
    out.iterations = iterations;
    const double near = best.value + 1e-9 * scale_of(own);
    out.figures.insert(out.figures.end(),
                       {{"pivots", static_cast<double>(pivots)},
                        {"starts_with_this_value",
                         static_cast<double>(std::count_if(values.begin(), values.end(),
                                                           [near](double value) { return value <= near; }))}});
    out.memory_bytes = simplex.memory_bytes() + memory_bytes;
  }

  Problem read(const TransportProblem& problem) const {
    Problem out;
    out.a = mapped(problem.weight_a);
    out.b = mapped(problem.weight_b);
    out.alpha = alpha_;
    out.structure_a = structure_of(*problem.within_a, form_);
    out.structure_b = structure_of(*problem.within_b, form_);
    if (alpha_ == 1.0) return out;
    simplex::DenseCosts costs;
    costs.load(*problem.between);
    out.cost = Eigen::Map<const Matrix>(costs.data(), out.a.size(), out.b.size());
    return out;
  }

  static Matrix start(const Problem& problem, long number, std::mt19937& random, simplex::NetworkSimplex& simplex) {
    const Eigen::Index rows = problem.a.size(), columns = problem.b.size();
    if (number == 0) return problem.a.matrix() * problem.b.matrix().transpose() / problem.b.sum();
    Matrix cost = number == 1 && problem.alpha < 1.0
                      ? problem.cost
                      : Matrix::NullaryExpr(rows, columns, [&] { return static_cast<double>(random()) * 0x1p-32; });
    if (!simplex.solve(cost.data())) throw StatusError(Code::failed, "a start of the method has no plan");
    return vertex_of(simplex);
  }

  void write(const Problem& problem, const Stationary& found, PairCosts& between, TransportAnswer& out) const {
    out.value = found.value;
    append(out.plan, found.plan, 1.0);
    append(out.by_cost, found.plan, 1.0 - alpha_);
    out.transport_cost = cost_of(between, out.plan);
    write_duals(problem, found, out);
    long coincident = 0;
    if (alpha_ > 0.0) {
      const Matrix &a = problem.structure_a, &b = problem.structure_b, &plan = found.plan;
      const Eigen::VectorXd sum_a = plan.rowwise().sum(), sum_b = plan.colwise().sum().transpose();
      out.by_cost_within_a =
          by_cost_within(a, 2.0 * alpha_ * (a.cwiseProduct(sum_a * sum_a.transpose()) - plan * b * plan.transpose()),
                         form_, coincident);
      out.by_cost_within_b =
          by_cost_within(b, 2.0 * alpha_ * (b.cwiseProduct(sum_b * sum_b.transpose()) - plan.transpose() * a * plan),
                         form_, coincident);
    }
    out.gap = found.gap;
    out.figures = {
        {"structure_cost", alpha_ > 0.0 ? (found.value - (1.0 - alpha_) * out.transport_cost) / alpha_ : 0.0},
        {"frank_wolfe_gap", found.gap},
        {"coincident_pairs", static_cast<double>(coincident)}};
  }

  /// Potentials of ∇F at the plan are the derivatives by weights: what the value depends on beside the plan is none.
  static void write_duals(const Problem& problem, const Stationary& found, TransportAnswer& out) {
    out.dual_a = found.row;
    out.dual_b = found.column;
    double of_a = 0.0, of_b = 0.0;
    for (std::size_t i = 0; i < out.dual_a.size(); ++i) of_a += problem.a[static_cast<Eigen::Index>(i)] * out.dual_a[i];
    for (std::size_t j = 0; j < out.dual_b.size(); ++j) of_b += problem.b[static_cast<Eigen::Index>(j)] * out.dual_b[j];
    const double shift = 0.5 * (of_b - of_a) / problem.a.sum();
    for (double& dual : out.dual_a) dual += shift;
    for (double& dual : out.dual_b) dual -= shift;
    out.weight_gradient_a = out.dual_a;
    out.weight_gradient_b = out.dual_b;
  }

  double alpha_;
  StructureForm form_;
  long starts_;
  std::uint32_t seed_;
  Settings settings_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, FusedGromovWasserstein>(
    bowstring::Kind::transport, "fused-gromov-wasserstein",
    "Transport that compares places and the distances within each measure; a local minimum", schema))
