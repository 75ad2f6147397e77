#pragma once

#include <string>

#include "writers/reading/transport.hpp"
#include "writers/svg/layout.hpp"

namespace bowstring {

/// The drawings of all panels: walls, centerlines, wires, contacts, supports and axis triads.
std::string draw_panels(const Result& result, const Layout& layout);

/// A view's name and the global axes in it, left of its panel.
std::string caption(const Panel& panel, int axes);

/// A symbol drawn in a box `legend_symbol_width` wide around a baseline at y = 0, with its text.
struct LegendEntry {
  std::string symbol, text;
};
inline constexpr double legend_symbol_width = 30.0;  ///< px

/// Scale bar and these entries from `layout.bottom` on; `height` becomes that of the page.
std::string draw_legend(const std::vector<LegendEntry>& entries, const Layout& layout, double& height);

/// Scale bar, legend and notes from `layout.bottom` on; `height` becomes that of the page.
std::string draw_legend(const Result& result, const Layout& layout, double& height);

/// Lines in bold, and below them lines of notes in `color`, from `y` on, which moves below them.
std::string draw_heading(const std::vector<std::string>& title, const std::vector<std::string>& notes,
                         const char* color, double& y);

/// The whole file around its drawing.
std::string svg_page(const std::string& title, double width, double height, const std::string& drawing);

inline constexpr double heading_top = page_margin - 10.0;             ///< px, where a heading begins
inline constexpr double below_heading = 14.0;                         ///< px
inline constexpr std::size_t title_columns = 80, note_columns = 120;  ///< characters that fit on the page

/// Both measures, the first and second principal axis of all their places, and the plan's entries as lines.
std::string svg_figure(const TransportPicture& compared);

/// A self-contained SVG 1.1 document. Throws a StatusError with `invalid_input` where nothing can be drawn.
std::string svg_figure(const Result& result);

}  // namespace bowstring
