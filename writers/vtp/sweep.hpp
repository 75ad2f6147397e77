#pragma once

#include <vector>

#include "writers/vtp/model.hpp"

namespace bowstring {

/// Appends the tube around a centerline as one part of triangles that face outward, open at both ends. Every node has a
/// ring of `sides` points at its radius in the plane across its frame's first axis; ring points carry the node's data.
/// The rings' frame is transported in parallel from node to node, so that the surface neither twists nor flips,
/// whatever the material frames do.
void add_tube(const std::vector<ModelPoint>& centerline, int sides, const ModelPart& part, Model& model);

}  // namespace bowstring
