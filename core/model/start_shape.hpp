#pragma once

#include <vector>

#include "core/interfaces/curve.hpp"
#include "core/lie/so3.hpp"

namespace bowstring {

/// Points at the given shares of a curve's length, along the cubic spline through its nodes; the ends of the whole
/// curve are kept to the last bit. `points`: nodes × dimension; `share`: increasing, from 0 to 1.
struct Resampled {
  std::vector<double> points;
  std::vector<double> first_tangent, last_tangent;  ///< unit, `dimension` numbers
};
Resampled resample(const std::vector<double>& points, int dimension, const std::vector<double>& share);

/// Cumulative shares of `edges` edges with these fractions; even ones where there are none. From 0 to exactly 1.
std::vector<double> cumulative_shares(const std::vector<double>& fraction, int edges);

/// The end's own axes: the tangent first, the others by the least turn from the axes of space. In the plane the tangent
/// and its left normal.
Matrix3 end_axes(const double (&tangent)[3], int dimension);

/// How far along the movable part of a curve: 0 up to where the first end holds it, 1 from where the last one does,
/// linear in State 1 arc length between. A held edge belongs to its end as a whole.
class Ramp {
 public:
  Ramp(const CurveView& view, const std::vector<double>& arc);
  double at(double arc) const noexcept;

 private:
  double begin_, end_;
};

/// A prescribed rotation in global axes, whole turns counted.
struct Turn {
  Vector3 rotation;    ///< rotation vector; in the plane its third component
  double twist = 0.0;  ///< in space, about the tangent wherever along the curve
};

/// The curve whose edges are turned in proportion to their distance from the other end, put together again from the
/// first node, or from the last one where that alone is held. Where both are held the edges are turned a little more,
/// smoothly, so that the curve closes (in the plane; whole turns are kept so), or the gap is spread along it. Writes
/// points and each edge's turn against State 1 (angle in the plane, twist in space). `arc`: of State 1.
void spread_turns(const Turn (&turn)[2], const CurveView& view, const std::vector<double>& arc,
                  std::vector<double>& points, std::vector<double>& edge_turn);

}  // namespace bowstring
