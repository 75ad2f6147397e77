#pragma once

#include <vector>

#include "core/contact/centerline.hpp"
#include "core/interfaces/constraint.hpp"

namespace bowstring::contact {

/// σ on the second curve of `scene.on` that each node of the first one is first bound to: at equal arc length where it
/// starts along that curve, otherwise the globally nearest place, monotone along it.
std::vector<double> first_places(const ConstraintScene& scene, const Centerline& centerline);

/// The same at a state that may lie far from there: the closest point on `vessel` at that state is followed along the
/// wire from an end whose position is held (the first one where both or none are), which has `first` as its first
/// place. Each node's search walks down to the first minimum from as far along the vessel as its edge is long, so that
/// the wire stays with the limb that it runs in where the vessel passes near itself, and where a coarse wire cuts
/// across a bend. `points`: of the wire at that state, nodes × dimension; `radius`: what reduces the clearance at its
/// nodes, mm, or null.
std::vector<double> places_at(const CurveView& wire, const Centerline& vessel, const double* points,
                              const double* radius, const std::vector<double>& first);

}  // namespace bowstring::contact
