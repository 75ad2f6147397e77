#include "losses/transport/unbalanced/total_variation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "losses/transport/network-simplex/exact_answer.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring::unbalanced {
namespace {

/// The weights and the mass that stands against what the other side gives up.
std::vector<double> extended_weights(Span<const double> own, Span<const double> other) {
  std::vector<double> out(own.begin(), own.end());
  out.push_back(std::accumulate(other.begin(), other.end(), 0.0));
  return out;
}

double take_last(std::vector<double>& values) {
  const double last = values.back();
  values.pop_back();
  return last;
}

/// Weights less what the plan has of them.
std::vector<double> left_over(Span<const double> weight, const std::vector<int>& place,
                              const std::vector<double>& mass) {
  std::vector<double> out(weight.begin(), weight.end());
  for (std::size_t k = 0; k < mass.size(); ++k) out[static_cast<std::size_t>(place[k])] -= mass[k];
  return out;
}

}  // namespace

void TotalVariation::extend(const TransportProblem& problem, double weight) {
  rows_ = problem.weight_a.size();
  columns_ = problem.weight_b.size();
  weight_a_ = extended_weights(problem.weight_a, problem.weight_b);
  weight_b_ = extended_weights(problem.weight_b, problem.weight_a);
  extended_.assign((rows_ + 1) * (columns_ + 1), weight);
  for (std::size_t i = 0; i < rows_; ++i) {
    const double* row = costs_.data() + i * columns_;
    const double* negative = std::find_if(row, row + columns_, [](double cost) { return cost < 0.0; });
    if (negative != row + columns_) {
      throw StatusError(Code::invalid_input,
                        "the cost of row " + std::to_string(i) + ", column " + std::to_string(negative - row) +
                            " is negative; with penalty = \"total-variation\" expected costs >= 0; add a constant to "
                            "all of them, or choose penalty = \"kl\"");
    }
    std::copy(row, row + columns_, &extended_[i * (columns_ + 1)]);
  }
  extended_.back() = 0.0;
}

/// Puts costs in the place of bounds on the plan's arcs; how many of them were bounds.
std::size_t TotalVariation::evaluate(const std::vector<simplex::Arc>& plan) {
  std::vector<simplex::Arc> own;
  for (const simplex::Arc& arc : plan) {
    if (static_cast<std::size_t>(arc.row) < rows_ && static_cast<std::size_t>(arc.column) < columns_) {
      own.push_back(arc);
    }
  }
  const std::size_t changed = costs_.evaluate(own);
  for (const simplex::Arc& arc : own) {
    const auto i = static_cast<std::size_t>(arc.row), j = static_cast<std::size_t>(arc.column);
    extended_[i * (columns_ + 1) + j] = costs_.data()[i * columns_ + j];
  }
  return changed;
}

void TotalVariation::solve(const TransportProblem& problem, double weight, TransportAnswer& out) {
  costs_.load_bounds(*problem.between);
  extend(problem, weight);
  simplex_.set_masses(simplex::masses_of(weight_a_, weight_b_));
  TransportAnswer whole;
  whole.warm = simplex_.has_tree();
  std::vector<simplex::Arc> plan;
  do {
    if (!simplex_.solve(extended_.data())) {
      throw StatusError(Code::failed, "the simplex method found no plan where there is always one");
    }
    whole.iterations += simplex_.pivots();
    plan = simplex_.plan();
  } while (evaluate(plan) > 0);
  TransportProblem extended;
  extended.weight_a = weight_a_;
  extended.weight_b = weight_b_;
  simplex::write_answer(extended, extended_.data(), simplex_.masses(),
                        {std::move(plan), simplex_.row_potential(), simplex_.column_potential(), simplex_.barrier()},
                        whole);

  out = std::move(whole);
  SparseEntries own;
  out.transport_cost = 0.0;
  double moved = 0.0;
  for (std::size_t k = 0; k < out.plan.value.size(); ++k) {
    const auto i = static_cast<std::size_t>(out.plan.row[k]), j = static_cast<std::size_t>(out.plan.column[k]);
    if (i == rows_ || j == columns_) continue;
    own.row.push_back(out.plan.row[k]);
    own.column.push_back(out.plan.column[k]);
    own.value.push_back(out.plan.value[k]);
    out.transport_cost += out.plan.value[k] * extended_[i * (columns_ + 1) + j];
    moved += out.plan.value[k];
  }
  out.plan = std::move(own);
  // The other side's last place has all the mass of this one: a weight that grows makes that one grow with it.
  const double of_last_row = take_last(out.dual_a), of_last_column = take_last(out.dual_b);
  for (double& dual : out.dual_a) dual += of_last_column;
  for (double& dual : out.dual_b) dual += of_last_row;
  out.weight_gradient_a = out.dual_a;
  out.weight_gradient_b = out.dual_b;
  const std::vector<double> left_a = left_over(problem.weight_a, out.plan.row, out.plan.value);
  const std::vector<double> left_b = left_over(problem.weight_b, out.plan.column, out.plan.value);
  out.figures = {{"mass", moved},
                 {"penalty_a", weight * std::accumulate(left_a.begin(), left_a.end(), 0.0)},
                 {"penalty_b", weight * std::accumulate(left_b.begin(), left_b.end(), 0.0)}};
  out.memory_bytes = simplex_.memory_bytes() + costs_.memory_bytes() + extended_.capacity() * sizeof(double);
}

}  // namespace bowstring::unbalanced
