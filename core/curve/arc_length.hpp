#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bowstring {

/// Arc length at each node of a polyline, mm: 0 at the first one. `points`: nodes × dimension.
std::vector<double> polyline_arc(const std::vector<double>& points, int dimension);

/// `count` ≥ 2 numbers that divide [0, length] evenly; the last one is exactly `length`.
std::vector<double> even_stations(double length, int count);

/// Linear interpolation of `value`, given at the increasing `abscissa`, at `where`; constant beyond the ends.
double interpolate_linearly(const std::vector<double>& abscissa, const std::vector<double>& value, double where);

/// Index of the entry of the increasing `abscissa` that is nearest to `where`.
std::size_t nearest_index(const std::vector<double>& abscissa, double where);

/// Arc length along a smooth parametrised curve, and its inverse.
///
/// Panels are halved until ten-point Gauss–Legendre rules agree with their halves to 1e-13 of the total; the
/// inverse is Newton's iteration within a panel, bisecting where a step would leave it.
class ArcLength {
 public:
  using Speed = std::function<double(double)>;

  /// `speed(t)` = |dp/dt| > 0. `breaks`, increasing: the parameters between which it is smooth, ends
  /// included.
  ArcLength(Speed speed, const std::vector<double>& breaks);

  double total() const noexcept { return arc_.back(); }
  /// Arc length from the first end, for a parameter between the ends.
  double at(double parameter) const;
  /// The parameter at which the arc length from the first end is `arc`; the ends' for what lies beyond them.
  double parameter_at(double arc) const;
  /// The parameters of `count` points evenly spaced in arc length, both ends included.
  std::vector<double> even_parameters(int count) const;

 private:
  double panel(double begin, double end) const;
  void refine(double begin, double end, double coarse, double tolerance, int depth);

  Speed speed_;
  std::vector<double> parameter_, arc_;
};

}  // namespace bowstring
