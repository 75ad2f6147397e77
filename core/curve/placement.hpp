#pragma once

#include <string>
#include <vector>

#include "core/interfaces/geometry.hpp"
#include "core/interfaces/parameter.hpp"
#include "core/lie/small_matrix.hpp"

namespace bowstring {

/// A generated curve in its own axes, before it is placed in the scene: it begins along +x, and what is
/// planar lies in z = 0.
struct LocalCurve {
  std::vector<Vector3> points;             ///< mm
  Vector3 first_tangent{{1.0, 0.0, 0.0}};  ///< unit, along the curve
  Vector3 last_tangent{{1.0, 0.0, 0.0}};   ///< unit, along the curve
  std::vector<std::string> label;          ///< one per point, or empty
};

/// Parameters that every generator has beside its own.
inline constexpr ParameterDeclaration nodes_declaration{.key = "nodes",
                                                        .type = ParameterType::integer,
                                                        .unit = "",
                                                        .default_text = nullptr,
                                                        .description = "number of nodes, both ends included",
                                                        .lower = 3,
                                                        .upper = 1e6};
inline constexpr ParameterDeclaration origin_declaration{
    .key = "origin",
    .type = ParameterType::vector,
    .unit = "mm",
    .default_text = "",
    .description = "where the local origin stands, one number per dimension of the scene; by default 0"};
inline constexpr ParameterDeclaration rotation_declaration{
    .key = "rotation",
    .type = ParameterType::vector,
    .unit = "rad",
    .default_text = "",
    .description = "turn about the local origin: one angle in the plane, a rotation vector in space; by default none"};

/// Appends `curve`, turned by `rotation` and moved to `origin`, as the one curve of `out`. In the plane the
/// points' z has to be 0 and is left out. `invalid_input` where the two parameters do not have the right
/// number of entries.
Status place(const LocalCurve& curve, const ParameterSet& parameters, int dimension, CurveGraph& out);

}  // namespace bowstring
