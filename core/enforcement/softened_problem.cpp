#include "core/enforcement/softened_problem.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Rounding of a row in units of the extent's: a difference of positions, once squared.
constexpr double row_roundings = 1.0;

}  // namespace

/// A chart of a softened problem: the same sums, on the chart of the problem itself.
class SoftenedChart final : public EuclideanProblem {
 public:
  SoftenedChart(SoftenedProblem& problem, std::unique_ptr<EuclideanProblem> chart)
      : problem_(problem), chart_(std::move(chart)) {}

  void start(Span<double> x) const noexcept override { chart_->start(x); }
  void state(Span<const double> x, Span<double> q) const noexcept override { chart_->state(x, q); }
  Status evaluate(Span<const double> x, const ProblemEvaluation& evaluation) noexcept override {
    return problem_.evaluate(*chart_, x, evaluation);
  }
  Status lagrangian_hessian(Span<const double> x, double energy_factor, Span<const double> multipliers,
                            Span<double> values) noexcept override {
    return problem_.lagrangian_hessian(*chart_, x, energy_factor, multipliers, values);
  }
  bool recentre_due(Span<const double> x) const noexcept override { return chart_->recentre_due(x); }

 private:
  SoftenedProblem& problem_;
  std::unique_ptr<EuclideanProblem> chart_;
};

SoftenedProblem::SoftenedProblem(Problem& problem, std::vector<char> soft, const RowLaw& law)
    : problem_(problem), law_(law), summary_(problem.summary()) {
  soft.resize(at(problem.rows()), 0);
  kept_number_.assign(soft.size(), -1);
  for (int r = 0; r < problem.rows(); ++r) {
    if (soft[at(r)] != 0) {
      soft_rows_.push_back(r);
    } else {
      kept_number_[at(r)] = static_cast<int>(kept_.size());
      kept_.push_back(r);
    }
  }
  summary_.equalities = summary_.inequalities = 0;
  for (RowGroup& group : summary_.row_groups) {
    const auto begin = std::lower_bound(kept_.begin(), kept_.end(), group.first);
    const auto end = std::lower_bound(begin, kept_.end(), group.first + group.count);
    group.first = static_cast<int>(begin - kept_.begin());
    group.count = static_cast<int>(end - begin);
    group.inequalities = static_cast<int>(
        std::count_if(begin, end, [&](int r) { return problem.row_lower()[at(r)] < problem.row_upper()[at(r)]; }));
  }
  for (const int r : kept_) {
    (problem.row_lower()[at(r)] < problem.row_upper()[at(r)] ? summary_.inequalities : summary_.equalities) += 1;
  }
  summary_.row_groups.erase(std::remove_if(summary_.row_groups.begin(), summary_.row_groups.end(),
                                           [](const RowGroup& group) { return group.count == 0; }),
                            summary_.row_groups.end());
  own_.rows.assign(soft.size(), 0.0);
  own_.weights.assign(soft.size(), 0.0);
  fit_patterns();
}

void SoftenedProblem::fit_patterns() {
  row_lower_.clear();
  row_upper_.clear();
  begin_.assign(1, 0);
  inner_.clear();
  const SparsityPattern pattern = problem_.jacobian_pattern();
  for (const int r : kept_) {
    row_lower_.push_back(problem_.row_lower()[at(r)]);
    row_upper_.push_back(problem_.row_upper()[at(r)]);
    inner_.insert(inner_.end(), pattern.inner.begin() + pattern.begin[at(r)],
                  pattern.inner.begin() + pattern.begin[at(r) + 1]);
    begin_.push_back(static_cast<int>(inner_.size()));
  }
  const Span<const int> order = problem_.order();
  const std::size_t inner = order.size() - at(problem_.border());
  order_.clear();
  border_ = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int row = order[k] - unknowns();
    if (row >= 0 && kept_number_[at(row)] < 0) continue;
    order_.push_back(row < 0 ? order[k] : unknowns() + kept_number_[at(row)]);
    if (k >= inner) ++border_;
  }
  local_rows_.clear();
  for (LocalRows place : problem_.local_rows()) {
    place.first_row = kept_number_[at(place.first_row)];
    local_rows_.push_back(place);
  }
  own_.jacobian.assign(at(pattern.entries()), 0.0);
}

Status SoftenedProblem::fit() noexcept {
  try {
    fit_patterns();
  } catch (const std::exception& error) {
    return Status::failure(Code::failed, error.what());
  }
  return {};
}

template <class Inner>
Status SoftenedProblem::evaluate(Inner& inner, Span<const double> point, const ProblemEvaluation& evaluation) noexcept {
  const bool counts = evaluation.energy != nullptr || !evaluation.gradient.empty();
  ProblemEvaluation wanted;
  wanted.beyond_window = evaluation.beyond_window;
  wanted.energy = evaluation.energy;
  wanted.gradient = evaluation.gradient;
  if (counts || !evaluation.rows.empty()) wanted.rows = own_.rows;
  if (!evaluation.gradient.empty() || !evaluation.jacobian.empty()) wanted.jacobian = own_.jacobian;
  if (Status status = inner.evaluate(point, wanted); !status.ok()) return status;

  const SparsityPattern pattern = problem_.jacobian_pattern();
  if (!evaluation.rows.empty()) gather(own_.rows, evaluation.rows);
  if (!evaluation.jacobian.empty()) {
    double* out = evaluation.jacobian.data();
    for (const int r : kept_) {
      out = std::copy(own_.jacobian.begin() + pattern.begin[at(r)], own_.jacobian.begin() + pattern.begin[at(r) + 1],
                      out);
    }
  }
  if (!counts) return {};
  for (const int r : soft_rows_) {
    const RowEnergy cost = law_.at(r, own_.rows[at(r)]);
    if (evaluation.energy != nullptr) *evaluation.energy += cost.energy;
    if (evaluation.gradient.empty() || cost.force == 0.0) continue;
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      evaluation.gradient[at(pattern.inner[at(k)])] += cost.force * own_.jacobian[at(k)];
    }
  }
  return {};
}

template <class Inner>
Status SoftenedProblem::lagrangian_hessian(Inner& inner, Span<const double> point, double energy_factor,
                                           Span<const double> multipliers, Span<double> values) noexcept {
  ProblemEvaluation wanted;
  wanted.rows = own_.rows;
  wanted.jacobian = own_.jacobian;
  if (Status status = inner.evaluate(point, wanted); !status.ok()) return status;
  spread(multipliers, own_.weights);
  for (const int r : soft_rows_) own_.weights[at(r)] = energy_factor * law_.at(r, own_.rows[at(r)]).force;
  Status status = inner.lagrangian_hessian(point, energy_factor, own_.weights, values);
  if (!status.ok()) return status;
  for (const int r : soft_rows_) {
    const double stiffness = energy_factor * law_.at(r, own_.rows[at(r)]).stiffness;
    if (stiffness == 0.0 || add_outer(r, stiffness, values)) continue;
    return Status::failure(Code::failed, "the Hessian's pattern lacks a pair of unknowns that row " +
                                             std::to_string(r) + " reads, so that its energy finds no place there");
  }
  return {};
}

bool SoftenedProblem::add_outer(int row, double stiffness, Span<double> values) const noexcept {
  const SparsityPattern rows = problem_.jacobian_pattern(), hessian = problem_.hessian_pattern();
  const int end = rows.begin[at(row) + 1];
  for (int k = rows.begin[at(row)]; k < end; ++k) {
    const double factor = stiffness * own_.jacobian[at(k)];
    if (factor == 0.0) continue;
    const int column = rows.inner[at(k)];
    const int* const last = hessian.inner.data() + hessian.begin[at(column) + 1];
    const int* place = hessian.inner.data() + hessian.begin[at(column)];
    for (int l = k; l < end; ++l) {
      const double entry = own_.jacobian[at(l)];
      if (entry == 0.0) continue;
      // Unknowns of one row mostly follow each other, in the column too.
      const int unknown = rows.inner[at(l)];
      if (place != last && *place != unknown) place = std::lower_bound(place, last, unknown);
      if (place == last || *place != unknown) return false;
      values[static_cast<std::size_t>(place - hessian.inner.data())] += factor * entry;
      ++place;
    }
  }
  return true;
}

Status SoftenedProblem::evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept {
  return evaluate(problem_, q, evaluation);
}

Status SoftenedProblem::lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                                           Span<double> values) noexcept {
  return lagrangian_hessian(problem_, q, energy_factor, multipliers, values);
}

Status SoftenedProblem::accept(Span<const double> q) noexcept {
  extent_ = 0.0;
  for (const double number : q) extent_ = std::max(extent_, std::fabs(number));
  return problem_.accept(q);
}

double SoftenedProblem::row_rounding() const noexcept {
  return row_roundings * std::numeric_limits<double>::epsilon() * extent_;
}

double SoftenedProblem::rounding_floor() const noexcept {
  const double soft = soft_rows_.empty() ? 0.0 : law_.stiffest() * row_rounding();
  return std::max(problem_.rounding_floor(), soft);
}

Status SoftenedProblem::new_epoch() noexcept {
  Status status = problem_.new_epoch();
  return status.ok() ? fit() : status;
}

std::unique_ptr<EuclideanProblem> SoftenedProblem::chart(Span<const double> base) {
  return std::make_unique<SoftenedChart>(*this, problem_.chart(base));
}

void SoftenedProblem::spread(Span<const double> kept, Span<double> all) const noexcept {
  for (std::size_t k = 0; k < kept_.size(); ++k) all[at(kept_[k])] = kept[k];
}

void SoftenedProblem::gather(Span<const double> all, Span<double> kept) const noexcept {
  for (std::size_t k = 0; k < kept_.size(); ++k) kept[k] = all[at(kept_[k])];
}

}  // namespace bowstring
