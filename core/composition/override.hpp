#pragma once

#include <string>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// Puts `value` at the place that `path` addresses ("wire.lunderquist.radius"): tables by their key, entries of a
/// list by their `name` or else their `type`, the two `ends` also as `first` and `last`. The last step may be a key
/// that is not there yet; whether a schema declares it is checked later, with every other key. `path_position` is where
/// the path itself stands.
void apply_override(Node& root, const std::string& path, const Position& path_position, Node value, Report& report);

}  // namespace bowstring
