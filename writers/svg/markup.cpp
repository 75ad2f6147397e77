#include "writers/svg/markup.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bowstring {

namespace {

/// As printf's, with a decimal point in every locale.
std::string formatted(double value, std::chars_format format, int precision) {
  char buffer[400];  // the largest double has 309 digits before the point
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, format, precision);
  return std::string(buffer, end.ptr);
}

std::string pair(const Vector2& point) { return two_decimals(point[0]) + "," + two_decimals(point[1]); }

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + escaped(value) + "\"";
}

std::string attributes_text(const Attributes& attributes) {
  std::string out;
  for (const auto& [name, value] : attributes) out += attribute(name, value);
  return out;
}

std::string joined(const Polyline& points) {
  std::string out;
  for (const Vector2& point : points) out += (out.empty() ? "" : " ") + pair(point);
  return out;
}

/// Number of bytes that start a character of UTF-8.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

std::string two_decimals(double value) {
  if (!std::isfinite(value)) return "–";
  const std::string out = formatted(value, std::chars_format::fixed, 2);
  return out == "-0.00" ? "0.00" : out;
}

std::string short_number(double value, int digits) { return formatted(value, std::chars_format::general, digits); }

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> out;
  std::string row;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n\r\t", begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!row.empty() && characters(row) + 1 + characters(word) > columns) {
      out.push_back(row);
      row.clear();
    }
    if (!word.empty()) row += (row.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  if (!row.empty()) out.push_back(row);
  return out;
}

std::string element(const char* name, const Attributes& attributes) {
  return std::string("<") + name + attributes_text(attributes) + "/>\n";
}

std::string open_group(const Attributes& attributes) { return "<g" + attributes_text(attributes) + ">\n"; }

std::string close_group() { return "</g>\n"; }

std::string text_at(const Vector2& at, const std::string& text, const char* anchor) {
  std::string out = "<text" + attribute("x", two_decimals(at[0])) + attribute("y", two_decimals(at[1]));
  if (std::string(anchor) != "start") out += attribute("text-anchor", anchor);
  return out + ">" + escaped(text) + "</text>\n";
}

std::string line(const Vector2& from, const Vector2& to, const Attributes& more) {
  return "<line" + attribute("x1", two_decimals(from[0])) + attribute("y1", two_decimals(from[1])) +
         attribute("x2", two_decimals(to[0])) + attribute("y2", two_decimals(to[1])) + attributes_text(more) + "/>\n";
}

std::string circle(const Vector2& center, double radius, const Attributes& more) {
  return "<circle" + attribute("cx", two_decimals(center[0])) + attribute("cy", two_decimals(center[1])) +
         attribute("r", two_decimals(radius)) + attributes_text(more) + "/>\n";
}

std::string polyline(const Polyline& points, const Attributes& more) {
  if (points.size() < 2) return "";
  return "<polyline" + attributes_text(more) + attribute("points", joined(points)) + "/>\n";
}

std::string area(const std::vector<Polyline>& polygons, const Attributes& more) {
  std::string path;
  for (const Polyline& polygon : polygons) path += "M" + joined(polygon) + "Z";
  if (path.empty()) return "";
  return "<path" + attributes_text(more) + attribute("d", path) + "/>\n";
}

}  // namespace bowstring
