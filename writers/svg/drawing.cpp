#include <algorithm>
#include <cmath>

#include "writers/svg/figure.hpp"
#include "writers/svg/markup.hpp"
#include "writers/svg/style.hpp"
#include "writers/svg/symbols.hpp"
#include "writers/svg/tube.hpp"

namespace bowstring {

namespace {

constexpr double least_circle = 0.3;  // px, radius; smaller ones cannot be seen

enum class State { reference, deformed };

const std::vector<Vector3>& points_of(const ResultCurve& curve, State state) {
  return state == State::reference ? curve.reference : curve.points;
}

Polyline placed(const Panel& panel, const std::vector<Vector3>& points) {
  Polyline out;
  for (const Vector3& point : points) {
    if (is_finite(point)) out.push_back(panel.place(point));
  }
  return out;
}

/// The lumen in px; empty where the vessel has no radius.
Tube lumen(const Panel& panel, const ResultCurve& vessel, State state) {
  Tube out;
  const std::vector<Vector3>& points = points_of(vessel, state);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i]) || !(vessel.radius[i] > 0.0) || !std::isfinite(vessel.radius[i])) continue;
    out.points.push_back(panel.place(points[i]));
    out.radius.push_back(panel.scale * vessel.radius[i]);
  }
  return refine(out);
}

std::string outlines(const Tube& tube, const char* name) {
  std::string out;
  if (tube.points.size() < 2) return out;
  for (const Polyline& run : tube_outline(tube)) out += polyline(run, {{"class", name}});
  return out;
}

template <class Draw>
std::string for_each(const Result& result, bool wires, Draw draw) {
  std::string out;
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    if (result.curves[i].wire == wires) out += draw(result.curves[i], static_cast<int>(i));
  }
  return out;
}

std::string walls(const Result& result, const Panel& panel) {
  std::string out = open_group({{"fill", style::lumen}, {"stroke", "none"}});
  out += for_each(result, false, [&](const ResultCurve& vessel, int) {
    return area(tube_area(lumen(panel, vessel, State::deformed)), {{"class", "lumen"}});
  });
  out += close_group() + open_group({{"fill", "none"}, {"stroke", style::vessel}, {"stroke-width", style::wall_width}});
  out += for_each(result, false, [&](const ResultCurve& vessel, int) {
    return outlines(lumen(panel, vessel, State::deformed), "wall-2");
  });
  out += close_group() + open_group({{"fill", "none"},
                                     {"stroke", style::state1},
                                     {"stroke-width", style::wall_width},
                                     {"stroke-dasharray", style::wall1_dashes}});
  out += for_each(result, false, [&](const ResultCurve& vessel, int) {
    return outlines(lumen(panel, vessel, State::reference), "wall-1");
  });
  return out + close_group();
}

std::string centerlines(const Result& result, const Panel& panel) {
  std::string out = open_group({{"fill", "none"}, {"stroke-width", style::centerline_width}});
  out += for_each(result, false, [&](const ResultCurve& vessel, int) {
    return polyline(placed(panel, vessel.reference), {{"class", "centerline-1"},
                                                      {"stroke", style::state1},
                                                      {"stroke-dasharray", style::centerline1_dashes}}) +
           polyline(placed(panel, vessel.points), {{"class", "centerline-2"}, {"stroke", style::vessel}});
  });
  return out + close_group();
}

std::string wires(const Result& result, const Panel& panel) {
  std::string out = open_group({{"fill", "none"}, {"stroke-linejoin", "round"}});
  out += for_each(result, true, [&](const ResultCurve& wire, int index) {
    return polyline(placed(panel, wire.points), {{"class", "wire"},
                                                 {"stroke", style::wire_color(result, index)},
                                                 {"stroke-width", two_decimals(style::wire_width(wire, panel.scale))}});
  });
  return out + close_group();
}

/// Largest first, so that no circle hides a smaller one.
std::string contacts(const Result& result, const Panel& panel) {
  const double largest = style::largest_force(result);
  if (largest == 0.0) return "";
  std::vector<ResultContact> sorted;
  for (const ResultContact& contact : result.contacts) {
    if (contact.force > style::negligible_force && std::isfinite(contact.force)) sorted.push_back(contact);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.force > b.force; });
  std::string out = open_group(contact_attributes());
  for (const ResultContact& contact : sorted) {
    const ResultCurve& wire = result.curves[static_cast<std::size_t>(contact.wire)];
    const int node = nearest_node(wire, contact.arc);
    const double radius = style::contact_radius(contact.force, largest);
    if (node < 0 || radius < least_circle) continue;
    const Vector3& point = wire.points[static_cast<std::size_t>(node)];
    if (is_finite(point)) out += contact_symbol(panel.place(point), radius, {{"class", "contact"}});
  }
  return out + close_group();
}

/// Direction in which the curve leaves at an end, in px; downwards where the projection does not tell.
Vector2 outward(const Polyline& points, bool last) {
  const Vector2& end = last ? points.back() : points.front();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector2 direction = end - (last ? points[points.size() - 1 - i] : points[i]);
    if (norm(direction) > 1.0) return normalized(direction);
  }
  return {{0.0, 1.0}};
}

/// One symbol per place: a wire is often held where its vessel is.
std::string supports(const Result& result, const Panel& panel) {
  std::string out = open_group(support_attributes());
  std::vector<Vector2> marked;
  for (const ResultSupport& support : result.supports) {
    const Polyline points = placed(panel, result.curves[static_cast<std::size_t>(support.curve)].points);
    if (points.empty()) continue;
    const Vector2 at = support.last ? points.back() : points.front();
    if (std::any_of(marked.begin(), marked.end(), [&](const Vector2& other) { return norm(other - at) < 1.0; })) {
      continue;
    }
    marked.push_back(at);
    out += support_symbol(at, outward(points, support.last));
  }
  return out + close_group();
}

}  // namespace

std::string caption(const Panel& panel, int axes) {
  std::string out = open_group({{"fill", style::soft_ink}, {"font-size", "11"}});
  double y = panel.top + 14.0;
  for (const std::string& row : wrapped(panel.view.name, 10)) {
    out += text_at({{page_margin, y}}, row);
    y += 13.0;
  }
  out += triad({{page_margin + 34.0, panel.top + 0.5 * panel.height + 14.0}}, panel.view, axes);
  return out + close_group();
}

std::string draw_panels(const Result& result, const Layout& layout) {
  std::string out;
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const Panel& panel = layout.panels[i];
    out += open_group({{"id", "view-" + std::to_string(i + 1)}});
    out += walls(result, panel) + centerlines(result, panel) + supports(result, panel) + wires(result, panel);
    out += contacts(result, panel) + caption(panel, result.dimension);
    out += close_group();
  }
  return out;
}

}  // namespace bowstring
