#pragma once

#include <Eigen/Core>
#include <cmath>

namespace bowstring::unbalanced {

/// x log(x/y) − x + y ≥ 0 for x ≥ 0, y > 0, to full relative precision where x is near y too: there it is
/// quadratic.
inline double divergence(double x, double y) {
  const double t = (x - y) / y;
  if (std::fabs(t) < 1e-2) {
    double sum = 0.0, power = t * t;
    for (int k = 2; k <= 9; ++k, power *= -t) sum += power / (k * (k - 1));
    return y * sum;
  }
  return x > 0.0 ? x * (std::log(x) - std::log(y)) - x + y : y;
}

inline double divergence(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < x.size(); ++k) sum += divergence(x[k], y[k]);
  return sum;
}

}  // namespace bowstring::unbalanced
