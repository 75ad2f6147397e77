#pragma once

#include "core/lie/se3.hpp"

/// Normal geodesics of left-invariant metrics on SE(3) with a diagonal cometric.
///
/// Lengths are in units of β/w₁, the length that one radian of bend is worth, and distances in units of β: forward and
/// bend weights are 1 there, roll weighs ρ = w_r/β, and 1/w_l² becomes κ = (w₁/w_l)²; κ = 0 is the sub-Riemannian
/// metric, whose curves do not move sideways.
namespace bowstring::geodesics {

struct Weights {
  double roll_squared = 1.0;        ///< ρ², > 0
  double lateral_compliance = 0.0;  ///< κ ≥ 0
};

/// (m, p), dual to body twists (ω, ν).
using Covector = Vector<6>;

constexpr Vector3 moment(const Covector& c) noexcept { return lie::se3::angular(c); }
constexpr Vector3 force(const Covector& c) noexcept { return lie::se3::linear(c); }

/// 2H = p₁² + κ(p₂² + p₃²) + m₁²/ρ² + m₂² + m₃²: the squared length of the geodesic on [0, 1].
double squared_length(const Covector& start, const Weights& weights) noexcept;

/// Where a geodesic from the identity has come to.
struct GeodesicEnd {
  lie::Se3 pose;
  Covector covector;      ///< in the body frame there
  Matrix<6, 6> by_start;  ///< body twist of `pose` by the covector at the start
};

/// How the step of the integrator follows from what turns: `fine` leaves about 1e-13 of the pose, `coarse` 1e-9, enough
/// for a step of Newton's method.
enum class Accuracy { coarse, fine };

/// The geodesic that leaves the identity with the covector `start`, after `duration`.
///
/// With R the frame and x its place, Rp = p₀ and x × Rp + Rm = m₀ stay. The tangent t = Re₁ and L = m₀ − x × p₀ obey
///   x' = κ p₀ + (1 − κ)(p₀·t) t,   t' = L × t,
/// and so does the frame R^ that turns with L in space, q' = ½ L q as a quaternion; m₁ = L·t is constant, and
/// R = R^ Exp(e₁ m₁ (1/ρ² − 1) τ). The variations (δx, η), δt = η × t, obey the linearised equations
///   δx' = κ δp₀ + (1 − κ)[(δp₀·t + p₀·δt) t + (p₀·t) δt],   η' = δL + L × η.
/// Integrated by the eighth-order method of Dormand and Prince as in Hairer, Nørsett, Wanner, "Solving Ordinary
/// Differential Equations I", II.5 and II.10 (DOP853), with fixed steps.
GeodesicEnd follow_geodesic(const Covector& start, double duration, const Weights& weights, Accuracy accuracy) noexcept;

/// Derivative of `GeodesicEnd::covector` by the covector at the start.
Matrix<6, 6> covector_by_start(const GeodesicEnd& end) noexcept;

}  // namespace bowstring::geodesics
