#pragma once

#include <string>

#include "core/result/recorded_result.hpp"

namespace bowstring::testing {

/// A result document without flaws.
RecordedResult read_sound(const std::string& document);

}  // namespace bowstring::testing
