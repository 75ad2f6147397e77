#include "core/curve/csv_cells.hpp"

#include <cctype>
#include <charconv>

namespace bowstring::csv {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool is_passed_over(std::string_view line) { return trimmed(line).empty() || trimmed(line).front() == '#'; }

std::optional<double> as_number(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string joined(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : ",") + cell;
  if (text.size() <= 80) return text;
  std::size_t end = 77;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;  // no letter of UTF-8 is cut
  return text.substr(0, end) + "...";
}

std::string similar_column(const std::vector<std::string>& cells, char axis) {
  for (const std::string& cell : cells) {
    const bool axis_first = !cell.empty() && std::tolower(static_cast<unsigned char>(cell.front())) == axis;
    if (axis_first && (cell.size() == 1 || !std::isalpha(static_cast<unsigned char>(cell[1])))) return cell;
  }
  return {};
}

}  // namespace bowstring::csv
