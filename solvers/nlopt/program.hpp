#pragma once

#include <chrono>
#include <deque>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include <nlopt.hpp>

#include "core/interfaces/solver.hpp"
#include "solvers/nlopt/first_order.hpp"

namespace bowstring::nlopt_solver {

using Clock = std::chrono::steady_clock;

enum class Algorithm { slsqp, mma, ccsaq };

struct Settings {
  Algorithm algorithm = Algorithm::slsqp;
  double tolerance = 1e-8;
  int max_iterations = 0;
  int max_unknowns = 0;
  double time_limit = std::numeric_limits<double>::infinity();  ///< s
  double guard = 0.5;                                           ///< share of the clearance; infinity: none
};

/// Why a callback ended a run of NLopt.
enum class Stop { none, converged, epoch, refused, quiet, iterations, time, user, error };

/// A row as NLopt sees it: sign · (row − bound), which has to be 0 or at most 0.
struct Side {
  int row = 0;
  double sign = 1.0;
  double bound = 0.0;
};

/// What outlives the runs of one solve.
struct Progress {
  Clock::time_point begin;
  std::vector<double> best;  ///< coordinates, empty before the first iterate
  double best_energy = 0.0;
  FirstOrderError best_error;
  double least_error = std::numeric_limits<double>::infinity();  ///< of all iterates
  Status failure;                                                ///< first evaluation that broke down
};

/// One chart of one epoch as NLopt sees it, every unknown a length (mm). NLopt does not say which of its trials become
/// iterates: those of SLSQP follow from the order of its calls, and with the other algorithms every trial counts.
/// No callback lets an exception into NLopt's C code: the first one is kept, and thrown by `run`.
class Program {
 public:
  Program(Problem& problem, EuclideanProblem& chart, const Settings& settings, const SolverContext& context,
          SolverResult& result, Progress& progress);

  /// Runs NLopt from the chart's base and leaves the last iterate in the result. Throws what a callback threw, and
  /// StatusError where the base cannot be evaluated.
  nlopt::result run();

  Stop stop() const noexcept { return stop_; }
  const std::string& message() const noexcept { return message_; }  ///< NLopt's own, mostly empty
  bool left_window() const noexcept { return left_window_; }        ///< by some trial

 private:
  static double objective_callback(unsigned n, const double* x, double* gradient, void* self);
  static void equality_callback(unsigned m, double* values, unsigned n, const double* x, double* gradient, void* self);
  static void inequality_callback(unsigned m, double* values, unsigned n, const double* x, double* gradient,
                                  void* self);
  template <class Body>
  void guarded(Body&& body) noexcept;

  nlopt::opt make_optimizer();
  double objective(const double* scaled, bool with_gradient);
  double energy_without_rounding();
  void constraint(const std::vector<Side>& sides, double refused_value, double* values, double* gradient) const;
  bool is_last_trial(const double* scaled) const;
  bool evaluate(const double* scaled);
  Status evaluate_chart();
  void count_refusal(const Status& status);
  void accept(const Point& point);
  void record(const Point& point, const FirstOrderError& error);
  void watch_progress(const Point& point, const FirstOrderError& error);
  void keep_best(const Point& point, const FirstOrderError& error);
  void end(Stop reason) noexcept;
  double seconds() const;

  Problem& problem_;
  EuclideanProblem& chart_;
  const Settings& settings_;
  const SolverContext& context_;
  SolverResult& result_;
  Progress& progress_;
  const bool line_search_;     // SLSQP's
  std::vector<double> scale_;  // mm per unknown
  std::vector<Side> equalities_, inequalities_;

  nlopt::opt* optimizer_ = nullptr;
  std::exception_ptr exception_;
  std::string message_;
  Stop stop_ = Stop::none;
  int iterates_ = 0;

  std::vector<double> scaled_;  // unknowns of the last trial as NLopt wrote them
  Point trial_, candidate_;
  bool admissible_ = false;   // trial_ could be evaluated
  bool pending_ = false;      // candidate_ may turn out to be SLSQP's next iterate
  bool left_window_ = false;  // by some trial
  int refusals_ = 0;          // in a row

  std::vector<double> x_;   // of the last iterate
  double energy_ = 0.0;     // there
  double drift_ = 0.0;      // what has been taken off the energies that NLopt is told
  double full_step_ = 0.0;  // length of the line search's first trial step
  int quiet_ = 0;           // iterates in a row that changed the energy by no more than rounding
  double watched_error_ = std::numeric_limits<double>::infinity();  // when `quiet_` was last 0
  std::deque<std::vector<double>> references_;                      // coordinates of the last iterates, newest last
};

}  // namespace bowstring::nlopt_solver
