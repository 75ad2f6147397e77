#pragma once

namespace bowstring::contact {

/// How a vessel's centerline q(σ) runs through its nodes p_0 … p_{n−1}. σ ∈ [0, n−1] counts node indices.
///
/// `polyline`: straight edges; passes the nodes exactly, its tangent jumps there.
/// `spline`: the uniform cubic B-spline with control points b_i = p_i − (p_{i+1} − 2p_i + p_{i−1})/6,
/// b_i = p_i at the two ends, and one reflected point beyond each (b_{−1} = 2b_0 − b_1). It is C², each
/// segment depends on at most six nodes, and it passes the nodes to fourth order (second order next to the
/// ends). Interpolating through the nodes would be global; control points on the nodes would shift the curve
/// by κh²/6.
enum class Interpolation : int { polyline, spline };

inline constexpr int max_stencil = 6;

/// A view of a vessel: its nodes and the lumen radius there. The radius is interpolated like the position.
struct Centerline {
  Interpolation interpolation = Interpolation::spline;
  int dimension = 3;               ///< 2 or 3
  int nodes = 0;                   ///< n ≥ 2
  const double* points = nullptr;  ///< n × dimension, mm
  const double* radius = nullptr;  ///< n, mm

  int segments() const noexcept { return nodes - 1; }
};

/// The consecutive nodes first … first + count − 1.
struct NodeRange {
  int first = 0;
  int count = 0;
};

/// A place on the curve: segment j lies between nodes j and j + 1, and σ = j + u with u ∈ [0, 1]. A knot is
/// the end of one segment and the start of the next: as a pair it says whose nodes its stencil uses, and u
/// keeps its precision however long the curve is.
struct CurveCoordinate {
  int segment = 0;
  double u = 0.0;

  double sigma() const noexcept { return segment + u; }
};

/// q(σ) = Σ_k value[k] p_{first+k}, and so with slope for q' and second for q''.
/// Σ value = 1, Σ slope = 0, Σ second = 0.
struct Stencil {
  NodeRange nodes;
  double value[max_stencil] = {};
  double slope[max_stencil] = {};
  double second[max_stencil] = {};
};

/// The curve and its radius at one σ; primes are derivatives in σ. In the plane the
/// third entry is 0.
struct CurvePoint {
  double position[3] = {};
  double slope[3] = {};
  double second[3] = {};
  double radius = 0.0;
  double radius_slope = 0.0;
  double radius_second = 0.0;
};

/// Σ_m a_m u^m and its derivatives in u.
struct Cubic {
  double value, slope, second;
};
inline Cubic cubic(double a0, double a1, double a2, double a3, double u) noexcept {
  return {a0 + u * (a1 + u * (a2 + u * a3)), a1 + u * (2.0 * a2 + u * 3.0 * a3), 2.0 * a2 + u * 6.0 * a3};
}

/// A segment in the power basis, q(u) − origin = Σ_m position[m] u^m and R(u) = Σ_m radius[m] u^m: what a
/// search along the segment evaluates. Linear for a polyline.
struct SegmentPolynomial {
  double position[4][3] = {};
  double radius[4] = {};

  CurvePoint at(double u) const noexcept;
};

/// The pair (segment, u) of σ; a knot belongs to the segment that it starts, the last node to the last
/// segment. σ is clipped to the curve; a NaN gives the first node.
CurveCoordinate coordinate(double sigma, int nodes) noexcept;

/// The nodes that segment `segment` of a curve with `nodes` nodes depends on.
NodeRange segment_nodes(Interpolation interpolation, int segment, int nodes) noexcept;

/// Weights of the nodes at a place; they depend on (segment, u, nodes) alone.
Stencil stencil(Interpolation interpolation, CurveCoordinate at, int nodes) noexcept;

/// The polynomial of one segment relative to `origin` (dimension numbers; null: the coordinates' own). Near a
/// point x, origin = x keeps q − x free of the cancellation that coordinates of hundreds of mm would bring.
SegmentPolynomial segment_polynomial(const Centerline& curve, int segment, const double* origin) noexcept;

/// The curve and its radius at a place.
CurvePoint evaluate(const Centerline& curve, CurveCoordinate at) noexcept;

/// The node where a quantity along a curve is largest.
struct NodeMaximum {
  double value = 0.0;
  int node = -1;  ///< −1 where there is no interior node
};

/// Curvature at interior node `node`: that of the circle through it and its two neighbours, 1/mm. Where the
/// curve turns by more than a right angle no circle with unequal edges measures the fold, and 2 sin(θ/2) over
/// the mean edge bounds it from below; infinite where two neighbouring nodes coincide.
double nodal_curvature(const double* points, int dimension, int node) noexcept;

/// The largest nodal curvature of a curve, 1/mm, and where.
NodeMaximum largest_curvature(const double* points, int dimension, int nodes) noexcept;

/// The largest R κ over the interior nodes of a tube. From 1 on the tube folds into itself and
/// has no gap function.
NodeMaximum tube_folds(const Centerline& tube) noexcept;

}  // namespace bowstring::contact
