#pragma once

#include <string>

#include "core/composition/numbers.hpp"
#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

/// Reads a quantity along a curve: a value, { table = [[arc, value], …], measured-from = … }, { segments = { … } } or
/// { column = "…" }. All its values are in the same one of `rules.units`, the alternative that goes into `out`. What is
/// wrong goes into the report; answers whether nothing was.
bool read_profile(const Node& node, const std::string& subject, const NumberRules& rules, ParameterValue& out,
                  Report& report);

/// How a profile's table says where its arc coordinates count from: "tip", "sheath", or "" from the first end.
const char* origin_name(Profile::Origin origin) noexcept;

}  // namespace bowstring
