#include "apps/number_table.hpp"

#include <cmath>

#include "apps/shell.hpp"

namespace bowstring::apps {

void print_row(std::FILE* to, const std::string& row) {
  std::fprintf(to, "%s\n", row.substr(0, row.find_last_not_of(' ') + 1).c_str());
}

std::string known_number(double value, int digits) { return std::isfinite(value) ? number(value, digits) : "unknown"; }

void print_number_table(std::FILE* to, const std::string& heading, const NumberColumns& columns,
                        const std::vector<NumberDifference>& numbers) {
  if (numbers.empty()) return;
  print_row(to, padded(heading, name_width) + padded_left(columns.first, number_width) +
                    padded_left(columns.second, number_width) + padded_left(columns.difference, difference_width) +
                    padded_left("relative", relative_width));
  for (const NumberDifference& one : numbers) {
    const bool known = std::isfinite(one.absolute());
    const bool same = known && one.absolute() == 0.0;
    const std::string absolute = same ? "same" : known ? number(one.absolute(), 3) : "";
    const std::string relative = same || !std::isfinite(one.relative()) ? "" : number(one.relative(), 2);
    print_row(to, padded("  " + one.path, name_width) + padded_left(known_number(one.a, 8), number_width) +
                      padded_left(known_number(one.b, 8), number_width) + padded_left(absolute, difference_width) +
                      padded_left(relative, relative_width));
  }
}

}  // namespace bowstring::apps
