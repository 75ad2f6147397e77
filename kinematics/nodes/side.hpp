#pragma once

#include <cmath>

#include "core/curve_kinematics/orientation.hpp"
#include "core/lie/so3.hpp"

namespace bowstring {

/// An edge's direction and length.
template <int d>
struct EdgeMeasure {
  Vector<d> tangent;
  double length = 0.0;
};

/// What a station reads of an edge or of a held tangent. An edge has `edge_numbers` unknowns of its own: its vector e,
/// as the difference of its nodes, and with material frames its angle.
template <Manifold manifold>
struct Side {
  static constexpr int d = Orientation<manifold>::dimension, m = Orientation<manifold>::components;
  static constexpr int angles = manifold == Manifold::rotation ? 1 : 0;
  static constexpr int edge_numbers = d + angles;

  Vector<d> tangent;
  lie::Rotation frame;           ///< in space: first axis along the tangent
  double length = 0.0;           ///< of an edge; 0 for a held tangent
  Matrix<m, edge_numbers> turn;  ///< ∂α/∂(e, φ): α the tangent numbers of the edge's orientation
  Vector<d> twist_rate;          ///< with material frames ∇D/D, D = ℓ² (1 + t·a) (README.md)

  bool is_edge() const noexcept { return length > 0.0; }
};
using PlanarSide = Side<Manifold::circle>;
using DirectionSide = Side<Manifold::direction>;
using FrameSide = Side<Manifold::rotation>;

/// The reference frame of an edge, which its tangent and its angle turn.
struct EdgeReference {
  const lie::Rotation* frame = nullptr;
  double angle = 0.0;
};

/// Writes the rows of ∂α/∂e across the edge, from `row` on: N/ℓ, the rows of N orthonormal to the tangent.
template <int rows, int columns>
void set_across(const lie::Rotation& frame, double length, int row, Matrix<rows, columns>& turn) noexcept {
  const Matrix3 r = frame.matrix();
  const double scale = 1.0 / length;
  for (int k = 0; k < 3; ++k) {
    turn(row, k) = -r(k, 2) * scale;
    turn(row + 1, k) = r(k, 1) * scale;
  }
}

inline void set_orientation(const EdgeReference&, PlanarSide& side) noexcept {
  const double scale = 1.0 / side.length;
  side.turn = {{-side.tangent[1] * scale, side.tangent[0] * scale}};
}
inline void set_orientation(const EdgeReference&, DirectionSide& side) noexcept {
  side.frame = lie::frame_from_tangent(side.tangent);
  set_across(side.frame, side.length, 0, side.turn);
}
/// The frame of State 1 after the least turn from its tangent a to the edge's t, then turned by the angle about t.
inline void set_orientation(const EdgeReference& reference, FrameSide& side) noexcept {
  side.frame = lie::transport(*reference.frame, side.tangent) * lie::about_first_axis(reference.angle);
  const Vector3 a = reference.frame->first_axis();
  const double cosine = dot(a, side.tangent);
  const double scale = 1.0 / (side.length * (1.0 + cosine));
  const Vector3 twist = cross(side.tangent, a) * scale;
  side.twist_rate = ((2.0 + cosine) * side.tangent + a) * scale;
  for (int k = 0; k < 3; ++k) side.turn(0, k) = twist[k];
  side.turn(0, 3) = 1.0;
  set_across(side.frame, side.length, 1, side.turn);
}

/// Whether the least turn from State 1 exists.
inline bool has_frame(const EdgeReference&, const PlanarSide&) noexcept { return true; }
inline bool has_frame(const EdgeReference&, const DirectionSide&) noexcept { return true; }
inline bool has_frame(const EdgeReference& reference, const FrameSide& side) noexcept {
  constexpr double opposite = 1e-8;  // 1 + cos of a turn of π − 1.4e-4
  return 1.0 + dot(reference.frame->first_axis(), side.tangent) > opposite;
}

inline void load_held(const double* q, PlanarSide& side) noexcept {
  side.tangent = tangent(PlanarOrientation::load(q));
}
template <Manifold manifold>
void load_held(const double* q, Side<manifold>& side) noexcept {
  side.frame = lie::Rotation::load(q);
  side.tangent = side.frame.first_axis();
}

inline RelativeAngle strain_between(const PlanarSide& a, const PlanarSide& b) noexcept {
  return {{{std::atan2(cross(a.tangent, b.tangent), dot(a.tangent, b.tangent))}}};
}
template <Manifold manifold>
StationStrain<manifold> strain_between(const Side<manifold>& a, const Side<manifold>& b) noexcept {
  return station_strain(Orientation<manifold>{a.frame}, Orientation<manifold>{b.frame});
}

/// g·∂²α over an edge's own (e, φ). Across the edge it is −(t vᵀ + v tᵀ)/ℓ over e, with v = gᵀ∂α/∂e of the rows across.
template <Manifold manifold>
auto edge_turn_curvature(const Side<manifold>& side, const Vector<Side<manifold>::m>& g) noexcept {
  constexpr int d = Side<manifold>::d, m = Side<manifold>::m, n = Side<manifold>::edge_numbers;
  constexpr int twist = m - (d - 1);  // rows before those across the edge
  Vector<n> v, t;
  const double scale = -1.0 / side.length;
  for (int k = 0; k < d; ++k) {
    t[k] = scale * side.tangent[k];
    for (int i = twist; i < m; ++i) v[k] += g[i] * side.turn(i, k);
  }
  Matrix<n, n> out;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) out(i, j) = t[i] * v[j] + v[i] * t[j];
  }
  if constexpr (twist != 0) {
    // With ω the rows of ∂α: g₁ ω₁' + ω₁ (g₂ ω₃ − g₃ ω₂), ω₁' = −(ω₁ − φ')(∇D/D) (README.md).
    Vector<n> half, along, rate, s;
    for (int k = 0; k < n; ++k) {
      half[k] = 0.5 * side.turn(0, k);
      s[k] = g[1] * side.turn(2, k) - g[2] * side.turn(1, k);
      if (k < d) along[k] = g[0] * half[k], rate[k] = side.twist_rate[k];
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        out(i, j) += half[i] * s[j] + s[i] * half[j] - along[i] * rate[j] - rate[i] * along[j];
      }
    }
  }
  return out;
}

/// Numbers of an interior station's stencil, without L: three nodes, then the angles of both edges.
template <Manifold manifold>
constexpr int station_width = 3 * Side<manifold>::d + 2 * Side<manifold>::angles;

/// From derivatives in the own unknowns of edges a and b to those in the stencil of the station between them, one row.
template <Manifold manifold, int n = Side<manifold>::edge_numbers>
Vector<station_width<manifold>> at_nodes(const Vector<n>& a, const Vector<n>& b) noexcept {
  constexpr int d = Side<manifold>::d;
  Vector<station_width<manifold>> out;
  for (int k = 0; k < d; ++k) {
    out[k] = -a[k];
    out[d + k] = a[k] - b[k];
    out[2 * d + k] = b[k];
  }
  if constexpr (n > d) out[3 * d] = a[d], out[3 * d + 1] = b[d];
  return out;
}

/// The same for second derivatives `aa`, `ba`, `bb` (rows b, columns a): the lower triangle.
template <Manifold manifold, int n = Side<manifold>::edge_numbers>
Matrix<station_width<manifold>, station_width<manifold>> at_nodes(const Matrix<n, n>& aa, const Matrix<n, n>& ba,
                                                                  const Matrix<n, n>& bb) noexcept {
  constexpr int d = Side<manifold>::d;
  Matrix<station_width<manifold>, station_width<manifold>> out;
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      out(i, j) = aa(i, j);
      out(d + i, j) = ba(i, j) - aa(i, j);
      out(2 * d + i, j) = -ba(i, j);
      out(d + i, d + j) = aa(i, j) - ba(i, j) - ba(j, i) + bb(i, j);
      out(2 * d + i, d + j) = ba(i, j) - bb(i, j);
      out(2 * d + i, 2 * d + j) = bb(i, j);
    }
  }
  if constexpr (n > d) {
    for (int j = 0; j < d; ++j) {
      out(3 * d, j) = -aa(d, j);
      out(3 * d, d + j) = aa(d, j) - ba(j, d);
      out(3 * d, 2 * d + j) = ba(j, d);
      out(3 * d + 1, j) = -ba(d, j);
      out(3 * d + 1, d + j) = ba(d, j) - bb(d, j);
      out(3 * d + 1, 2 * d + j) = bb(d, j);
    }
    out(3 * d, 3 * d) = aa(d, d);
    out(3 * d + 1, 3 * d) = ba(d, d);
    out(3 * d + 1, 3 * d + 1) = bb(d, d);
  }
  return out;
}

}  // namespace bowstring
