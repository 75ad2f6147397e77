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

/// Names of constraints; empty: every inequality row.
inline std::vector<std::string> named_constraints(const ParameterSet& parameters) {
  return parameters.has(on_key.key) ? parameters.names(on_key.key) : std::vector<std::string>{};
}

}  // namespace bowstring::softening
