#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <numeric>

#include "core/interfaces/transport.hpp"
#include "losses/transport/sinkhorn/entropic_problem.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::sinkhorn;

const ParameterDeclaration schema[] = {
    {"epsilon", ParameterType::scalar, "", nullptr, "regularization, in the unit of the ground cost (euclidean: mm^2)",
     0.0, 1e308, true},
    {"debiased", ParameterType::flag, "", "true",
     "value = OT(a,b) - OT(a,a)/2 - OT(b,b)/2, which is zero for equal measures; false: OT(a,b)"},
    {"tolerance", ParameterType::scalar, "", "1e-9", "largest error of the marginals, summed, of the whole mass", 0.0,
     1.0, true},
    {"max-iterations", ParameterType::integer, "", "100000", "of the last epsilon", 1, 1e9},
};

/// Entries of a plan below this share of the mean entry are left out: all of them together are less than rounding.
constexpr double smallest_entry = 1e-16;

Vector vector_of(Span<const double> numbers) {
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

std::vector<double> numbers_of(const Vector& vector) { return {vector.data(), vector.data() + vector.size()}; }

Matrix matrix_of(PairCosts& costs) {
  Matrix out(costs.row_count(), costs.column_count());
  const Status status = costs.rows(0, costs.row_count(), {out.data(), static_cast<std::size_t>(out.size())});
  if (!status.ok()) throw StatusError(status);
  return out;
}

SparseEntries entries_of(const Matrix& plan, double factor) {
  SparseEntries out;
  const double least = smallest_entry * plan.sum() / static_cast<double>(plan.size());
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) <= least) continue;
      out.row.push_back(static_cast<int>(i));
      out.column.push_back(static_cast<int>(j));
      out.value.push_back(factor * plan(i, j));
    }
  }
  return out;
}

class Sinkhorn final : public Transport {
 public:
  explicit Sinkhorn(const ParameterSet& parameters)
      : epsilon_(parameters.scalar("epsilon")), debiased_(parameters.flag("debiased")) {
    limits_.tolerance = parameters.scalar("tolerance");
    limits_.most_iterations = parameters.integer("max-iterations");
  }

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    return guard([&]() -> Status {
      out = {};
      if (debiased_ && (problem.within_a == nullptr || problem.within_b == nullptr)) {
        return Status::failure(
            Code::unsupported,
            "transport 'sinkhorn' takes off the costs within each measure, and was given a matrix of "
            "costs between them alone; expected two measures; give them, or set debiased = false");
      }
      compare(problem, out);
      return {};
    });
  }

  void forget() noexcept override {
    kept_f_.resize(0);
    kept_g_.resize(0);
  }

 private:
  void compare(const TransportProblem& problem, TransportAnswer& out) {
    const double mass = std::accumulate(problem.weight_a.begin(), problem.weight_a.end(), 0.0);
    Vector a = vector_of(problem.weight_a), b = vector_of(problem.weight_b);
    a /= a.sum();
    b /= b.sum();
    EntropicProblem between(matrix_of(*problem.between), a, b);
    out.warm = kept_f_.size() == a.size() && kept_g_.size() == b.size();
    if (out.warm) {
      between.f = kept_f_;
      between.g = kept_g_;
    }
    between.solve(epsilon_, limits_, out.warm);
    require_convergence(between);
    kept_f_ = between.f;
    kept_g_ = between.g;

    const Matrix raw = between.plan(), plan = rounded(raw, a, b);
    const double dual = between.dual_value(raw);
    out.plan = entries_of(plan, mass);
    out.transport_cost = mass * between.transport_cost(plan);
    out.value = mass * dual;
    out.gap = mass * (between.primal_value(plan) - dual);
    out.iterations = between.iterations;
    out.memory_bytes = between.memory_bytes();
    out.figures = {{"marginal_error", between.marginal_error}, {"regularized_value", out.value}};
    Vector by_a = between.f, by_b = between.g;
    if (debiased_) {
      take_off(*problem.within_a, a, mass, out.value, out.by_cost_within_a, by_a, out);
      take_off(*problem.within_b, b, mass, out.value, out.by_cost_within_b, by_b, out);
    }
    const double shift = 0.5 * (b.dot(between.g) - a.dot(between.f));
    out.dual_a = numbers_of(between.f.array() + shift);
    out.dual_b = numbers_of(between.g.array() - shift);
    const double weight_shift = 0.5 * (b.dot(by_b) - a.dot(by_a));
    out.weight_gradient_a = numbers_of(by_a.array() + weight_shift);
    out.weight_gradient_b = numbers_of(by_b.array() - weight_shift);
  }

  /// Half of the regularized cost of a measure to itself, off the value and its derivatives.
  void take_off(PairCosts& costs, const Vector& weight, double mass, double& value, SparseEntries& by_cost,
                Vector& by_weight, TransportAnswer& out) {
    EntropicProblem within(matrix_of(costs), weight, weight);
    within.solve_symmetric(epsilon_, limits_);
    require_convergence(within);
    const Matrix plan = within.plan();
    value -= 0.5 * mass * within.dual_value(plan);
    by_cost = entries_of(plan, -0.5 * mass);
    by_weight -= within.f;
    out.memory_bytes = std::max(out.memory_bytes, within.memory_bytes());
  }

  void require_convergence(const EntropicProblem& problem) const {
    if (problem.marginal_error <= limits_.tolerance) return;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "after %ld iterations the marginals are off by %.3g of the mass; expected %.3g; raise max-iterations, "
        "tolerance or epsilon",
        problem.iterations, problem.marginal_error, limits_.tolerance);
    throw StatusError(Code::failed, text);
  }

  double epsilon_;
  bool debiased_;
  Limits limits_;
  Vector kept_f_, kept_g_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, Sinkhorn>(
    bowstring::Kind::transport, "sinkhorn", "Transport with entropy: the debiased divergence, or its regularized value",
    schema))
