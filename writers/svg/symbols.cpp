#include "writers/svg/symbols.hpp"

#include <algorithm>
#include <cmath>

#include "writers/svg/style.hpp"

namespace bowstring {

namespace {

constexpr double support_height = 11.0;  // px
constexpr double support_half_width = 6.5;
constexpr double axis_length = 22.0;
constexpr double arrow_head = 4.5;
constexpr double foreshortened = 0.25;  // of an axis' length: an arrow is not longer than its head then
constexpr double axis_end_radius = 3.6;
constexpr const char* axis_name[] = {"x", "y", "z"};

std::string arrow(const Vector2& from, const Vector2& to) {
  const Vector2 along = normalized(to - from);
  const Vector2 across{{-along[1], along[0]}};
  const Vector2 base = to - arrow_head * along;
  return line(from, base) +
         area({{to, base + 0.45 * arrow_head * across, base - 0.45 * arrow_head * across}}, {{"stroke", "none"}});
}

/// Projection of a unit axis, with the page's y, which points down.
Vector2 on_page(const View& view, int axis) {
  const Vector2 p = project(view, Vector3::unit(axis));
  return {{p[0], -p[1]}};
}

std::string axis_end(const Vector2& center, bool to_reader) {
  std::string out = circle(center, axis_end_radius, {{"fill", "#FFFFFF"}});
  if (to_reader) return out + circle(center, 1.3, {{"stroke", "none"}});
  const double d = std::sqrt(0.5) * axis_end_radius;
  out += line(center + Vector2{{-d, -d}}, center + Vector2{{d, d}});
  return out + line(center + Vector2{{-d, d}}, center + Vector2{{d, -d}});
}

}  // namespace

Attributes contact_attributes() {
  return {{"fill", style::contact_fill}, {"fill-opacity", "0.7"}, {"stroke", "#FFFFFF"}};
}

std::string contact_symbol(const Vector2& at, double radius, const Attributes& more) {
  Attributes attributes{{"stroke-width", two_decimals(std::min(0.6, 0.2 * radius))}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  return circle(at, radius, attributes);
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
  Vector2 sum;
  for (int k = 0; k < axes; ++k) sum = sum + on_page(view, k);
  for (int k = 0; k < axes; ++k) {
    const Vector2 direction = on_page(view, k);
    const double length = norm(direction);
    const bool along_view = length < foreshortened;
    const Vector2 tip = center + axis_length * direction;
    out += along_view ? axis_end(center, cross(view.right, view.up)[k] > 0.0) : arrow(center, tip);
    const Vector2 label = along_view ? center - 12.0 * normalized(sum) : tip + (9.0 / length) * direction;
    out += open_group({{"stroke", "none"}});
    out += text_at({{label[0], label[1] + 4.0}}, axis_name[k], "middle") + close_group();
  }
  return out + close_group();
}

}  // namespace bowstring
