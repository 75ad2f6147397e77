#include "writers/svg/layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/sdk/guard.hpp"

namespace bowstring {

namespace {

constexpr double greatest_height = 640.0;  // of all drawings together
constexpr double between = 30.0;
constexpr double border = 20.0;          // room for the symbols at the ends of curves
constexpr double scale_bar_part = 0.18;  // of the drawing's width, at most

struct Extent {
  Vector2 lower{{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}};
  Vector2 upper = -lower;

  void include(const Vector2& point, double radius) {
    for (int k = 0; k < 2; ++k) {
      lower[k] = std::min(lower[k], point[k] - radius);
      upper[k] = std::max(upper[k], point[k] + radius);
    }
  }
  bool empty() const { return !(lower[0] <= upper[0]); }
  Vector2 size() const { return upper - lower; }
  Vector2 middle() const { return 0.5 * (lower + upper); }
};

Extent extent(const std::vector<Disc>& shown, const View& view) {
  Extent out;
  for (const Disc& disc : shown) {
    if (is_finite(disc.center)) out.include(project(view, disc.center), disc.radius);
  }
  return out;
}

std::vector<Disc> discs_of(const Result& result) {
  std::vector<Disc> out;
  for (const ResultCurve& curve : result.curves) {
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const double radius = std::isfinite(curve.radius[i]) ? curve.radius[i] : 0.0;
      for (const Vector3& point : {curve.points[i], curve.reference[i]}) out.push_back({point, radius});
    }
  }
  return out;
}

/// px per mm with which drawings of this width and total height, in mm, fit.
double fitting_scale(double width, double height, double free_width, double free_height) {
  const double scale = std::min(free_width / width, free_height / height);
  return std::isfinite(scale) ? scale : 1.0;
}

}  // namespace

Vector2 Panel::place(const Vector3& point) const {
  const Vector2 p = project(view, point);
  return {{origin[0] + scale * p[0], origin[1] - scale * p[1]}};
}

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value * (1.0 + 1e-9)) return digit * power;
  }
  return power;
}

Layout arrange(const Result& result, double top) { return arrange(choose_views(result), discs_of(result), top); }

Layout arrange(const std::vector<View>& views, const std::vector<Disc>& shown, double top) {
  Layout out;
  out.width = page_width;
  std::vector<Extent> extents;
  double width = 0.0, height = 0.0;
  for (const View& view : views) {
    extents.push_back(extent(shown, view));
    if (extents.back().empty()) {
      throw StatusError(Code::invalid_input,
                        "curves: found no point with finite coordinates, expected at least one; "
                        "look at the document's status and reason");
    }
    width = std::max(width, extents.back().size()[0]);
    height += extents.back().size()[1];
    out.panels.push_back({view, {}, 1.0, 0.0, 0.0});
  }
  const double left = page_margin + gutter, free_width = page_width - page_margin - left;
  const double scale = fitting_scale(width, height, free_width - 2.0 * border, greatest_height);
  const double least_height = gutter;
  for (std::size_t i = 0; i < extents.size(); ++i) {
    Panel& panel = out.panels[i];
    panel.scale = scale;
    panel.top = top;
    panel.height = std::max(scale * extents[i].size()[1] + 2.0 * border, least_height);
    const Vector2 middle = extents[i].middle();
    panel.origin = {{left + 0.5 * free_width - scale * middle[0], top + 0.5 * panel.height + scale * middle[1]}};
    top += panel.height + between;
  }
  out.bottom = top - between;
  out.scale_bar_mm = round_down(scale_bar_part * free_width / scale);
  return out;
}

}  // namespace bowstring
