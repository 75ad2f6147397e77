#pragma once

#include <limits>
#include <string>
#include <vector>

namespace bowstring::study {

enum class Settling : int { converges, does_not_settle, exact, too_few };
const char* settling_name(Settling settling) noexcept;  ///< "converges", "does not settle", "exact", "too few"

/// How a quantity behaves as its mesh is refined.
struct Fit {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  Settling verdict = Settling::too_few;
  double order = unknown;                            ///< p of f∞ + C x^−p
  double order_low = unknown, order_high = unknown;  ///< its 95 % interval, from three points of the fit on
  double limit = unknown;                            ///< f∞, extrapolated; the finest value where that is refused
  double beside = unknown;  ///< |limit − reference|/|reference| where it settles elsewhere than at the reference
  std::string text;         ///< "order 1.98 ± 0.03"

  bool settles() const noexcept { return verdict == Settling::converges || verdict == Settling::exact; }
};

/// The values of one quantity along a refinement: those that there are, coarse to fine.
struct Sequence {
  std::vector<double> resolution;  ///< rising: a number of segments, or one over a mesh width
  std::vector<double> value;
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none
  int failures = 0;                                             ///< runs without a value
};

/// Judges a sequence by its own differences first: d_i = f(x_{i+1}) − f(x_i) = C (x_{i+1}^−p − x_i^−p), so that
/// ln |d_i| is ln |C p| and a known function of p. That gives p by least squares, and its interval by Student's t.
///
/// *exact*: all values are equal to 1e-9 of the largest, and equal the reference where there is one.
/// *too few*: fewer than three values.
/// *converges*: p > 0.5; the interval's lower end is above 0.25 or each difference falls with order above 0.5; and the
/// last three differences fall with order above 0.25. Otherwise it *does not settle*.
///
/// Left out are differences at the rounding level: those at the fine end within 1e-12 of the largest value; and where
/// all from some point on are below 1e-3 of the largest difference and 1e-5 of the largest value, those from the first
/// among them that turns back or falls with order below 0.5, and the one before it, as long as two remain. Left out as
/// not yet asymptotic are those coarser than the largest difference per e-fold of refinement, as long as three remain.
///
/// What settles is at the reference unless its limit is further from it than twice what is left to its own limit, and
/// than a tenth of `target_error`. Then the errors have an order too, ln |f − reference| over ln x, as far as they fall
/// and exceed ten times what the limit's own uncertainty leaves of its distance from the reference, where those are
/// three at least; a reference that is the finest value itself has x^−p of its own, which is taken off. Of the two
/// orders the one with the narrower interval is told.
Fit fit_convergence(const Sequence& sequence, double target_error);

}  // namespace bowstring::study
