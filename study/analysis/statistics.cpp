#include "study/analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/QR>
#include <boost/math/distributions/students_t.hpp>

namespace bowstring::study {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Centred and of length 1; empty where it does not vary beyond rounding.
Eigen::VectorXd standardised(const std::vector<double>& values, double& length) {
  const Eigen::Map<const Eigen::VectorXd> raw(values.data(), static_cast<Eigen::Index>(values.size()));
  Eigen::VectorXd centred = raw.array() - raw.mean();
  length = centred.norm();
  if (!(length > 1e-13 * raw.norm())) return {};
  return centred / length;
}

}  // namespace

double student_factor(int freedom) {
  if (freedom < 1) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return unknown;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  if (values.size() < 2) return unknown;
  const double centre = mean(values);
  double squares = 0.0;
  for (double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

MeanInterval mean_interval(const std::vector<double>& values) {
  const double centre = mean(values);
  if (values.size() < 2) return {centre, unknown, unknown};
  const double half = student_factor(static_cast<int>(values.size()) - 1) * deviation(values) /
                      std::sqrt(static_cast<double>(values.size()));
  return {centre, centre - half, centre + half};
}

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) ++last;
    for (std::size_t k = first; k <= last; ++k) out[order[k]] = 1.0 + 0.5 * static_cast<double>(first + last);
    first = last + 1;
  }
  return out;
}

Regression regress(const std::vector<std::vector<double>>& columns, const std::vector<double>& y) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  if (columns.empty() || y.size() < columns.size() + 2) return {};
  double size = 0.0;
  const Eigen::VectorXd target = standardised(y, size);
  if (target.size() == 0) return {};
  Eigen::MatrixXd matrix(target.size(), count);
  std::vector<double> length(columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Eigen::VectorXd column = standardised(columns[j], length[j]);
    if (column.size() == 0) return {};
    matrix.col(static_cast<Eigen::Index>(j)) = column;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(matrix);
  factors.setThreshold(1e-8);
  if (factors.rank() < count) return {};
  const Eigen::VectorXd solution = factors.solve(target);
  Regression out;
  out.r_squared = 1.0 - (target - matrix * solution).squaredNorm();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    out.coefficient.push_back(solution[static_cast<Eigen::Index>(j)] * size / length[j]);
  }
  return out;
}

}  // namespace bowstring::study
