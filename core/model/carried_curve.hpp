#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/composition/recorded_state.hpp"
#include "core/model/scene.hpp"

namespace bowstring {

/// Per node, how much of the curve's material lies before it, from 0 to 1: of a vessel and of a wire of fixed length
/// State 1's arc length, of a sliding wire its own shares.
std::vector<double> material_shares(const Curve& curve);

/// The recorded curve at these shares of its material (increasing, within 0 … 1): positions by the C² cubic spline of
/// the share through the recorded nodes (straight edges through three), `share.size()` × dimension. Recorded nodes come
/// out bit for bit; so do all of them where as many nodes lie within a quarter of an edge of them.
std::vector<double> interpolated_points(const RecordedCurve& recorded, const std::vector<double>& share);

/// What a carried state does not share with a scene of these curves: dimension, vessels, kinds of curves. A wire may
/// come or go.
using NamedKind = std::pair<std::string, CurveKind>;
void compare_scenes(int dimension, const std::vector<NamedKind>& curves, const CarriedState& carried,
                    std::vector<DocumentFlaw>& flaws);

/// The shapes that the curves of a scene take from a state: every curve by its name, at the same shares of its
/// material. A wire whose span along its vessel has changed keeps what was recorded between the vessel's arc
/// coordinates and runs on along the vessel's recorded centerline, to which its distance goes over smoothly; a wire
/// that was not there lies along it. Orientations are slerps of the recorded ones between the middles of edges, turned
/// by the least turn so that the first axis is the edge.
CarriedCurves carried_curves(const Scene& scene, const CarriedState& carried, std::vector<DocumentFlaw>& flaws);

}  // namespace bowstring
