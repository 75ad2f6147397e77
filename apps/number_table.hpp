#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "core/compare/number_differences.hpp"

namespace bowstring::apps {

/// Widths of the columns of tables that compare: a name, two values, their difference, its relative size.
inline constexpr int name_width = 44, number_width = 15, difference_width = 13, relative_width = 11;

/// How the columns of a table are headed.
struct NumberColumns {
  const char *first, *second, *difference;
};

/// One line per number; nothing where there is none.
void print_number_table(std::FILE* to, const std::string& heading, const NumberColumns& columns,
                        const std::vector<NumberDifference>& numbers);

/// A line without the spaces at its end.
void print_row(std::FILE* to, const std::string& row);

/// A number with so many digits, or "unknown".
std::string known_number(double value, int digits);

}  // namespace bowstring::apps
