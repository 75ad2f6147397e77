#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/interfaces/curve.hpp"
#include "core/interfaces/energy.hpp"
#include "core/interfaces/place.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// Manifold of one entry of a field. Coordinates / tangent numbers: real 1/1, vector n/n, circle 1/1 (angle,
/// unwrapped), direction 4/2, rotation 4/3. Rotations are unit quaternions (w, x, y, z). A direction is carried as a
/// rotation whose twist about its first axis is immaterial; its tangent numbers are the body components 2 and 3.
/// Retraction: q + δ on real, vector and circle; R Exp(δ̂) on rotation; R Exp((0, δ₂, δ₃)^) on direction.
enum class Manifold : int { real, vector, circle, direction, rotation };

struct FieldDeclaration {
  std::string name;    ///< "position", "orientation", "edge-length", "length"
  std::string reason;  ///< why it exists, for `explain`
  Manifold manifold = Manifold::real;
  int dimension = 1;                 ///< n of `vector`
  int count = 0;                     ///< entries
  std::vector<double> reference;     ///< coordinates of State 1, count × coordinates
  std::vector<double> start;         ///< coordinates that a solver starts from
  std::vector<char> fixed;           ///< count × tangent numbers; empty: all free. Fixed ones are eliminated
  std::vector<double> lower, upper;  ///< bounds of a `real` field, count; empty: none
  std::vector<double> station;       ///< count: arc coordinate of each entry, for orders along the curve, mm
};

/// The places of one site: which unknowns each depends on. Unknowns are numbered within the curve, field after
/// field in the order of declaration, entry after entry, tangent number after tangent number.
struct SiteDeclaration {
  Site site = Site::node;
  int count = 0;
  int values = 0;               ///< numbers in y, (ds, s) included where they vary
  bool lengths_vary = false;    ///< the last two numbers of y are ds and s
  bool identity = false;        ///< ∂y/∂δ = I, no curvature: the stencil is the unknown itself
  bool linear = false;          ///< no curvature: B is the same at every state
  int width = 0;                ///< unknowns in a stencil
  std::vector<int> stencil;     ///< count × width; −1 pads
  std::vector<double> ds, arc;  ///< count: length of material and arc coordinate at the start
  /// The unknowns bent_first … bent_first + bent() − 1 of a stencil are those that y is not linear in: curvature is
  /// over them alone. bent_count = −1: to the stencil's end.
  int bent_first = 0, bent_count = -1;
  int bent() const noexcept { return bent_count >= 0 ? bent_count : width - bent_first; }
};

struct KinematicsDeclaration {
  std::vector<FieldDeclaration> fields;
  std::vector<SiteDeclaration> sites;  ///< node and, where asked for, the others
  std::string closure_name;            ///< of the closure rows, for `explain`: "edge closure"
};

/// One site's places at one state. Outputs are caller-owned and left alone when empty.
struct SiteEvaluation {
  Site site = Site::node;
  Span<const double> q;       ///< this curve's coordinates, all fields
  Span<double> values;        ///< count × values: y
  Span<double> jacobian;      ///< count × values × width: B = ∂y/∂δ at δ = 0
  Span<const double> stress;  ///< count × values, read only for `curvature`
  Span<double> curvature;     ///< count × packed_size(bent()): Σ_a stress_a ∂²y_a/∂δ²
  /// The same number means the same q as in the last call that had it, whatever the site, so that what was computed
  /// then may serve again; no two states of a process share one. 0: unknown.
  std::uint64_t state = 0;
};

/// Position and orientation of material points of the curve.
struct CurveSample {
  std::vector<double> position;     ///< count × dimension, mm
  std::vector<double> orientation;  ///< count × 4: quaternion of the frame, first axis along the tangent
};

/// A curve as it stands, whatever represents it.
struct CurveShape {
  Span<const double> position;  ///< nodes × dimension, mm
  /// (nodes − 1) × 4: quaternions (w, x, y, z) of the edges, first axis along the edge; the rotation about it is the
  /// material frame's where the curve has one.
  Span<const double> orientation;
};

/// kind `kinematics`: which unknowns represent a curve. It declares fields, its own equality rows (site
/// `closure`, residual zero) and what the ends hold; it never sees an energy. Second derivatives are Taylor
/// coefficients of δ ↦ y(q · Exp δ) at δ = 0.
class Kinematics {
 public:
  virtual ~Kinematics() = default;
  /// `unsupported` with a reason refuses a need or a kind of curve.
  virtual Status declare(const CurveView& curve, const Needs& needs, KinematicsDeclaration& out) noexcept = 0;
  virtual Status evaluate(const SiteEvaluation& evaluation) const noexcept = 0;
  /// Positions and frames at the given fractions of the curve's edges: t = 2.25 is a quarter along the third edge.
  virtual Status sample(Span<const double> q, Span<const double> edge_coordinate, CurveSample& out) const noexcept = 0;
  /// Coordinates of a curve of this shape: a state of another mesh or another kinematics, or of the step before. What
  /// the curve cannot be (a wire of fixed length that is asked to stretch) is left to the closure rows.
  virtual Status adopt(const CurveShape& shape, Span<double> q) const noexcept {
    (void)shape;
    (void)q;
    return Status::failure(Code::unsupported, "this kinematics does not take the shape of another curve");
  }
  /// Coordinates whose strains are the given ones (starts, residuals); `strain` in the order of the stations.
  virtual Status reconstruct(Span<const double> strain, Span<double> q) const noexcept {
    (void)strain;
    (void)q;
    return Status::failure(Code::unsupported, "this kinematics does not reconstruct a curve from strains");
  }
  /// What the rounding of double precision leaves of the stationarity, in N, for a curve whose largest bending
  /// stiffness is `bending_stiffness` (N mm²): the formulation's own floor.
  virtual double rounding_floor(double bending_stiffness) const noexcept = 0;
};

}  // namespace bowstring
