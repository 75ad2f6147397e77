#include "solvers/newton/point.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/newton/stopwatch.hpp"

namespace bowstring::newton {

namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

Point::Point(Problem& problem, SolverResult& count) : problem_(problem), count_(count) {
  q.resize(at(problem.coordinates()));
  gradient.resize(at(problem.unknowns()));
  rows.resize(at(problem.rows()));
  fit_patterns();
}

kkt::KktSystem& Point::system() {
  if (!analysed_) system_.analyse(problem_, jacobian);
  analysed_ = true;
  return system_;
}

void Point::fit_patterns() {
  analysed_ = false;
  jacobian.assign(at(problem_.jacobian_pattern().entries()), 0.0);
  hessian.assign(at(problem_.hessian_pattern().entries()), 0.0);
}

template <class Call>
Status Point::timed(Call&& call) {
  const Stopwatch watch(count_.evaluation_seconds);
  return call();
}

Status Point::expand() {
  ProblemEvaluation wanted;
  wanted.energy = &energy;
  wanted.gradient = gradient;
  wanted.rows = rows;
  wanted.jacobian = jacobian;
  ++count_.evaluations;
  return timed([&] { return problem_.evaluate(q, wanted); });
}

Status Point::try_out(Span<const double> at, double& trial_energy, std::vector<double>& trial_rows) {
  ProblemEvaluation wanted;
  wanted.beyond_window = true;
  wanted.energy = &trial_energy;
  wanted.rows = trial_rows;
  ++count_.evaluations;
  return timed([&] { return problem_.evaluate(at, wanted); });
}

Status Point::find_hessian(Span<const double> multipliers) {
  return timed([&] { return problem_.lagrangian_hessian(q, 1.0, multipliers, hessian); });
}

Status Point::accept(bool& new_epoch) {
  return timed([&]() -> Status {
    if (Status status = problem_.accept(q); !status.ok()) return status;
    new_epoch = problem_.epoch_due();
    if (!new_epoch) return {};
    if (Status status = problem_.new_epoch(); !status.ok()) return status;
    fit_patterns();
    return {};
  });
}

Status Point::arrive(bool* new_epoch) {
  bool begun = false;
  Status status = accept(begun);
  if (new_epoch != nullptr) *new_epoch = begun;
  return status.ok() ? expand() : status;
}

void Point::lagrangian_gradient(Span<const double> multipliers, std::vector<double>& out) const {
  out = gradient;
  const SparsityPattern pattern = problem_.jacobian_pattern();
  for (int r = 0; r < problem_.rows(); ++r) {
    const double multiplier = multipliers[at(r)];
    if (multiplier == 0.0) continue;
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      out[at(pattern.inner[at(k)])] += multiplier * jacobian[at(k)];
    }
  }
}

double Point::in_newtons(Span<const double> v) const noexcept {
  const Span<const double> scale = problem_.stationarity_scale();
  double largest = 0.0;
  for (std::size_t u = 0; u < v.size(); ++u) {
    const double value = std::fabs(v[u]) / scale[u];
    if (!(value <= largest)) largest = value;
  }
  return largest;
}

double Point::row_rate(int row, Span<const double> delta) const noexcept {
  const SparsityPattern pattern = problem_.jacobian_pattern();
  double sum = 0.0;
  for (int k = pattern.begin[at(row)]; k < pattern.begin[at(row) + 1]; ++k) {
    sum += jacobian[at(k)] * delta[at(pattern.inner[at(k)])];
  }
  return sum;
}

}  // namespace bowstring::newton
