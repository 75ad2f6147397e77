#pragma once

#include <string>
#include <vector>

#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// Weighted points with orientations: the measure that a curve or an observation becomes.
struct Measure3 {
  int dimension = 3;
  std::vector<double> position;     ///< count × dimension, mm
  std::vector<double> orientation;  ///< count × 4 quaternions (w, x, y, z), or empty
  std::vector<double> weight;       ///< count, summing to 1
};

/// kind `ground-cost`: squared distance between places of two measures.
class GroundCost {
 public:
  virtual ~GroundCost() = default;
  /// `pairs`: (i, j) index pairs. `value`: one per pair. `gradient`: per pair the derivative with respect to the body
  /// tangent (ω, ν) of the first place, 6 numbers in space, 3 in the plane; left alone when empty.
  virtual Status evaluate(const Measure3& a, const Measure3& b, Span<const int> pairs, Span<double> value,
                          Span<double> gradient) const noexcept = 0;
  /// A cheap lower bound of `value`; `unsupported` where there is none.
  virtual Status lower_bound(const Measure3& a, const Measure3& b, Span<const int> pairs,
                             Span<double> value) const noexcept {
    (void)a;
    (void)b;
    (void)pairs;
    (void)value;
    return Status::failure(Code::unsupported, "this ground cost has no lower bound");
  }
};

struct TransportPlan {
  double value = 0.0;            ///< min ⟨C, γ⟩
  std::vector<int> row, column;  ///< of the nonzero entries
  std::vector<double> mass;
  std::vector<double> dual_row, dual_column;
  double gap = 0.0;  ///< primal minus dual value
};

/// kind `transport`: optimal transport between two weighted sets. It may keep a basis from call to call.
class Transport {
 public:
  virtual ~Transport() = default;
  /// `cost`: rows × columns, row major.
  virtual Status solve(Span<const double> weight_a, Span<const double> weight_b, Span<const double> cost,
                       TransportPlan& out) noexcept = 0;
};

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
  /// `gradient`: with respect to the predicted positions, count × dimension; left alone when empty.
  virtual Status evaluate(const Measure3& predicted, const Measure3& observed, double* value,
                          Span<double> gradient) noexcept = 0;
};

/// kind `residual`: a correction composed with the physics prediction from the right, g ↦ g · Exp(η).
class Residual {
 public:
  virtual ~Residual() = default;
  /// `eta`: count × 6 (ω, ν) body twists, one per place of `predicted`.
  virtual Status evaluate(const Measure3& predicted, Span<double> eta) noexcept = 0;
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
