#include "core/procedure/continuation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/procedure/path_follower.hpp"
#include "core/procedure/summary.hpp"
#include "core/result/carry.hpp"

namespace bowstring {
namespace {

constexpr double growth = 1.6;
constexpr int easy_iterations = 4;       // of a corrector: the next step may be longer
constexpr double farthest_share = 20.0;  // a path that has come so far does not turn back to its end
constexpr double jump = 2.0;  // of a step's predicted length: a solver that lands farther off has left the path
constexpr int most_halvings = 60;

class Walk {
 public:
  Walk(const CompositionRequest& request, std::unique_ptr<Session> session, const ParameterFamily::Build& build,
       const std::function<bool(const IterationRecord&)>& progress, Path& path)
      : table_(session->composition.continuation),
        path_(path),
        progress_(progress),
        family_(request, table_, build, std::move(session)),
        follower_(family_) {
    path_.value = table_.path;
    path_.unit = table_.range.unit;
    path_.list = table_.range.list;
  }

  SolvedState run() {
    Refusal refusal;
    Session* session = family_.at(0.0, refusal);
    if (session == nullptr) return refused(refusal);
    solution_ = solve(*session, progress_);
    share_ = 0.0;
    add_point(0.0, true);
    if (table_.fallback && solution_.certificate.verdict != Verdict::converged) begin_further_on();
    if (share_ == 1.0) {
      path_.reached = true;
    } else if (solution_.certificate.verdict != Verdict::converged) {
      stop("the solve at its first value ended '" + std::string(verdict_name(solution_.certificate.verdict)) +
           "': " + solution_.certificate.reason);
    } else if (follows()) {
      follow();
    } else {
      step_by_solver();
    }
    if (!path_.reached) mark_unfinished();
    return {family_.release(), std::move(solution_)};
  }

 private:
  bool follows() {
    return table_.arclength && !family_.range().whole && session().composition.enforcement.name == "kkt";
  }
  Session& session() { return family_.session(); }

  SolvedState refused(const Refusal& refusal) {
    stop("the composition refuses its first value: " + refusal.text());
    solution_.certificate.verdict = Verdict::failed;
    solution_.certificate.reason = path_.reason;
    return {family_.release(), std::move(solution_)};
  }

  void stop(const std::string& why) {
    if (path_.reason.empty()) path_.reason = why;
  }

  /// A fallback is after its last value alone: where its first one has no answer, it begins at the next that has one,
  /// if there is any.
  void begin_further_on() {
    std::string tried = table_.range.text(0.0);
    for (double share = table_.first_step; share_ == 0.0; share = std::min(share + table_.first_step, 1.0)) {
      const std::string text = table_.range.text(share);
      Refusal refusal;
      Session* session = text != tried && !interrupted() ? family_.at(share, refusal) : nullptr;
      if (session != nullptr) {
        Solution found = solve(*session, progress_);
        if (found.certificate.verdict == Verdict::converged) {
          share_ = share;
          solution_ = std::move(found);
          path_.points.clear();
          add_point(0.0, true);
        }
      }
      tried = text;
      if (share == 1.0 || !path_.reason.empty()) return;
    }
  }

  bool interrupted() {
    if (!progress_) return false;
    IterationRecord record;
    record.iteration = static_cast<int>(path_.points.size());
    const PathPoint& last = path_.points.back();
    record.energy = total_energy(last.state);
    record.stationarity = last.state.certificate.stationarity;
    record.penetration = last.state.certificate.penetration;
    record.step = last.share;
    if (progress_(record)) return false;
    stop("it was stopped");
    return true;
  }

  void add_point(double arclength, bool by_solver) {
    PathPoint point;
    point.share = share_;
    point.parameter = table_.range.at(share_);
    point.arclength = arclength;
    point.iterations = solution_.solver.iterations;
    point.by_solver = by_solver;
    point.state = summarise(session(), solution_);
    // Of a point the document has figures alone.
    point.state.readings.curves.clear();
    point.state.readings.contacts.clear();
    point.state.readings.supports.clear();
    path_.points.push_back(std::move(point));
  }

  /// Certifies a point of the path, and keeps it as the solution so far.
  void keep(PathState& state, double arclength, bool by_solver) {
    if (Status status = follower_.place(state.share, state.q); !status.ok()) return stop(status.text);
    SolverResult found;
    found.claim = Claim::optimal;
    found.reason = "found along the path of equilibria";
    found.q = state.q;
    found.multipliers = state.multipliers;
    found.iterations = state.iterations;
    std::vector<std::string> warnings = std::move(solution_.warnings);
    solution_ = certified(session(), std::move(found));
    solution_.warnings = std::move(warnings);
    share_ = state.share;
    add_point(arclength, by_solver);
  }

  void follow() {
    PathState state;
    state.share = share_;
    state.q = solution_.q;
    state.multipliers = solution_.multipliers;
    if (Status status = follower_.settle(state); !status.ok()) return step_by_solver();
    double arclength = 0.0;
    double step = table_.first_step / std::fabs(state.share_rate);
    while (static_cast<long>(path_.points.size()) < table_.most_points) {
      if (interrupted()) return;
      step = std::min(step, table_.largest_step / std::max(std::fabs(state.share_rate), 1e-3));
      PathState next;
      bool by_solver = false;
      if (!take_step(state, step, next, by_solver)) return;
      const bool arrives = state.share < 1.0 && next.share >= 1.0;
      if (!by_solver) look_for_critical_points(state, next, step);
      if (arrives) return arrive(state, next);
      arclength += step;
      keep(next, arclength, by_solver);
      if (!path_.reason.empty()) return;
      if (std::fabs(next.share) > farthest_share) return stop("the path leads away from both of its ends");
      const bool easy = next.iterations <= easy_iterations && !by_solver;
      state = std::move(next);
      if (easy) step *= growth;
    }
    stop("it has " + std::to_string(path_.points.size()) + " points, and max-points allows no more");
  }

  /// The next state, by shorter steps where need be; `step` is the one that was taken.
  bool take_step(const PathState& state, double& step, PathState& next, bool& by_solver) {
    for (int k = 0; k < most_halvings; ++k) {
      const Status status = follower_.advance(state, step, next);
      if (status.ok()) return true;
      if (solver_step(state, step, next)) {
        by_solver = true;
        return true;
      }
      step *= 0.5;
      if (step < table_.smallest_step) {
        stop("no equilibrium was found beyond " + table_.range.text(state.share) + ": " + status.text +
             " with the smallest step");
        return false;
      }
    }
    return false;
  }

  /// The composition's solver at the family's value, from a state of another value.
  Solution solve_from(const PathState& state) {
    Start start;
    start.q = state.q;
    hold_ends(*session().scene, start.q);
    start.multipliers = state.multipliers;
    start.only = true;
    return solve(session(), progress_, &start);
  }

  /// The composition's solver from the predicted point, where the path is stable and rises. It may not land far off.
  bool solver_step(const PathState& state, double step, PathState& next) {
    if (state.negative_directions > 0 || state.share_rate <= 0.0) return false;
    PathState guess = state;
    guess.share = std::min(state.share + step * state.share_rate, 1.0);
    if (!follower_.place(guess.share, guess.q).ok()) return false;
    std::vector<double> delta = state.motion;
    if (static_cast<int>(delta.size()) != session().assembly->unknowns()) return false;
    for (double& entry : delta) entry *= step;
    session().assembly->retract(state.q, delta, guess.q);
    const Solution found = solve_from(guess);
    if (found.certificate.verdict != Verdict::converged) return false;
    if (follower_.distance(found.q, guess.q) > jump * follower_.distance(guess.q, state.q) + table_.smallest_step) {
      return false;
    }
    next.share = guess.share;
    next.q = found.q;
    next.multipliers = found.multipliers;
    return follower_.settle(next, &state).ok();
  }

  /// At the last value exactly, by the composition's solver.
  void arrive(const PathState& before, const PathState& beyond) {
    const double part = (1.0 - before.share) / (beyond.share - before.share);
    PathState last = part > 0.5 ? beyond : before;  // from the nearer of the two
    last.share = 1.0;
    const double gone = part * follower_.distance(before.q, beyond.q);
    const Status settled = follower_.settle(last, &before);
    Refusal refusal;
    if (family_.at(1.0, refusal) == nullptr) {
      return stop("the composition refuses its last value: " + refusal.text());
    }
    Solution found = solve_from(last);
    const bool stays = follower_.distance(found.q, last.q) <= 1e-6 + jump * gone;
    if (found.certificate.verdict == Verdict::converged && (stays || !settled.ok())) {
      share_ = 1.0;
      solution_ = std::move(found);
      add_point(path_.points.back().arclength + gone, true);
      path_.reached = true;
    } else if (settled.ok()) {
      keep(last, path_.points.back().arclength + gone, false);
      path_.reached = path_.reason.empty();
    } else {
      stop("at its last value the solve ended '" + std::string(verdict_name(found.certificate.verdict)) +
           "': " + found.certificate.reason);
    }
  }

  void look_for_critical_points(const PathState& before, const PathState& after, double step) {
    const bool folds = before.share_rate * after.share_rate < 0.0;
    if (!folds && before.negative_directions == after.negative_directions) return;
    // Halving: the mark is the side that a state is on.
    const auto beyond = [&](const PathState& state) {
      return folds ? state.share_rate * before.share_rate < 0.0
                   : state.negative_directions != before.negative_directions;
    };
    double low = 0.0, high = step;
    PathState at_low = before, at_high = after;
    for (int k = 0; k < most_halvings; ++k) {
      const double reach = folds ? std::max(std::fabs(at_low.share_rate), std::fabs(at_high.share_rate)) * (high - low)
                                 : std::fabs(at_high.share - at_low.share);
      if (reach <= table_.tolerance) break;
      double middle = 0.5 * (low + high);
      if (folds && k % 3 != 2) {  // the rate is nearly linear there
        middle = low + (high - low) * at_low.share_rate / (at_low.share_rate - at_high.share_rate);
        middle = std::clamp(middle, low + 0.01 * (high - low), high - 0.01 * (high - low));
      }
      PathState between;
      if (!follower_.advance(before, middle, between).ok()) break;
      if (beyond(between)) {
        high = middle;
        at_high = std::move(between);
      } else {
        low = middle;
        at_low = std::move(between);
      }
    }
    CriticalPoint found;
    found.kind = folds ? CriticalPoint::Kind::fold : CriticalPoint::Kind::bifurcation;
    const PathState& nearest = std::fabs(at_low.share_rate) < std::fabs(at_high.share_rate) ? at_low : at_high;
    PathState there = nearest;
    found.share = folds ? nearest.share : 0.5 * (at_low.share + at_high.share);
    found.uncertainty = folds ? std::max(std::fabs(at_low.share_rate), std::fabs(at_high.share_rate)) * (high - low)
                              : 0.5 * std::fabs(at_high.share - at_low.share);
    found.parameter = table_.range.at(found.share);
    found.index_before = before.negative_directions;
    found.index_after = after.negative_directions;
    if (follower_.place(there.share, there.q).ok()) {
      double energy = 0.0;
      ProblemEvaluation wanted;
      wanted.energy = &energy;
      if (session().assembly->evaluate(there.q, wanted).ok()) found.energy = energy;
    }
    path_.critical.push_back(std::move(found));
  }

  /// From value to value by the composition's solver alone.
  void step_by_solver() {
    double step = table_.first_step;
    while (share_ < 1.0) {
      if (static_cast<long>(path_.points.size()) >= table_.most_points) {
        return stop("it has " + std::to_string(path_.points.size()) + " points, and max-points allows no more");
      }
      if (interrupted()) return;
      double target = std::min(share_ + step, 1.0);
      while (target < 1.0 && table_.range.text(target) == table_.range.text(share_)) {
        target = std::min(target + step, 1.0);
      }
      if (solve_at(target)) {
        step = std::min(growth * step, table_.largest_step);
        continue;
      }
      step = 0.5 * std::min(step, target - share_);
      if (step >= table_.smallest_step && table_.range.text(share_ + step) != table_.range.text(share_)) continue;
      if (table_.fallback && family_.range().whole && answers_from_the_start()) break;
      return stop("no equilibrium was found beyond " + table_.range.text(share_) +
                  " with the smallest step: " + failure_);
    }
    path_.reached = true;
  }

  /// Another mesh or other rows may have an answer from the start where the point before does not lead to one.
  bool answers_from_the_start() {
    Refusal refusal;
    Session* session = family_.at(1.0, refusal);
    if (session == nullptr) return false;
    Solution found = solve(*session, progress_);
    if (found.certificate.verdict != Verdict::converged) return false;
    solution_ = std::move(found);
    share_ = 1.0;
    add_point(share_, true);
    return true;
  }

  bool solve_at(double target) {
    Refusal refusal;
    // After a step that failed the session is still at the value of that step, with other rows or nodes than the
    // point's.
    if (family_.share() != share_) {
      if (const Status status = follower_.place(share_, solution_.q); !status.ok()) {
        failure_ = status.text;
        return false;
      }
    }
    Readings readings;
    read_solution(session(), solution_, readings);
    const CarriedState carried = carry(session(), solution_, readings, "the point before");
    Session* session = family_.at(target, refusal);
    if (session == nullptr) {
      failure_ = refusal.text();
      return false;
    }
    std::vector<DocumentFlaw> flaws;
    Start start = start_from(*session->scene, session->assembly->row_origins(), carried, flaws);
    if (start.q.empty()) {
      failure_ = flaws.empty() ? "the point before does not carry over" : flaws.front().found;
      return false;
    }
    start.only = true;
    start.warnings.clear();
    Solution found = solve(*session, progress_, &start);
    if (found.certificate.verdict != Verdict::converged) {
      failure_ = found.certificate.reason;
      return false;
    }
    solution_ = std::move(found);
    share_ = target;
    add_point(share_, true);
    return true;
  }

  /// What the walk came to stands for the result: the session goes back there.
  void mark_unfinished() {
    follower_.place(share_, solution_.q);
    Certificate& certificate = solution_.certificate;
    const std::string reached = table_.range.text(share_);
    if (certificate.verdict == Verdict::converged) certificate.verdict = Verdict::stalled;
    certificate.reason = "the walk of '" + table_.path + "' ended at " + reached + " on its way to " +
                         table_.range.text(1.0) + ": " + path_.reason;
  }

  const ContinuationTable table_;
  Path& path_;
  const std::function<bool(const IterationRecord&)>& progress_;
  ParameterFamily family_;
  PathFollower follower_;
  Solution solution_;
  double share_ = 0.0;
  std::string failure_;
};

}  // namespace

const char* critical_name(CriticalPoint::Kind kind) noexcept {
  return kind == CriticalPoint::Kind::fold ? "fold" : "bifurcation";
}

SolvedState walk(const CompositionRequest& request, std::unique_ptr<Session> session,
                 const ParameterFamily::Build& build, const std::function<bool(const IterationRecord&)>& progress,
                 Path& path) {
  return Walk(request, std::move(session), build, progress, path).run();
}

}  // namespace bowstring
