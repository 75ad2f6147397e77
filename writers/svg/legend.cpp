#include <algorithm>
#include <cmath>

#include "writers/svg/figure.hpp"
#include "writers/svg/markup.hpp"
#include "writers/svg/style.hpp"
#include "writers/svg/symbols.hpp"
#include "writers/svg/tube.hpp"

namespace bowstring {

namespace {

constexpr double row_height = 26.0;
constexpr double sample_width = legend_symbol_width;
constexpr double between_entries = 24.0;
constexpr double character_width = 6.7;  // of a sans-serif font of 12 px, on average
constexpr double bar_tick = 4.0;

double width(const LegendEntry& entry) {
  return legend_symbol_width + 8.0 + character_width * static_cast<double>(entry.text.size()) + between_entries;
}

std::string sample_line(const char* color, const char* width, const char* dashes) {
  Attributes attributes{{"stroke", color}, {"stroke-width", width}};
  if (*dashes != '\0') attributes.emplace_back("stroke-dasharray", dashes);
  return line({{0.0, 0.0}}, {{sample_width, 0.0}}, attributes);
}

LegendEntry lumen_entry() {
  const Polyline box{{{0.0, -7.0}}, {{sample_width, -7.0}}, {{sample_width, 7.0}}, {{0.0, 7.0}}};
  std::string symbol = area({box}, {{"fill", style::lumen}});
  for (const double y : {-7.0, 7.0}) {
    symbol += line({{0.0, y}}, {{sample_width, y}}, {{"stroke", style::vessel}, {"stroke-width", style::wall_width}});
  }
  return {symbol + sample_line(style::vessel, style::centerline_width, ""), "vessel, State 2"};
}

LegendEntry reference_entry() {
  std::string symbol;
  for (const double y : {-7.0, 7.0}) {
    symbol += line(
        {{0.0, y}}, {{sample_width, y}},
        {{"stroke", style::state1}, {"stroke-width", style::wall_width}, {"stroke-dasharray", style::wall1_dashes}});
  }
  return {symbol + sample_line(style::state1, style::centerline_width, style::centerline1_dashes), "vessel, State 1"};
}

std::string force_text(double force) {
  const double digits = std::pow(10.0, 1.0 - std::floor(std::log10(force)));  // two of them
  return short_number(std::round(force * digits) / digits) + " N";
}

/// Circles of the largest force and of a quarter of it, which has half the radius.
LegendEntry contact_entry(double largest) {
  std::string symbol = open_group(contact_attributes());
  symbol += contact_symbol({{8.0, 0.0}}, style::contact_radius(0.25 * largest, largest));
  symbol += contact_symbol({{22.0, 0.0}}, style::contact_radius(largest, largest));
  return {symbol + close_group(),
          "contact, " + force_text(0.25 * largest) + " and " + force_text(largest) + ": area by force"};
}

std::vector<LegendEntry> entries(const Result& result) {
  std::vector<LegendEntry> out;
  const auto is_vessel = [](const ResultCurve& curve) { return !curve.wire; };
  if (std::any_of(result.curves.begin(), result.curves.end(), is_vessel)) {
    out.push_back(reference_entry());
    out.push_back(lumen_entry());
  }
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    if (!result.curves[i].wire) continue;
    const char* color = style::wire_color(result, static_cast<int>(i));
    out.push_back({sample_line(color, "2", ""), "wire " + result.curves[i].name});
  }
  if (const double largest = style::largest_force(result); largest > 0.0) out.push_back(contact_entry(largest));
  if (!result.supports.empty()) {
    out.push_back(
        {open_group(support_attributes()) + support_symbol({{0.5 * sample_width, -6.0}}, {{0.0, 1.0}}) + close_group(),
         "held end"});
  }
  return out;
}

std::string scale_bar(const Layout& layout, double y, double& right) {
  const double length = layout.scale_bar_mm * layout.panels.front().scale;
  const double left = page_margin;
  right = left + length;
  std::string out = open_group({{"id", "scale-bar"}, {"stroke", style::ink}, {"stroke-width", "1.6"}});
  out += line({{left, y}}, {{right, y}}, {{"class", "scale-bar"}});
  for (const double x : {left, right}) out += line({{x, y - bar_tick}}, {{x, y + bar_tick}});
  out += close_group();
  return out + text_at({{0.5 * (left + right), y - 8.0}}, short_number(layout.scale_bar_mm) + " mm", "middle");
}

}  // namespace

std::string draw_legend(const Result& result, const Layout& layout, double& height) {
  return draw_legend(entries(result), layout, height);
}

std::string draw_legend(const std::vector<LegendEntry>& entries, const Layout& layout, double& height) {
  double y = layout.bottom + 34.0;
  double x = 0.0;
  std::string out = open_group({{"id", "legend"}, {"fill", style::ink}, {"font-size", "12"}});
  out += scale_bar(layout, y, x);
  const double first_column = x + 2.0 * between_entries;
  x = first_column;
  for (const LegendEntry& entry : entries) {
    if (x > first_column && x + width(entry) > layout.width) {
      x = first_column;
      y += row_height;
    }
    out += open_group({{"transform", "translate(" + two_decimals(x) + " " + two_decimals(y) + ")"}}) + entry.symbol +
           text_at({{sample_width + 8.0, 4.0}}, entry.text) + close_group();
    x += width(entry);
  }
  height = y + row_height;
  return out + close_group();
}

}  // namespace bowstring
