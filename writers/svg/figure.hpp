#pragma once

#include <string>

#include "writers/svg/layout.hpp"

namespace bowstring {

/// The drawings of all panels: walls, centerlines, wires, contacts, supports and axis triads.
std::string draw_panels(const Result& result, const Layout& layout);

/// Scale bar, legend and notes from `layout.bottom` on; `height` becomes that of the page.
std::string draw_legend(const Result& result, const Layout& layout, double& height);

/// A self-contained SVG 1.1 document. Throws a StatusError with `invalid_input` where nothing can be drawn.
std::string svg_figure(const Result& result);

}  // namespace bowstring
