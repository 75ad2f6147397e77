#pragma once

#include <string>
#include <vector>

#include "solvers/newton/barrier_method.hpp"
#include "solvers/newton/diagnosis.hpp"
#include "solvers/newton/filter.hpp"
#include "solvers/newton/point.hpp"
#include "solvers/newton/progress.hpp"
#include "solvers/newton/sides.hpp"
#include "solvers/trust-region/metric.hpp"
#include "solvers/trust-region/normal_step.hpp"
#include "solvers/trust-region/subproblem.hpp"

namespace bowstring::trust_region {

struct Settings {
  double first_radius = 0.0;  ///< mm, in the metric's norm; 0: a share of the scene's length
  bool leave_saddles = true;
};

/// Trust-region SQP with a filter on a problem of equality rows: R. Fletcher, N. I. M. Gould, S. Leyffer, P. L. Toint
/// and A. Wächter, SIAM J. Optim. 13 (2002) 635, with steps composed as in R. H. Byrd and E. O. Omojokun's method
/// (Nocedal and Wright, Numerical Optimization, 18.5) and subproblems solved as Moré and Sorensen do. README.md says
/// what differs.
class Method {
 public:
  Method(newton::Point& point, newton::Progress& progress, const Settings& settings);

  /// From point.q. `multipliers`: m, or empty; at the end those of the last point.
  newton::Ending run(std::vector<double>& multipliers);

 private:
  struct Step {
    std::vector<double> delta;  // n
    double norm = 0.0;
    double share = 1.0;        // of the whole step to the linearised rows
    double bound_share = 1.0;  // what bounds on unknowns leave of it
    double decrease = 0.0;     // of the quadratic model of the Lagrangian
    double fraction = 1.0;     // of Newton's step, 0 where there is none
    bool restoring = false;    // the region does not reach the linearised rows: towards them, and nothing else
    bool newton = false;       // Newton's own step, whole
  };
  struct Trial {
    std::vector<double> q, rows;
    double energy = 0.0, violation = 0.0;
  };
  enum class Verdict { accepted, shorten, rounding };

  Status begin(std::vector<double>& multipliers);
  void pull_inside_bounds();
  /// Multipliers of the point, and its errors with them.
  void judge();
  double violation(const std::vector<double>& rows) const noexcept;  // Σ, mm
  double largest_violation() const noexcept;
  double energy_of_rows() const noexcept;  // Σ|λ c|, N mm
  bool errors_within_targets() const noexcept;
  double worst_error() const noexcept;

  bool compose(Step& step);
  void keep_bounds(Step& step);
  Verdict try_step(Step& step);
  /// A second-order correction: back to the rows that the step was to reach, with the step's own factors.
  void correct(const Step& step);
  bool within_bounds(const std::vector<double>& q) const;
  bool acceptable(const Step& step);
  /// Where rounding decides energies: Newton's steps that make the errors smaller.
  bool improves_errors();
  Status take();

  double least_curvature() const noexcept;
  newton::Ending at_stationary_point(bool& go_on);
  newton::Ending without_step() const;
  newton::Ending infeasible(const char* why) const;

  newton::Point& point_;
  newton::Progress& progress_;
  Settings settings_;
  Problem& problem_;
  Metric metric_;
  NormalStep normal_;
  Subproblem subproblem_;
  newton::Filter filter_;
  std::vector<newton::Side> bounds_;
  newton::Growth growth_;
  double radius_ = 1.0, start_energy_ = 0.0;
  double target_ = 0.0;  // N
  double stationarity_ = 0.0, violation_ = 0.0;
  bool leaving_saddle_ = false;
  bool trials_refused_ = false;  // every one since the last step
  std::string trial_failure_;    // of the last one
  int holding_unknown_ = 0;
  double held_by_bound_ = 1.0;  // the last step's share
  std::vector<double> multipliers_, newton_multipliers_, residual_, normal_delta_, tangential_, right_, unknown_value_;
  std::vector<double> wanted_rows_, back_, back_multipliers_;
  Trial trial_, corrected_;
};

}  // namespace bowstring::trust_region
