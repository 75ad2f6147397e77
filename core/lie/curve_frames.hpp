#pragma once

#include <vector>

#include "core/interfaces/span.hpp"
#include "core/lie/se2.hpp"
#include "core/lie/se3.hpp"

namespace bowstring::lie {

/// Bishop frames of a polyline: one per edge, its first axis the edge's unit tangent, each obtained from the one
/// before by parallel transport, so that Log(R_iᵀR_{i+1}) has no component along the tangent (R. Bishop, Amer. Math.
/// Monthly 82 (1975) 246).
///
/// `points`: n × 3. The first frame is the transport of `*first`, or that of `frame_from_tangent` where it is null.
/// Returns n − 1 frames, none for fewer than two points. An edge of length zero keeps the frame before it.
std::vector<Rotation> bishop_edge_frames(Span<const double> points, const Rotation* first = nullptr);

/// Strains ξ_i = Log(g_i⁻¹g_{i+1})/Δs_i, Δs_i the arc length of element i in the REFERENCE configuration (preprint,
/// section 3, discrete strain): 1/mm in the rotational part, the stretch ratio in |ν|.
///
/// `ds`: one per element, not 0; `frames`: one more.
std::vector<se3::Twist> discrete_strain(Span<const Se3> frames, Span<const double> ds);
std::vector<se2::Twist> discrete_strain(Span<const Se2> frames, Span<const double> ds);

/// The frames g_0 = `first`, g_{i+1} = g_i Exp(Δs_i ξ_i): the inverse of `discrete_strain` as long as no element turns
/// by more than π.
///
/// `strains` and `ds`: one per element. Returns one frame more.
std::vector<Se3> reconstruct(const Se3& first, Span<const se3::Twist> strains, Span<const double> ds);
std::vector<Se2> reconstruct(const Se2& first, Span<const se2::Twist> strains, Span<const double> ds);

}  // namespace bowstring::lie
