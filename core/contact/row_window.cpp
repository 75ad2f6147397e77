#include "core/contact/row_window.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring::contact {

namespace {

constexpr int in_length = 1;  // of the window's unit alternatives

}  // namespace

Interpolation interpolation_of(const ParameterSet& parameters) {
  return parameters.text("centerline") == "polyline" ? Interpolation::polyline : Interpolation::spline;
}

RowWindow::RowWindow(const ParameterSet& parameters) {
  if (!parameters.has("window")) return;
  size_ = parameters.scalar("window");
  is_length_ = parameters.at("window").unit_alternative == in_length;
}

int RowWindow::segments(const ConstraintScene& scene) const noexcept {
  const CurveView& vessel = scene.on[1];
  const double edge = vessel.arc[vessel.nodes - 1] / (vessel.nodes - 1);
  double segments = std::max<double>(scene.window_segments, std::ceil(scene.window_length / edge));
  if (size_ > 0.0) segments = is_length_ ? std::ceil(size_ / edge) : std::round(size_);
  return static_cast<int>(std::clamp<double>(segments, 1.0, vessel.nodes));
}

bool near_edge(Window window, double first, double last, double margin, int vessel_nodes) noexcept {
  const bool low = window.low > 0.0 && first < window.low + margin;
  const bool high = window.high < vessel_nodes - 1 && last > window.high - margin;
  return low || high;
}

}  // namespace bowstring::contact
