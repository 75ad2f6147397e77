#pragma once

#include <string>
#include <vector>

#include "core/interfaces/measure.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// kind `projection`: points → image plane, with derivatives.
class Projection {
 public:
  virtual ~Projection() = default;
  /// `point`: count × 3, mm. `image`: count × 2. `jacobian`: count × 2 × 3, left alone when empty.
  virtual Status project(Span<const double> point, Span<double> image, Span<double> jacobian) const noexcept = 0;
};

/// kind `loss`: a predicted measure against an observed one.
class Loss {
 public:
  virtual ~Loss() = default;
  /// `gradient`: with respect to the predicted positions, count × 3, global axes; left alone when empty.
  virtual Status evaluate(const Measure& predicted, const Measure& observed, double* value,
                          Span<double> gradient) noexcept = 0;
};

/// kind `residual`: a correction composed with the physics prediction from the right, g ↦ g · Exp(η).
class Residual {
 public:
  virtual ~Residual() = default;
  /// `eta`: count × 6 (ω, ν) body twists, one per place of `predicted`.
  virtual Status evaluate(const Measure& predicted, Span<double> eta) noexcept = 0;
};

/// kind `readout`: a result document → named quantities.
class Readout {
 public:
  virtual ~Readout() = default;
  virtual Status read(const char* document, std::vector<std::string>& names, std::vector<double>& values) noexcept = 0;
};

/// Right-hand side of an ordinary differential equation on a group: the body velocity of the frame and the rate of
/// the accompanying numbers at arc coordinate s.
class GroupRightHandSide {
 public:
  virtual ~GroupRightHandSide() = default;
  virtual Status evaluate(double s, Span<const double> frame, Span<const double> numbers, Span<double> body_velocity,
                          Span<double> rate) noexcept = 0;
};

/// kind `integrator`: advances a frame and its accompanying numbers along a curve.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// `frame`: quaternion and position (7 numbers), in and out. `numbers`: in and out.
  virtual Status integrate(GroupRightHandSide& right_hand_side, double s_begin, double s_end, Span<double> frame,
                           Span<double> numbers) noexcept = 0;
};

}  // namespace bowstring
