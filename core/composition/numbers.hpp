#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

/// What a number has to be.
struct NumberRules {
  /// The declared unit's alternatives, as ParameterDeclaration states them; "" stands for a plain number.
  std::vector<std::string> units{""};
  double lower = -1e308, upper = 1e308;
  bool lower_exclusive = false;
  bool bare_means_first = false;  ///< a bare number is in the first unit even where there are others

  NumberRules() = default;
  explicit NumberRules(const ParameterDeclaration& declaration);
};

struct Number {
  double value = 0.0;  ///< in units[alternative]
  int alternative = 0;
};

/// Reads a bare number or a text with a unit and checks it. `subject` opens the messages: "'radius' of wire 'w'".
/// Empty where the report has got an error.
std::optional<Number> read_number(const Node& node, const std::string& subject, const NumberRules& rules,
                                  Report& report);

/// "a number", "a quantity in N/mm or N/mm^2, at least 0".
std::string expected_number(const NumberRules& rules);

/// How such a number is written: "<number>", "\"<number> N/mm\" or \"<number> N/mm^2\"".
std::string written_number(const NumberRules& rules, const std::string& number = "<number>");

/// "more than 0 mm and at most 1 mm"; "" without bounds.
std::string expected_bounds(double lower, double upper, bool lower_exclusive, const std::string& unit);

}  // namespace bowstring
