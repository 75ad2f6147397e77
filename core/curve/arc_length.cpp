#include "core/curve/arc_length.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/curve/gauss_legendre.hpp"

namespace bowstring {

namespace {

/// Index i of the interval [x_i, x_{i+1}] of the increasing x that holds `where`, the end intervals beyond.
std::size_t interval_of(const std::vector<double>& x, double where) {
  const auto above = std::upper_bound(x.begin(), x.end(), where);
  const auto index = above - x.begin() - 1;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(x.size()) - 2));
}

}  // namespace

std::vector<double> polyline_arc(const std::vector<double>& points, int dimension) {
  const std::size_t d = static_cast<std::size_t>(dimension);
  std::vector<double> arc(points.size() / d, 0.0);
  for (std::size_t i = 1; i < arc.size(); ++i) {
    double square = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      const double step = points[i * d + k] - points[(i - 1) * d + k];
      square += step * step;
    }
    arc[i] = arc[i - 1] + std::sqrt(square);
  }
  return arc;
}

std::vector<double> even_stations(double length, int count) {
  std::vector<double> station(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) station[static_cast<std::size_t>(i)] = length * i / (count - 1);
  station.back() = length;
  return station;
}

double interpolate_linearly(const std::vector<double>& abscissa, const std::vector<double>& value, double where) {
  if (abscissa.size() < 2 || where <= abscissa.front()) return value.front();
  if (where >= abscissa.back()) return value.back();
  const std::size_t i = interval_of(abscissa, where);
  const double t = (where - abscissa[i]) / (abscissa[i + 1] - abscissa[i]);
  return (1.0 - t) * value[i] + t * value[i + 1];
}

std::size_t nearest_index(const std::vector<double>& abscissa, double where) {
  if (abscissa.size() < 2) return 0;
  const std::size_t i = interval_of(abscissa, where);
  return where - abscissa[i] <= abscissa[i + 1] - where ? i : i + 1;
}

ArcLength::ArcLength(Speed speed, const std::vector<double>& breaks) : speed_(std::move(speed)) {
  constexpr double relative_tolerance = 1e-13;
  constexpr int deepest = 40;
  std::vector<double> coarse;
  double total = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    coarse.push_back(panel(breaks[i], breaks[i + 1]));
    total += coarse.back();
  }
  parameter_.push_back(breaks.front());
  arc_.push_back(0.0);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    refine(breaks[i], breaks[i + 1], coarse[i], relative_tolerance * total, deepest);
  }
}

double ArcLength::panel(double begin, double end) const { return gauss_legendre(speed_, begin, end); }

void ArcLength::refine(double begin, double end, double coarse, double tolerance, int depth) {
  const double middle = 0.5 * (begin + end);
  const double first = panel(begin, middle);
  const double second = panel(middle, end);
  if (depth == 0 || std::abs(first + second - coarse) <= tolerance) {
    parameter_.push_back(middle);
    arc_.push_back(arc_.back() + first);
    parameter_.push_back(end);
    arc_.push_back(arc_.back() + second);
    return;
  }
  refine(begin, middle, first, tolerance, depth - 1);
  refine(middle, end, second, tolerance, depth - 1);
}

double ArcLength::at(double parameter) const {
  const std::size_t i = interval_of(parameter_, parameter);
  return arc_[i] + panel(parameter_[i], parameter);
}

double ArcLength::parameter_at(double arc) const {
  if (arc <= 0.0) return parameter_.front();
  if (arc >= total()) return parameter_.back();
  constexpr int most_iterations = 60;
  const std::size_t i = interval_of(arc_, arc);
  double low = parameter_[i];
  double high = parameter_[i + 1];
  double t = low + (high - low) * (arc - arc_[i]) / (arc_[i + 1] - arc_[i]);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double excess = arc_[i] + panel(parameter_[i], t) - arc;
    if (std::abs(excess) <= 1e-15 * total()) break;
    (excess > 0.0 ? high : low) = t;
    double next = t - excess / speed_(t);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == t) break;
    t = next;
  }
  return t;
}

std::vector<double> ArcLength::even_parameters(int count) const {
  std::vector<double> parameter = even_stations(total(), count);
  for (double& value : parameter) value = parameter_at(value);
  return parameter;
}

}  // namespace bowstring
