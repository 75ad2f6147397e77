#include "writers/svg/figure.hpp"

#include <cmath>

#include "writers/svg/markup.hpp"
#include "writers/svg/style.hpp"

namespace bowstring {

namespace {

constexpr double title_line = 22.0;
constexpr double text_line = 17.0;

/// What a reader wants to know before looking: the verdict and the main figures, as far as they are known.
std::string summary(const Result& result) {
  std::string out = result.status;
  if (result.status != "converged" && !result.reason.empty()) out += ": " + result.reason;
  const auto add = [&](const char* before, double value, int digits, const char* after) {
    if (std::isfinite(value)) out += (out.empty() ? "" : " · ") + (before + short_number(value, digits)) + after;
  };
  add("peak displacement ", result.peak_displacement, 4, " mm");
  if (result.contact_count > 0.0) {
    add("", result.contact_count, 9, result.contact_count == 1.0 ? " contact" : " contacts");
    add("contact force ", result.contact_force, 4, " N in all");
  }
  add("energy ", result.total_energy, 5, " N mm");
  return out;
}

std::string heading(const Result& result, double& y) {
  std::vector<std::string> notes = wrapped(summary(result), note_columns);
  const char* color = result.status == "converged" ? style::soft_ink : style::contact_fill;
  if (result.patient_axes) notes.emplace_back("axes: x to the patient's left, y to the back, z to the head");
  return draw_heading(wrapped(result.title, title_columns), notes, color, y);
}

}  // namespace

std::string draw_heading(const std::vector<std::string>& title, const std::vector<std::string>& notes,
                         const char* color, double& y) {
  std::string out;
  out += open_group({{"fill", style::ink}, {"font-size", "17"}, {"font-weight", "bold"}});
  for (const std::string& row : title) {
    y += title_line;
    out += text_at({{page_margin, y}}, row);
  }
  out += close_group();
  out += open_group({{"fill", color}, {"font-size", "12.5"}});
  for (const std::string& row : notes) {
    y += text_line;
    out += text_at({{page_margin, y}}, row);
  }
  return out + close_group();
}

std::string svg_page(const std::string& title, double width, double height, const std::string& drawing) {
  const std::string width_text = two_decimals(width), height_text = two_decimals(height);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"" +
         width_text + "\" height=\"" + height_text + "\" viewBox=\"0 0 " + width_text + " " + height_text +
         "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\">\n"
         "<title>" +
         escaped(title.empty() ? "Bowstring" : title) +
         "</title>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n" +
         drawing + "</svg>\n";
}

std::string svg_figure(const Result& result) {
  double y = heading_top;
  const std::string head = heading(result, y);
  const Layout layout = arrange(result, y + below_heading);
  double height = 0.0;
  const std::string body = draw_panels(result, layout) + draw_legend(result, layout, height);
  return svg_page(result.title, layout.width, height, head + body);
}

}  // namespace bowstring
