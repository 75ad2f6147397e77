#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What readers of comma-separated text have in common.
namespace bowstring::csv {

/// The text without blanks around it, and without quotes where it is in them.
std::string_view trimmed(std::string_view text);

/// The cells of a line, trimmed.
std::vector<std::string> cells_of(std::string_view line);

/// Whether a line holds nothing, or a comment: `#` and what follows it.
bool is_passed_over(std::string_view line);

/// The whole text as a number, "nan" and "inf" included, whatever the locale.
std::optional<double> as_number(std::string_view text);

/// The cells in a row, cut where they are too long for a message.
std::string joined(const std::vector<std::string>& cells);

/// The first of `cells` that was probably meant for that axis: "X", "x", "x (mm)"; "" where there is none.
std::string similar_column(const std::vector<std::string>& cells, char axis);

}  // namespace bowstring::csv
