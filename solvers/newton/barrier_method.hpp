#pragma once

#include <string>
#include <vector>

#include "solvers/newton/diagnosis.hpp"
#include "solvers/newton/filter.hpp"
#include "solvers/newton/inertia_correction.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"
#include "solvers/newton/sides.hpp"

namespace bowstring::newton {

struct BarrierSettings {
  double first_barrier = 0.1;   ///< N mm, μ of one row of a hundred
  double last_barrier = 1e-11;  ///< N mm, of any row: the energy that the barrier costs at the end
  /// Where the method is followed by another one: it may stop at this barrier with its subproblem solved. 0: not.
  double hand_over_barrier = 0.0;
  bool warm = false;  ///< the start and its multipliers are near a solution
};

/// Primal-dual interior-point method with a filter line search (A. Wächter and L. T. Biegler, Math. Program. 106 (2006)
/// 25; J. Nocedal and S. J. Wright, Numerical Optimization, chapter 19) for
///   min E(q)  subject to  c(q) = 0,  g(q) + s = 0, s ≥ 0,  and bounds on unknowns,
/// whose steps solve KktSystem with e = s/z. What differs for wires in vessels: μ of a row is in proportion to the
/// length of wire that it stands for, and a step may move no wire node further from its wall than the problem's guard
/// allows (`Problem::travelled`).
///
/// A trial that the filter refuses for its violation is brought back to the rows once (a second-order correction).
/// Where no step is found, or rows that fail come no closer, a Restoration brings them together, and the method goes on
/// from there; where that cannot be, its claim is the answer.
class BarrierMethod {
 public:
  BarrierMethod(Point& point, Progress& progress, const BarrierSettings& settings);

  /// From point.q, which is accepted. `multipliers`: m, to start from; at the end those of the last point.
  Ending run(std::vector<double>& multipliers);

 private:
  struct Direction {
    std::vector<double> delta, rows;   // n, m: dλ of every row
    std::vector<double> slack, force;  // of row sides: ds, dz
    std::vector<double> bound_force;   // of unknowns' sides
  };
  struct Step {
    double primal = 0.0, dual = 0.0;
  };
  struct Trial {
    std::vector<double> q, rows, slack;
    double energy = 0.0;
  };
  /// Largest errors of the first-order conditions at the current barrier parameter (0: of the problem itself).
  struct Errors {
    double stationarity = 0.0, violation = 0.0, complementarity = 0.0;
  };

  void set_up(Span<const double> start_multipliers);
  void fill_slacks(bool warm);
  void keep_inside();
  void read_bounds();
  double barrier_of_row() const noexcept { return barrier_ * row_share_; }
  double violation(const std::vector<double>& rows, const std::vector<double>& slack) const noexcept;
  double objective(double energy, const std::vector<double>& slack, Span<const double> bound_slack) const noexcept;
  void combine_multipliers();
  void fill_stationarity();
  Errors errors(double barrier) const noexcept;
  double penetration() const noexcept;
  bool lower_barrier();
  /// False: no shift gives usable factors, or the Hessian could not be evaluated, which `failure` says.
  bool find_direction(double least_shift, Status& failure);
  /// With the last factors and right_b_.
  double solve_system(Span<const double> right, int most_refinements, double enough, Span<double> delta,
                      Span<double> rows);
  Step longest_step() const noexcept;
  double slope() const noexcept;
  /// Finds an acceptable trial; its length or 0.
  double search(double longest);
  enum class Verdict { accepted, refused, no_trial };
  /// Tries point.q · Exp(step · delta) with slacks s + step · slack.
  Verdict try_step(const std::vector<double>& delta, const std::vector<double>& slack, double step);
  /// The trial of the whole step, with the error that it leaves in the rows solved for once more.
  bool correct(double step);
  bool take(double primal, double dual, Ending& ending);
  /// A point from which the method can go on; false: `ending` is its end.
  bool restore(const std::string& why, Ending& ending);

  Point& point_;
  Progress& progress_;
  BarrierSettings settings_;
  Problem& problem_;
  InertiaCorrection inertia_;
  Filter filter_;
  std::vector<Side> sides_, bounds_;
  std::vector<int> equalities_;
  double barrier_ = 1.0, row_share_ = 1.0;
  double largest_start_violation_ = 0.0;
  Growth growth_;
  int restorations_ = 0;
  std::vector<double> slack_, force_;              // of row sides
  std::vector<double> bound_slack_, bound_force_;  // of unknowns' sides
  std::vector<double> multipliers_;                // m, all rows
  std::vector<double> stationarity_;               // n: ∇E + Jᵀλ − bounds' forces
  std::vector<double> softness_, right_a_, right_b_, unknown_value_;
  struct Base {  // of one line search
    double violation = 0.0, objective = 0.0, slope = 0.0;
  } base_;
  std::vector<double> scaled_, trial_bound_slack_, correction_rows_, corrected_delta_, corrected_slack_;
  bool neutral_ = false;       // the last line search was given up for a shift
  bool by_violation_ = false;  // the last trial was refused by a filter, and violates rows by more than the point
  Status trial_failure_;       // of the last trial, where it could not be evaluated
  Direction direction_;
  Trial trial_;
};

}  // namespace bowstring::newton
