#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bowstring {

struct Node;

/// The tables of a composition: [[…]] and […].
const std::vector<std::string>& list_table_names();
const std::vector<std::string>& single_table_names();

/// Every key that may stand at the top of a composition, and those of them that an override's path may start with.
const std::vector<std::string>& top_level_names();
const std::vector<std::string>& overridable_names();

/// Tables of the format that this version does not take yet.
const std::vector<std::string>& later_table_names();

/// The name that paths and results call an entry of a list table by: its `name`, or else its `type`, or else the
/// table's own name (a wire without a name is 'wire').
std::string label_of(const Node& entry, std::string_view table);

}  // namespace bowstring
