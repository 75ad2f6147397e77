#pragma once

#include "core/interfaces/kinematics.hpp"
#include "core/lie/so3.hpp"

namespace bowstring {

/// Numbers that one entry of a field stores.
constexpr int coordinate_count(Manifold manifold, int dimension) noexcept {
  switch (manifold) {
    case Manifold::vector:
      return dimension;
    case Manifold::direction:
    case Manifold::rotation:
      return 4;
    case Manifold::real:
    case Manifold::circle:
      break;
  }
  return 1;
}

/// Dimension of the tangent space of one entry of a field.
constexpr int tangent_count(Manifold manifold, int dimension) noexcept {
  switch (manifold) {
    case Manifold::vector:
      return dimension;
    case Manifold::direction:
      return 2;
    case Manifold::rotation:
      return 3;
    case Manifold::real:
    case Manifold::circle:
      break;
  }
  return 1;
}

constexpr bool is_curved(Manifold manifold) noexcept {
  return manifold == Manifold::direction || manifold == Manifold::rotation;
}

/// The tangent numbers as a rotation vector in the body frame: a direction has no twist.
inline Vector3 body_rotation_vector(Manifold manifold, const double* delta) noexcept {
  return manifold == Manifold::direction ? Vector3{{0.0, delta[0], delta[1]}} : Vector3{{delta[0], delta[1], delta[2]}};
}

/// out = q · Exp δ for one entry (`Manifold` states the retraction of each kind). `out` may be `q`.
inline void retract(Manifold manifold, int dimension, const double* q, const double* delta, double* out) noexcept {
  if (!is_curved(manifold)) {
    for (int k = 0; k < coordinate_count(manifold, dimension); ++k) out[k] = q[k] + delta[k];
    return;
  }
  const lie::Rotation rotation = lie::Rotation::load(q) * lie::exp(body_rotation_vector(manifold, delta));
  rotation.normalized().store(out);
}

}  // namespace bowstring
