#pragma once

#include <vector>

#include "core/interfaces/ground_cost.hpp"
#include "core/interfaces/transport.hpp"

namespace bowstring {

/// The derivative of a transport value with respect to the places of one measure.
struct PlaceGradient {
  std::vector<double> position;  ///< count × 3, global axes, unit of the value per mm
  std::vector<double> frame;     ///< count × 6, body tangents (ω, ν); empty of points without orientation
};

/// The derivatives of a method's answer by the places of `a` and of `b`: Σ_j (∂value/∂c_ij) ∂₁c(x_i, y_j), with the
/// costs within each measure where the method uses them.
Status place_gradients(const GroundCost& cost, const Measure& a, const Measure& b, const TransportAnswer& answer,
                       PlaceGradient& of_a, PlaceGradient& of_b);

}  // namespace bowstring
