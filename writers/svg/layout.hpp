#pragma once

#include <vector>

#include "writers/svg/projection.hpp"

namespace bowstring {

/// One view's place on the page. Coordinates of the page are in px, y downwards.
struct Panel {
  View view;
  Vector2 origin;      ///< page position of the projection of (0, 0, 0)
  double scale = 1.0;  ///< px per mm, the same in all panels
  double top = 0.0, height = 0.0;

  Vector2 place(const Vector3& point) const;
};

struct Layout {
  std::vector<Panel> panels;
  double width = 0.0;
  double bottom = 0.0;        ///< below the last panel
  double scale_bar_mm = 0.0;  ///< 1, 2 or 5 times a power of ten
};

constexpr double page_width = 960.0;
constexpr double page_margin = 28.0;
constexpr double gutter = 92.0;  ///< left of the drawings, for the names of the views and their axes

/// What has to be seen.
struct Disc {
  Vector3 center;
  double radius = 0.0;  ///< mm
};

/// Stacks the views from `top` on, with one scale that makes them fit. Throws a StatusError with `invalid_input` where
/// nothing has a finite center.
Layout arrange(const std::vector<View>& views, const std::vector<Disc>& shown, double top);
/// The same of a result's curves in both states.
Layout arrange(const Result& result, double top);

/// The largest of 1, 2, 5 times a power of ten that is at most `value`.
double round_down(double value);

}  // namespace bowstring
