#pragma once

#include "core/contact/gap.hpp"
#include "core/interfaces/constraint.hpp"
#include "core/interfaces/parameter.hpp"

/// Keys and settings of constraints whose rows search their place along a vessel.
namespace bowstring::contact {

/// "centerline": spline | polyline.
constexpr ParameterDeclaration centerline_key(const char* description) noexcept {
  ParameterDeclaration out{"centerline", ParameterType::choice, "", "\"spline\"", description};
  out.choices = "spline|polyline";
  return out;
}
Interpolation interpolation_of(const ParameterSet& parameters);

/// "window": segments (a number) or a length (with a unit).
constexpr ParameterDeclaration window_key(const char* description) noexcept {
  ParameterDeclaration out{"window", ParameterType::scalar, "|mm", "", description};
  out.lower = 0.0;
  out.lower_exclusive = true;
  return out;
}

/// What the user says of the window.
class RowWindow {
 public:
  explicit RowWindow(const ParameterSet& parameters);

  /// Vessel segments on each side of a row's place, at least one and at most all: the user's, otherwise what the solver
  /// asks for. The vessel is the scene's second curve.
  int segments(const ConstraintScene& scene) const noexcept;

 private:
  double size_ = 0.0;  // 0: what the solver asks for
  bool is_length_ = false;
};

/// Whether a row whose places lie between σ = first and last comes within `margin` of an edge of its window that is not
/// an end of the vessel.
bool near_edge(Window window, double first, double last, double margin, int vessel_nodes) noexcept;

}  // namespace bowstring::contact
