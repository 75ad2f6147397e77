#pragma once

#include <optional>
#include <string>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "core/composition/value_range.hpp"

namespace bowstring {

/// Reads both ends. `owner`: "[continuation]", for messages. Empty where the report has got an error: ends of different
/// kinds or lengths, units that do not convert, equal ends, a logarithm of what has none.
std::optional<ValueRange> read_value_range(const Entry& from, const Entry& to, bool logarithmic,
                                           const std::string& owner, Report& report);

}  // namespace bowstring
