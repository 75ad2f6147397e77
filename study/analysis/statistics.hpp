#pragma once

#include <vector>

namespace bowstring::study {

/// Half the width of a 95 % interval in standard errors, Student's t with `freedom` degrees of freedom; infinity for
/// none.
double student_factor(int freedom);

/// A mean and its 95 % interval; NaN where the values do not give it (a mean wants one value, an interval two).
struct MeanInterval {
  double mean, low, high;
};
MeanInterval mean_interval(const std::vector<double>& values);

double mean(const std::vector<double>& values);
/// With n − 1; NaN for fewer than two.
double deviation(const std::vector<double>& values);
/// Linear interpolation between order statistics, type 7 of Hyndman and Fan (Am. Stat. 50:361, 1996). `sorted` holds
/// at least one value.
double quantile(const std::vector<double>& sorted, double share);
/// 1 … n, the mean rank for equal values.
std::vector<double> ranks(const std::vector<double>& values);

/// y ≈ a + Σ b_j x_j by least squares.
struct Regression {
  std::vector<double> coefficient;  ///< b_j
  double r_squared = 0.0;           ///< share of the variance of y that the fit explains
};
/// `columns` are the x_j, each as long as y. No coefficients where y does not vary, a column does not, columns depend
/// on one another or there are no more values than unknowns.
Regression regress(const std::vector<std::vector<double>>& columns, const std::vector<double>& y);

}  // namespace bowstring::study
