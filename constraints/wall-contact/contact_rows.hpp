#pragma once

#include <vector>

#include "core/contact/connected.hpp"
#include "core/contact/gap.hpp"
#include "core/interfaces/constraint.hpp"

namespace bowstring::wall_contact {

/// Where along the wire rows stand.
enum class Discretisation : int {
  same_index,    ///< at each node, against the vessel's node of the same number
  node_wise,     ///< at each node, or at more fixed stations per segment, against the closest point
  segment_wise,  ///< at each node, and one per segment wherever along its chord the gap is largest
};

/// The wall as a row sees it.
struct Wall {
  contact::Centerline centerline;
  contact::GapForm form = contact::GapForm::squared;
  bool outside = false;        ///< the wire stays outside of the tube instead of inside
  contact::TubeBounds bounds;  ///< where rows look for the lowest place
};

/// One point of the wire that stays on its side of the wall.
struct Row {
  int node = 0, nodes = 1;    ///< reads `nodes` wire nodes from `node` on
  double t = 0.0;             ///< x = (1 − t) p_node + t p_{node+1}, at the accepted state
  bool extremal = false;      ///< t is searched for: where the gap is largest between the nodes …
  contact::ChordPart part;    ///< of the chord: where it is searched for
  bool midway = false;        ///< … unless the wall bends away there: then t is the part's middle
  double bend = 0.0;          ///< how much it does, at the accepted state (ChordExtremum), mm
  bool searches = true;       ///< σ is searched for; otherwise it is given
  double radius[2] = {};      ///< of the wire at its nodes, mm
  contact::Window window;     ///< of σ
  contact::NodeRange covers;  ///< vessel nodes within it
  double sigma = 0.0;         ///< at the accepted state, and what follows
  double end_sigma[2] = {};   ///< of the chord's two ends where t is searched for; otherwise σ twice
  contact::Stencil stencil;   ///< of the vessel there
  double offset[3] = {};      ///< x − q
  double tangent[3] = {};     ///< unit, of the vessel
  double gap = 0.0, clearance = 1.0;
  bool jumped = false;  ///< σ is not where the search from the place before ended: its gap is another function

  int places() const noexcept { return nodes + covers.count; }
};

/// A row at some state.
struct RowPoint {
  contact::WirePoint wire;
  contact::ClosestPoint closest;
  double gap = 0.0;  ///< ≤ 0 on the right side, mm
};

/// A row that searches keeps this share of a segment away from nodes and stations, which have rows of their own: no two
/// rows coincide. What that may hide of the chord between is a few 1e-8 of its height above the nodes.
inline constexpr double chord_margin = 1e-4;

/// `wire`: all its node positions. `window_edge` in the closest point where that is not in the window.
RowPoint locate(const Row& row, const Wall& wall, const double* wire, contact::Window window) noexcept;

/// h to second order at that point; its wire points into `wire` of `locate`.
contact::GapExpansion expand(const Wall& wall, const RowPoint& point) noexcept;

/// The places that the row depends on at that point: its wire nodes, and the vessel nodes of the segment.
RowSupport support(const Row& row, const contact::GapExpansion& expansion) noexcept;

/// ∂(gap) over the places of its support, or over all its places with zeros elsewhere; wire nodes first.
void write_gradient(const Row& row, const Wall& wall, const contact::GapExpansion& expansion, bool all_places,
                    double* out) noexcept;
/// weight·∂²(gap), packed, over the same.
void write_hessian(const Row& row, const Wall& wall, const contact::GapExpansion& expansion, double weight,
                   bool all_places, double* out) noexcept;

/// The lowest place that is connected to where `locate` ended: h is the least gap, and a search that descends from the
/// place before misses a lower minimum beyond a ridge of the wall. Chords whose t is searched for, and the outside of a
/// tube, keep their place.
contact::ClosestPoint lowest_place(const Row& row, const Wall& wall, const RowPoint& point) noexcept;

/// Makes the state the row's accepted one, at the lowest place where the row is near the wall. `point`: what `locate`
/// answers there, where that is known.
void refer_to(Row& row, const Wall& wall, const double* wire, contact::Window window,
              const RowPoint* point = nullptr) noexcept;

/// How far the row's point has moved since then, relative to its wall point and across the vessel, as a fraction of the
/// clearance. `vessel`: all its node positions.
double travelled(const Row& row, int dimension, const double* wire, const double* vessel) noexcept;

}  // namespace bowstring::wall_contact
