#include "writers/svg/figure.hpp"

#include <cmath>

#include "writers/svg/markup.hpp"
#include "writers/svg/style.hpp"

namespace bowstring {

namespace {

constexpr double title_line = 22.0;
constexpr double text_line = 17.0;
constexpr std::size_t title_columns = 80;
constexpr std::size_t columns = 120;  // of the page, in the font of the notes

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
  std::string out;
  out += open_group({{"fill", style::ink}, {"font-size", "17"}, {"font-weight", "bold"}});
  for (const std::string& row : wrapped(result.title, title_columns)) {
    y += title_line;
    out += text_at({{page_margin, y}}, row);
  }
  out += close_group();
  const bool good = result.status == "converged";
  out += open_group({{"fill", good ? style::soft_ink : style::contact_fill}, {"font-size", "12.5"}});
  for (const std::string& row : wrapped(summary(result), columns)) {
    y += text_line;
    out += text_at({{page_margin, y}}, row);
  }
  if (result.patient_axes) {
    y += text_line;
    out += text_at({{page_margin, y}}, "axes: x to the patient's left, y to the back, z to the head");
  }
  return out + close_group();
}

}  // namespace

std::string svg_figure(const Result& result) {
  double y = page_margin - 10.0;
  const std::string head = heading(result, y);
  const Layout layout = arrange(result, y + 14.0);
  double height = 0.0;
  const std::string body = draw_panels(result, layout) + draw_legend(result, layout, height);
  const std::string width_text = two_decimals(layout.width), height_text = two_decimals(height);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"" +
         width_text + "\" height=\"" + height_text + "\" viewBox=\"0 0 " + width_text + " " + height_text +
         "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\">\n"
         "<title>" +
         escaped(result.title.empty() ? "Bowstring" : result.title) +
         "</title>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n" +
         head + body + "</svg>\n";
}

}  // namespace bowstring
