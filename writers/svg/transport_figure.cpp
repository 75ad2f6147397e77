#include <algorithm>
#include <cmath>

#include "writers/svg/figure.hpp"
#include "writers/svg/markup.hpp"
#include "writers/svg/style.hpp"

namespace bowstring {

namespace {

constexpr const char* color_a = style::vessel;
constexpr const char* color_b = style::contact_fill;
constexpr double greatest_dot = 4.0, least_dot = 0.8;    // px, radius
constexpr double greatest_line = 1.8, least_line = 0.3;  // px
constexpr double greatest_opacity = 0.75, least_opacity = 0.12;
constexpr double shown_mass = 0.999;       // of the whole: regularised plans have entries everywhere
constexpr std::size_t most_lines = 20000;  // a figure that a browser still opens

/// The entries that carry nearly all of the mass, the lightest first, so that none hides a heavier one.
std::vector<Carried> shown_entries(const TransportPicture& compared, double& share) {
  std::vector<Carried> out;
  double whole = 0.0, mass = 0.0;
  for (const Carried& entry : compared.plan) {
    if (!(entry.mass > 0.0) || !std::isfinite(entry.mass)) continue;
    out.push_back(entry);
    whole += entry.mass;
  }
  std::stable_sort(out.begin(), out.end(), [](const Carried& a, const Carried& b) { return a.mass > b.mass; });
  std::size_t count = 0;
  while (count < out.size() && count < most_lines && mass < shown_mass * whole) mass += out[count++].mass;
  // Those that weigh as much as the last one are no less worth showing.
  while (count > 0 && count < out.size() && count < most_lines && out[count].mass >= out[count - 1].mass) {
    mass += out[count++].mass;
  }
  share = count == out.size() ? 1.0 : mass / whole;
  out.resize(count);
  std::reverse(out.begin(), out.end());
  return out;
}

std::string draw_plan(const TransportPicture& compared, const std::vector<Carried>& entries, const Panel& panel) {
  std::string out = open_group({{"id", "plan"}, {"stroke", style::state1}});
  const double heaviest = entries.empty() ? 1.0 : entries.back().mass;
  for (const Carried& entry : entries) {
    const double part = entry.mass / heaviest;
    out += line(panel.place(compared.a.place[entry.from]), panel.place(compared.b.place[entry.to]),
                {{"stroke-width", two_decimals(std::max(least_line, greatest_line * part))},
                 {"stroke-opacity", two_decimals(std::max(least_opacity, greatest_opacity * std::sqrt(part)))}});
  }
  return out + close_group();
}

/// Dots whose area is in proportion to the weight; a curve as a line through them.
std::string draw_measure(const ComparedMeasure& measure, const char* id, const char* color, const Panel& panel) {
  std::string out = open_group({{"id", id}, {"fill", color}, {"stroke", "none"}});
  Polyline points;
  double heaviest = 0.0;
  for (const Vector3& place : measure.place) points.push_back(panel.place(place));
  for (const double weight : measure.weight) heaviest = std::max(heaviest, weight);
  if (measure.curve) {
    out += polyline(points, {{"fill", "none"}, {"stroke", color}, {"stroke-width", "1"}});
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double part = heaviest > 0.0 ? measure.weight[i] / heaviest : 0.0;
    if (part > 0.0) out += circle(points[i], std::max(least_dot, greatest_dot * std::sqrt(part)));
  }
  return out + close_group();
}

LegendEntry measure_entry(const ComparedMeasure& measure, const char* letter, const char* color) {
  std::string symbol = open_group({{"fill", color}});
  if (measure.curve) {
    symbol += line({{0.0, 0.0}}, {{legend_symbol_width, 0.0}}, {{"stroke", color}, {"stroke-width", "1"}});
  }
  symbol += circle({{0.5 * legend_symbol_width, 0.0}}, greatest_dot) + close_group();
  const std::size_t count = measure.place.size();
  return {symbol, std::string(letter) + (measure.name.empty() ? "" : ": " + measure.name) + ", " +
                      std::to_string(count) + (count == 1 ? " place" : " places")};
}

LegendEntry plan_entry(double share) {
  const std::string symbol =
      line({{0.0, 0.0}}, {{legend_symbol_width, 0.0}},
           {{"stroke", style::state1}, {"stroke-width", two_decimals(greatest_line)}, {"stroke-opacity", "0.75"}});
  return {symbol, "plan, width by mass" + (share < 1.0 ? ": " + short_number(100.0 * share, 4) + " % of it" : "")};
}

std::string summary(const TransportPicture& compared) {
  const std::string unit = compared.unit.empty() ? "" : " " + compared.unit;
  std::string out = "value " + (std::isfinite(compared.value) ? short_number(compared.value, 8) + unit : "not known");
  out += " · " + std::to_string(compared.plan.size()) + " of " +
         std::to_string(compared.a.place.size() * compared.b.place.size()) + " entries are not zero";
  if (compared.certified) out += compared.holds ? " · certified" : " · the certificate does not hold";
  if (compared.uniqueness_known) out += compared.unique ? " · the only plan" : " · another plan has the same value";
  return out;
}

}  // namespace

std::string svg_figure(const TransportPicture& compared) {
  const std::string title = "Transport by " + compared.method + ", ground cost " + compared.cost;
  double y = heading_top, height = 0.0, share = 1.0;
  const bool good = !compared.certified || compared.holds;
  const std::string head = draw_heading(wrapped(title, title_columns), wrapped(summary(compared), note_columns),
                                        good ? style::soft_ink : style::contact_fill, y);
  std::vector<Vector3> places = compared.a.place;
  places.insert(places.end(), compared.b.place.begin(), compared.b.place.end());
  std::vector<Disc> shown;
  for (const Vector3& place : places) shown.push_back({place, 0.0});
  const View view = widest_view(places);
  const Layout layout = arrange({view}, shown, y + below_heading);
  const Panel& panel = layout.panels.front();
  const std::vector<Carried> entries = shown_entries(compared, share);
  std::string body = open_group({{"id", "view-1"}});
  body += draw_plan(compared, entries, panel) + draw_measure(compared.a, "measure-a", color_a, panel) +
          draw_measure(compared.b, "measure-b", color_b, panel) + caption(panel, view.name.empty() ? 2 : 3) +
          close_group();
  body +=
      draw_legend({measure_entry(compared.a, "A", color_a), measure_entry(compared.b, "B", color_b), plan_entry(share)},
                  layout, height);
  return svg_page(title, layout.width, height, head + body);
}

}  // namespace bowstring
