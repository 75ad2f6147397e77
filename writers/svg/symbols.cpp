#include "writers/svg/symbols.hpp"

#include <cmath>

#include "writers/svg/style.hpp"

namespace bowstring {

namespace {

constexpr double support_height = 11.0;      // px
constexpr double support_half_width = 6.5;
constexpr double axis_length = 22.0;
constexpr double arrow_head = 4.5;
constexpr double foreshortened = 0.12;       // of an axis' length: shorter ones are drawn as a dot
constexpr const char* axis_name[] = {"x", "y", "z"};

std::string arrow(const Vector2& from, const Vector2& to) {
  const Vector2 along = normalized(to - from);
  const Vector2 across{{-along[1], along[0]}};
  const Vector2 base = to - arrow_head * along;
  return line(from, base) +
         area({{to, base + 0.45 * arrow_head * across, base - 0.45 * arrow_head * across}}, {{"stroke", "none"}});
}

}  // namespace

Attributes contact_attributes() {
  return {{"fill", style::contact_fill}, {"fill-opacity", "0.7"}, {"stroke", "#FFFFFF"}, {"stroke-width", "0.6"}};
}

Attributes support_attributes() {
  return {{"fill", "#FFFFFF"}, {"stroke", style::ink}, {"stroke-width", "1.1"}, {"stroke-linejoin", "round"}};
}

std::string support_symbol(const Vector2& at, const Vector2& outward) {
  const Vector2 across{{-outward[1], outward[0]}};
  const Vector2 foot = at + support_height * outward;
  return area({{at, foot + support_half_width * across, foot - support_half_width * across}}, {{"class", "support"}});
}

std::string triad(const Vector2& center, const View& view, int axes) {
  std::string out = open_group({{"stroke", style::soft_ink}, {"stroke-width", "1.1"}, {"fill", style::soft_ink}});
  for (int k = 0; k < axes; ++k) {
    const Vector2 p = project(view, Vector3::unit(k));
    const Vector2 direction{{p[0], -p[1]}};  // the page's y points down
    const double length = norm(direction);
    const Vector2 tip = center + axis_length * direction;
    if (length < foreshortened) {
      out += circle(center, 2.2, {{"stroke", "none"}});
    } else {
      out += arrow(center, tip);
    }
    const Vector2 label = length < foreshortened ? center + Vector2{{-9.0, 9.0}} : tip + (9.0 / length) * direction;
    out += open_group({{"stroke", "none"}}) + text_at({{label[0], label[1] + 4.0}}, axis_name[k], "middle") + close_group();
  }
  return out + close_group();
}

}  // namespace bowstring
