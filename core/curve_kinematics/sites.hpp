#pragma once

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/curve_kinematics/fields.hpp"
#include "core/interfaces/kinematics.hpp"

namespace bowstring {

/// Site `node`: the positions themselves; ds is half of the adjacent edges at the start.
SiteDeclaration node_site(const CurveMesh& mesh, const FieldSlot& position);
void evaluate_nodes(const CurveMesh& mesh, const FieldSlot& position, const SiteEvaluation& out) noexcept;

/// Site `length` of a sliding wire: L and the held edges.
SiteDeclaration length_site(const CurveMesh& mesh, const FieldSlot& length);
void evaluate_length(const CurveMesh& mesh, const FieldSlot& length, const SiteEvaluation& out) noexcept;

/// Site `station` with everything but stencils of `width` unknowns, all −1 so far. On a sliding wire the last unknown
/// of each stencil is L, which is set here and counts in `width`.
SiteDeclaration station_site(const CurveMesh& mesh, int components, int width, const FieldSlot& length);

/// Site `edge` of a stretching curve with everything but its stencils.
SiteDeclaration edge_site(const CurveMesh& mesh, int width);

/// Site `closure` over the given edges, with everything but its stencils.
SiteDeclaration closure_site(const CurveMesh& mesh, const std::vector<int>& edges, int values, int width);

}  // namespace bowstring
