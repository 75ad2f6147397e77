#pragma once

#include <vector>

#include "core/assembly/assembly.hpp"
#include "core/lie/small_matrix.hpp"

namespace bowstring::checking {

/// x ↦ Exp(turn)(x − centre) + centre + shift, in the plane about its normal.
struct RigidMotion {
  Vector3 turn, shift, centre;  ///< rad, mm, mm
};

/// Moves whole curves as rigid bodies, with everything that their unknowns mean: positions, directions, frames, angles.
class Mover {
 public:
  explicit Mover(const Assembly& assembly);

  /// `unsupported` naming the field where the curve has one that nobody can say how to move, found by asking the
  /// kinematics for positions and tangents afterwards. `out` may not be `q`.
  Status move(const std::vector<double>& q, int curve, const RigidMotion& motion, std::vector<double>& out) const;

  /// Whether the curve has material frames that can turn about its tangent by themselves.
  bool spins(int curve) const noexcept;
  /// Turns every frame of a curve, the held ones included, by an angle about its tangent.
  void spin(int curve, double angle, std::vector<double>& q) const noexcept;

  /// Rates of all tangent numbers of a curve, 0 elsewhere, under the motion's turn and shift as velocities.
  Status rate(const std::vector<double>& q, int curve, const RigidMotion& motion, std::vector<double>& out) const;
  /// Rates under `spin`.
  std::vector<double> spin_rate(int curve) const;

  /// Mean of the curve's nodes, and the largest distance from it.
  Vector3 centre(const std::vector<double>& q, int curve) const;
  double radius(const std::vector<double>& q, int curve) const;

 private:
  const double* positions(const std::vector<double>& q, int curve) const noexcept;
  Status turn_angles(const std::vector<double>& q, int curve, const RigidMotion& motion,
                     std::vector<double>& out) const;
  Status verify(const std::vector<double>& q, int curve, const RigidMotion& motion,
                const std::vector<double>& moved) const;
  Status sample(const std::vector<double>& q, int curve, CurveSample& out) const;
  bool has_edge_angles(int curve) const noexcept;

  const Assembly& assembly_;
  std::vector<std::size_t> first_entry_;  // per curve, and the end
};

}  // namespace bowstring::checking
