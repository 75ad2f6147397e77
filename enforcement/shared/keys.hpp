#pragma once

#include <string>
#include <vector>

#include "core/interfaces/parameter.hpp"

namespace bowstring::softening {

inline constexpr ParameterDeclaration on_key{
    .key = "on",
    .type = ParameterType::names,
    .unit = "",
    .default_text = "",
    .description =
        "constraints whose rows are taken, by their names, those of equality rows too; default: every "
        "inequality row of the scene"};

inline constexpr ParameterDeclaration first_weight_key{
    .key = "first-weight",
    .type = ParameterType::scalar,
    .unit = "N/mm",
    .default_text = "\"100 N/mm\"",
    .description =
        "stiffness of a row in the first of several solves: a soft one takes fewer iterations from cold, and "
        "one so soft that a wire leaves its lumen may tunnel",
    .lower = 0.0,
    .lower_exclusive = true};

/// Names of constraints; empty: every inequality row.
inline std::vector<std::string> named_constraints(const ParameterSet& parameters) {
  return parameters.has(on_key.key) ? parameters.names(on_key.key) : std::vector<std::string>{};
}

}  // namespace bowstring::softening
