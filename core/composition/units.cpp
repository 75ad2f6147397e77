#include "core/composition/units.hpp"

#include <cctype>
#include <charconv>
#include <cstddef>
#include <utility>

#include "core/composition/common_units.hpp"

namespace bowstring {
namespace {

struct Spelling {
  std::string_view from, to;
};

constexpr Spelling spellings[] = {
    {"·", "*"}, {"⋅", "*"}, {"×", "*"}, {"µ", "u"}, {"μ", "u"}, {"°", "deg"}, {"−", "-"}, {"\t", " "},
};

constexpr Spelling superscripts[] = {
    {"⁻", "-"}, {"⁰", "0"}, {"¹", "1"}, {"²", "2"}, {"³", "3"}, {"⁴", "4"},
    {"⁵", "5"}, {"⁶", "6"}, {"⁷", "7"}, {"⁸", "8"}, {"⁹", "9"},
};

template <std::size_t count>
const Spelling* spelling_at(const Spelling (&table)[count], std::string_view text) {
  for (const Spelling& one : table) {
    if (text.substr(0, one.from.size()) == one.from) return &one;
  }
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// A further number at the front ("3 4 mm", "1/3 mm") is a slip; "1/mm" and "/mm" are units.
bool starts_with_number(std::string_view unit) {
  const auto digit_at = [&](std::size_t i) {
    return i < unit.size() && (std::isdigit(static_cast<unsigned char>(unit[i])) != 0);
  };
  if (unit.substr(0, 2) == "1/") return digit_at(2);
  if (unit.substr(0, 1) == "/") return digit_at(1);
  return digit_at(0) || unit.substr(0, 1) == "+" || unit.substr(0, 1) == "-" || unit.substr(0, 1) == ".";
}

}  // namespace

std::optional<Quantity> split_quantity(std::string_view text) {
  text = trimmed(text);
  if (text.substr(0, 1) == "+") text.remove_prefix(1);
  Quantity quantity;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), quantity.number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  quantity.unit = std::string(trimmed(text));
  return quantity;
}

std::string ascii_unit(std::string_view unit) {
  std::string result;
  bool raised = false;
  for (std::size_t i = 0; i < unit.size();) {
    const std::string_view rest = unit.substr(i);
    if (const Spelling* raise = spelling_at(superscripts, rest)) {
      result += raised ? "" : "^";
      result += raise->to;
      i += raise->from.size();
      raised = true;
      continue;
    }
    raised = false;
    if (const Spelling* other = spelling_at(spellings, rest)) {
      result += other->to;
      i += other->from.size();
    } else {
      result += unit[i++];
    }
  }
  const std::string_view plain = trimmed(result);
  return (plain.substr(0, 1) == "/" ? "1" : "") + std::string(plain);
}

UnitConversion convert_unit(std::string_view from, std::string_view to) {
  const std::string source = ascii_unit(from), target = ascii_unit(to);
  if (source == target) return {UnitOutcome::converted, 1.0, 1.0};
  if (starts_with_number(source)) return {UnitOutcome::unknown_unit, 1.0, 1.0};

  const auto wanted = target.empty() ? CommonUnit{} : read_common_unit(target);
  const auto given = read_common_unit(source);
  if (given && target.empty() && given->angle != 0) return {UnitOutcome::other_dimension, 1.0, 1.0};
  if (!given || !wanted) return convert_unit_by_udunits(source, target);
  if (given->length != wanted->length || given->force != wanted->force) {
    return {UnitOutcome::other_dimension, 1.0, 1.0};
  }
  return {UnitOutcome::converted, given->multiplier * wanted->divisor, given->divisor * wanted->multiplier};
}

}  // namespace bowstring
