#pragma once

#include <vector>

#include "core/interfaces/measure.hpp"
#include "core/interfaces/parameter.hpp"
#include "core/lie/se3.hpp"

namespace bowstring::geodesics {

/// The metric in the user's units: w₁ and w_l in 1/mm, β and w_r per rad, without dimension.
struct MetricWeights {
  double forward = 1.0, lateral = 1.0, bend = 1.0, roll = 1.0;

  /// Lengths of 1 in units of β/w₁, per mm.
  double shrink() const noexcept { return forward / bend; }
};

/// The frames of a measure as motions, lengths times `shrink`, rotations normalised.
std::vector<lie::Se3> frames_of(const Measure& measure, double shrink);

/// The declarations that costs of this family share.
inline constexpr ParameterDeclaration forward_weight{.key = "forward-weight",
                                                     .type = ParameterType::scalar,
                                                     .unit = "1/mm",
                                                     .default_text = "\"1 1/mm\"",
                                                     .description = "what motion along the tangent costs, per length",
                                                     .lower = 0.0,
                                                     .lower_exclusive = true};
inline constexpr ParameterDeclaration lateral_weight{.key = "lateral-weight",
                                                     .type = ParameterType::scalar,
                                                     .unit = "1/mm",
                                                     .default_text = "\"1 1/mm\"",
                                                     .description = "what motion across the tangent costs, per length",
                                                     .lower = 0.0,
                                                     .lower_exclusive = true};
inline constexpr ParameterDeclaration bend_weight{
    .key = "bend-weight",
    .type = ParameterType::scalar,
    .unit = "",
    .default_text = "1.0",
    .description =
        "what turning the tangent costs, per rad; over forward-weight it is the length that a radian is worth",
    .lower = 0.0,
    .lower_exclusive = true};
inline constexpr ParameterDeclaration roll_weight{.key = "roll-weight",
                                                  .type = ParameterType::scalar,
                                                  .unit = "",
                                                  .default_text = "1.0",
                                                  .description = "what a turn about the tangent costs, per rad",
                                                  .lower = 0.0,
                                                  .lower_exclusive = true};

}  // namespace bowstring::geodesics
