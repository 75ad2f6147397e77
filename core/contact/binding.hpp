#pragma once

#include <vector>

#include "core/contact/centerline.hpp"
#include "core/interfaces/constraint.hpp"

namespace bowstring::contact {

/// σ on the second curve of `scene.on` that each node of the first one is first bound to: at equal arc length where it
/// starts along that curve, otherwise the globally nearest place, monotone along it.
std::vector<double> first_places(const ConstraintScene& scene, const Centerline& centerline);

}  // namespace bowstring::contact
