#include "core/procedure/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int most_iterations = 12;
constexpr int refinements = 3;
constexpr double rate_step = 1e-5;            // share: of the differences for d/dt
constexpr double stiffness = 1.0;             // N/mm: ρ of the active set
constexpr double enough_stationarity = 1e-9;  // N
constexpr double enough_rows = 1e-11;         // mm
constexpr double good_stationarity = 1e-7;    // N: where Newton's method gets no further
constexpr double good_rows = 1e-9;            // mm
constexpr double closing_tolerance = 1e-9;    // of the arclength
constexpr double least_cosine = 0.7;          // between the directions at both ends of a step
constexpr double length_share = 0.05;         // of the longest curve: the unit of motion

}  // namespace

Status PathFollower::place(double share, std::vector<double>& q) {
  const int built = family_.built();
  const bool same = family_.share() == share;
  Refusal refusal;
  Session* session = family_.at(share, refusal);
  if (session == nullptr) return Status::failure(Code::invalid_input, refusal.text());
  if (q.size() != at(session->scene->coordinates)) {
    return Status::failure(Code::unsupported, "the value changes what is unknown");
  }
  if (built != family_.built()) hold_ends(*session->scene, q);
  if (!same || built != family_.built() || !session->assembly) {
    try {
      bind_anew(*session, q);
      system_ = {};  // what it has analysed belongs to the assembly that is gone
    } catch (const std::exception& error) {
      return Status::failure(Code::failed, error.what());
    }
  }
  session->assembly->set_guard(std::numeric_limits<double>::infinity());
  measure_nodes();
  return {};
}

void PathFollower::measure_nodes() {
  const Session* session = &family_.session();
  if (measured_ == session && !nodes_.empty()) return;
  measured_ = session;
  nodes_.clear();
  int count = 0;
  for (const FieldEntry& entry : assembly().entries()) {
    if (entry.manifold != Manifold::vector) continue;
    ++count;
    for (int k = 0; k < entry.dimension; ++k) {
      const int unknown = assembly().free_of_unknown()[at(entry.unknown + k)];
      if (unknown >= 0) nodes_.push_back({unknown, entry.coordinate + k});
    }
  }
  double longest = 1.0;
  for (const auto& curve : session->scene->curves) longest = std::max(longest, curve->arc.back());
  weight_ = 1.0 / (std::max(count, 1) * std::pow(length_share * longest, 2));
}

double PathFollower::along(const std::vector<double>& motion, const std::vector<double>& other) const {
  double sum = 0.0;
  for (const Node& node : nodes_) sum += motion[at(node.unknown)] * other[at(node.unknown)];
  return weight_ * sum;
}

double PathFollower::along_displacement(const std::vector<double>& motion, const std::vector<double>& from,
                                        const std::vector<double>& to) const {
  double sum = 0.0;
  for (const Node& node : nodes_) {
    sum += motion[at(node.unknown)] * (to[at(node.coordinate)] - from[at(node.coordinate)]);
  }
  return weight_ * sum;
}

double PathFollower::distance(const std::vector<double>& a, const std::vector<double>& b) const {
  double sum = 0.0;
  for (const Node& node : nodes_) sum += std::pow(a[at(node.coordinate)] - b[at(node.coordinate)], 2);
  return std::sqrt(weight_ * sum);
}

Status PathFollower::evaluate(const PathState& state) {
  Assembly& problem = assembly();
  gradient_.resize(at(problem.unknowns()));
  rows_.resize(at(problem.rows()));
  jacobian_.resize(at(problem.jacobian_pattern().entries()));
  ProblemEvaluation wanted;
  wanted.gradient = gradient_;
  wanted.rows = rows_;
  wanted.jacobian = jacobian_;
  return problem.evaluate(state.q, wanted);
}

void PathFollower::choose_active(PathState& state) {
  const Assembly& problem = assembly();
  held_.assign(at(problem.rows()), 0);
  for (int r = 0; r < problem.rows(); ++r) {
    const double lower = problem.row_lower()[at(r)], upper = problem.row_upper()[at(r)];
    if (lower == upper) continue;
    double& multiplier = state.multipliers[at(r)];
    const bool above = std::isfinite(upper) && multiplier + stiffness * (rows_[at(r)] - upper) > 0.0;
    const bool below = std::isfinite(lower) && multiplier + stiffness * (rows_[at(r)] - lower) < 0.0;
    held_[at(r)] = above || below ? 1 : 0;
    if (held_[at(r)] == 0) multiplier = 0.0;
  }
}

void PathFollower::lagrangian_gradient(const std::vector<double>& multipliers, std::vector<double>& out) const {
  const SparsityPattern pattern = assembly().jacobian_pattern();
  out = gradient_;
  for (std::size_t r = 0; r < multipliers.size(); ++r) {
    if (multipliers[r] == 0.0) continue;
    for (int k = pattern.begin[r]; k < pattern.begin[r + 1]; ++k) {
      out[at(pattern.inner[at(k)])] += multipliers[r] * jacobian_[at(k)];
    }
  }
}

Status PathFollower::factor(const PathState& state) {
  Assembly& problem = assembly();
  hessian_.resize(at(problem.hessian_pattern().entries()));
  if (Status status = problem.lagrangian_hessian(state.q, 1.0, state.multipliers, hessian_); !status.ok())
    return status;
  softness_.assign(at(problem.rows()), std::numeric_limits<double>::infinity());
  system_.analyse(problem, jacobian_, held_);
  return {};
}

Status PathFollower::rates(const PathState& state) {
  const std::size_t n = gradient_.size(), m = rows_.size();
  gradient_rate_.assign(n, 0.0);
  row_rate_.assign(m, 0.0);
  std::vector<double> lagrangian;
  double span = 0.0;
  for (const double side : {1.0, -1.0}) {
    PathState near = state;
    near.share = state.share + side * rate_step;
    Status status = place(near.share, near.q);
    if (status.ok()) status = evaluate(near);
    if (!status.ok()) {
      // At the end of what the value may be: the difference to the point itself.
      near = state;
      status = place(near.share, near.q);
      if (status.ok()) status = evaluate(near);
      if (!status.ok()) return status;
    } else {
      span += rate_step;
    }
    if (gradient_.size() != n || rows_.size() != m) {
      return Status::failure(Code::unsupported, "the value changes what is unknown");
    }
    lagrangian_gradient(state.multipliers, lagrangian);
    for (std::size_t u = 0; u < n; ++u) gradient_rate_[u] += side * lagrangian[u];
    for (std::size_t r = 0; r < m; ++r) row_rate_[r] += side * rows_[r];
  }
  if (span == 0.0) return Status::failure(Code::failed, "the composition refuses every value beside this one");
  for (double& rate : gradient_rate_) rate /= span;
  for (double& rate : row_rate_) rate /= span;
  PathState back = state;
  Status status = place(state.share, back.q);
  return status.ok() ? evaluate(state) : status;
}

Status PathFollower::correct(PathState& state, const Closing& closing) {
  std::vector<double> right, row_right, delta, lambda, delta_rate, lambda_rate, moved;
  bool have_rates = false;
  double best = std::numeric_limits<double>::infinity();
  std::vector<char> held_before;
  for (int k = 0; k <= most_iterations; ++k) {
    state.iterations = k;
    if (Status status = evaluate(state); !status.ok()) return status;
    const Assembly& problem = assembly();
    const std::size_t n = gradient_.size(), m = rows_.size();
    state.multipliers.resize(m, 0.0);
    choose_active(state);
    lagrangian_gradient(state.multipliers, right);
    row_right.assign(m, 0.0);
    double stationarity = 0.0, violation = 0.0;
    for (std::size_t u = 0; u < n; ++u) {
      right[u] = -right[u];
      stationarity = std::max(stationarity, std::fabs(right[u]) / problem.stationarity_scale()[u]);
    }
    for (std::size_t r = 0; r < m; ++r) {
      const double lower = problem.row_lower()[r], upper = problem.row_upper()[r];
      if (lower != upper && held_[r] == 0) continue;
      const double bound = lower == upper || state.multipliers[r] > 0.0 || !std::isfinite(lower) ? upper : lower;
      row_right[r] = bound - rows_[r];
      violation = std::max(violation, std::fabs(row_right[r]));
    }
    double gap = 0.0;
    if (closing.from != nullptr) {
      gap = closing.step - along_displacement(closing.from->motion, closing.from->q, state.q) -
            closing.from->share_rate * (state.share - closing.from->share);
    }
    if (!std::isfinite(stationarity + violation + gap)) return Status::failure(Code::failed, "a number is not finite");
    const bool same_set = held_ == held_before;
    const double floor = std::max(enough_stationarity, 2.0 * problem.rounding_floor());
    const bool closed = std::fabs(gap) <= closing_tolerance;
    if (same_set && closed && stationarity <= floor && violation <= enough_rows) return {};
    const double merit = stationarity / floor + violation / enough_rows;
    const bool good = stationarity <= std::max(good_stationarity, floor) && violation <= good_rows;
    if (k > 2 && same_set && closed && good && merit > 0.5 * best) return {};
    if (k == most_iterations || (k > 4 && merit > 1e3 * best)) break;
    best = std::min(best, merit);
    held_before = held_;

    if (closing.from != nullptr && !have_rates) {
      if (Status status = rates(state); !status.ok()) return status;
      have_rates = true;
    }
    if (Status status = factor(state); !status.ok()) return status;
    if (!system_.factor({hessian_, jacobian_, softness_, 0.0}).exists) {
      return Status::failure(Code::failed, "the system is singular");
    }
    delta.assign(n, 0.0);
    lambda.assign(m, 0.0);
    system_.solve(right, row_right, {}, refinements, delta, lambda);
    double step = 0.0;
    if (closing.from != nullptr) {
      std::vector<double> a(n), b(m);
      for (std::size_t u = 0; u < n; ++u) a[u] = -gradient_rate_[u];
      for (std::size_t r = 0; r < m; ++r) b[r] = -row_rate_[r];
      delta_rate.assign(n, 0.0);
      lambda_rate.assign(m, 0.0);
      system_.solve(a, b, {}, refinements, delta_rate, lambda_rate);
      const double slope = along(closing.from->motion, delta_rate) + closing.from->share_rate;
      if (slope == 0.0) return Status::failure(Code::failed, "the path's direction is lost");
      step = (gap - along(closing.from->motion, delta)) / slope;
      for (std::size_t u = 0; u < n; ++u) delta[u] += step * delta_rate[u];
      for (std::size_t r = 0; r < m; ++r) lambda[r] += step * lambda_rate[r];
    }
    moved.resize(state.q.size());
    assembly().retract(state.q, delta, moved);  // not `problem`: rates may have bound rows anew
    state.q.swap(moved);
    for (std::size_t r = 0; r < m; ++r) state.multipliers[r] += lambda[r];
    state.share += step;
    if (step != 0.0) {
      if (Status status = place(state.share, state.q); !status.ok()) return status;
    }
  }
  return Status::failure(Code::failed, "Newton's method does not converge");
}

Status PathFollower::find_direction(PathState& state, const PathState* before) {
  if (Status status = evaluate(state); !status.ok()) return status;
  choose_active(state);
  if (Status status = rates(state); !status.ok()) return status;
  if (Status status = factor(state); !status.ok()) return status;
  const kkt::KktSystem::Outcome outcome = system_.factor({hessian_, jacobian_, softness_, 0.0});
  if (!outcome.exists) return Status::failure(Code::failed, "the system is singular");
  state.negative_directions = outcome.saddle_directions;
  const std::size_t n = gradient_.size(), m = rows_.size();
  std::vector<double> a(n), b(m);
  for (std::size_t u = 0; u < n; ++u) a[u] = -gradient_rate_[u];
  for (std::size_t r = 0; r < m; ++r)
    b[r] = held_[r] != 0 || assembly().row_lower()[r] == assembly().row_upper()[r] ? -row_rate_[r] : 0.0;
  state.motion.assign(n, 0.0);
  state.multiplier_rate.assign(m, 0.0);
  system_.solve(a, b, {}, refinements, state.motion, state.multiplier_rate);
  double scale = 1.0 / std::sqrt(1.0 + along(state.motion, state.motion));
  if (!(scale > 0.0)) return Status::failure(Code::failed, "the path's direction is lost");
  if (before != nullptr && scale * (along(before->motion, state.motion) + before->share_rate) < 0.0) scale = -scale;
  for (double& rate : state.motion) rate *= scale;
  for (double& rate : state.multiplier_rate) rate *= scale;
  state.share_rate = scale;
  return {};
}

Status PathFollower::settle_without_direction(PathState& state) {
  Status status = place(state.share, state.q);
  return status.ok() ? correct(state, {}) : status;
}

Status PathFollower::settle(PathState& state, const PathState* before) {
  const Status status = settle_without_direction(state);
  return status.ok() ? find_direction(state, before) : status;
}

Status PathFollower::advance(const PathState& from, double step, PathState& out) {
  out = from;
  out.share = from.share + step * from.share_rate;
  std::vector<double> delta = from.motion;
  for (double& entry : delta) entry *= step;
  // The unknowns are those of the family's last session, which has them all in the same order.
  assembly().retract(from.q, delta, out.q);
  for (std::size_t r = 0; r < out.multipliers.size(); ++r) out.multipliers[r] += step * from.multiplier_rate[r];
  Status status = place(out.share, out.q);
  if (status.ok()) status = correct(out, {&from, step});
  if (status.ok()) status = find_direction(out, &from);
  if (!status.ok()) return status;
  const double cosine = along(from.motion, out.motion) + from.share_rate * out.share_rate;
  if (cosine < least_cosine) return Status::failure(Code::refused, "the path turns too much in one step");
  return {};
}

}  // namespace bowstring
