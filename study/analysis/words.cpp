#include "study/analysis/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/composition/nearest.hpp"

namespace bowstring::study {

namespace {

constexpr std::size_t most_listed = 8;

std::string formatted(const char* format, int digits, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, digits, value);
  return text;
}

}  // namespace

std::string figure(double value, int digits) {
  const bool longer = std::fabs(value) >= std::pow(10.0, digits) - 0.5;
  return longer && std::fabs(value) < 1e9 ? formatted("%.*f", 0, value) : formatted("%.*g", digits, value);
}

std::string percent(double share) { return figure(100.0 * share, 2) + " %"; }

std::string percent_range(double low, double high) {
  return range_text(figure(100.0 * low, 2), figure(100.0 * high, 2)) + " %";
}

std::string seconds_text(double seconds) {
  return seconds < 0.0995 ? figure(1000.0 * seconds, 2) + " ms" : figure(seconds, 2) + " s";
}

std::string order_text(double order, int decimals) { return formatted("%.*f", decimals, order); }

std::string range_text(const std::string& low, const std::string& high) { return low == high ? low : low + "…" + high; }

std::string of_all(int count, int all) { return std::to_string(count) + " of " + std::to_string(all); }

std::string listed(const std::vector<std::string>& parts) {
  if (parts.empty()) return "";
  const auto shown = std::min(parts.size(), most_listed);
  std::string out = joined({parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(shown)}, "; ");
  if (shown < parts.size()) out += "; and " + std::to_string(parts.size() - shown) + " more";
  return out + ".";
}

std::string alternatives_text(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) out += k + 1 < names.size() ? ", " : " or ";
    out += names[k];
  }
  return out;
}

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return count;
}

bool add_clause(std::string& text, const std::string& clause, std::size_t limit) {
  if (characters(text) + characters(clause) > limit) return false;
  text += clause;
  return true;
}

}  // namespace bowstring::study
