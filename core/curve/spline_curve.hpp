#pragma once

#include <vector>

#include "core/curve/arc_length.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// A curve whose coordinates are splines of one odd degree on common knots: between knots polynomials of that
/// degree, at the inner ones degree − 1 times continuously differentiable.
class SplineCurve {
 public:
  SplineCurve() = default;
  /// `knots`: not decreasing, the first and the last one degree + 1 times, the inner ones once.
  /// `control`: (knots − degree − 1) × dimension coefficients of the B-splines that sum to 1.
  SplineCurve(int dimension, int degree, std::vector<double> knots, std::vector<double> control);

  int dimension() const noexcept { return dimension_; }
  int degree() const noexcept { return degree_; }
  /// The distinct knots, ends included.
  std::vector<double> breaks() const;

  /// The derivative of order `order` (0: the point) at `parameter`, `dimension` numbers.
  void evaluate(double parameter, int order, double* out) const;
  double speed(double parameter) const;
  /// 1/mm, never negative.
  double curvature(double parameter) const;
  /// Unit vector along the curve.
  std::vector<double> tangent(double parameter) const;
  /// Refers to this spline, which has to outlive it.
  ArcLength arc_length() const;

 private:
  int dimension_ = 0;
  int degree_ = 0;
  std::vector<double> knots_, control_;
};

struct SplineFit {
  SplineCurve curve;
  double distance = 0.0;  ///< √(Σ|p_i − f(t_i)|²/n) that it leaves, mm
};

/// A parameter for each point of a polyline: chord length in units of its mean step, which keeps the matrices
/// of a fit well scaled. `points`: nodes × dimension.
std::vector<double> chord_parameters(const std::vector<double>& points, int dimension);

/// The spline f of degree 3 or 5 through `points` (nodes × dimension; at least degree + 1) at the increasing
/// `parameter`, or, for `distance` > 0, the smoothing spline that leaves √(Σ|p_i − f(t_i)|²/n) = `distance`
/// mm, by Dierckx's method.
///
/// Interpolation takes the points as knots without the (degree − 1)/2 next to each end, and so reproduces
/// polynomials of that degree. Smoothing takes few knots: beginning with none, it adds points as knots where
/// the squared residuals of the least-squares spline are largest, until that spline leaves less than
/// `distance`; on these knots it minimises the sum of squared jumps of the derivative of order `degree` among
/// the splines that leave `distance`. Where a single polynomial leaves less, it is the answer.
///
/// `invalid_input`: too few points; or rounding hides `distance`, because it is tiny or the points are spaced very
/// unevenly. Source: P. Dierckx, Curve and Surface Fitting with Splines (Oxford 1993), ch. 5; and Computer Graphics and
/// Image Processing 20 (1982) 171.
Status fit_spline(const std::vector<double>& parameter, const std::vector<double>& points, int dimension, int degree,
                  double distance, SplineFit& out);

}  // namespace bowstring
