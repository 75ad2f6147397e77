#pragma once

#include <string>
#include <vector>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// Reports every key of `table` that is not in `known`, with the nearest of them, or with `help` where none is near.
/// `owner` names the table: "energy 'anchoring'". Answers whether all were known.
bool check_keys(const Node& table, const std::string& owner, const std::vector<std::string>& known,
                const std::string& help, Report& report);

/// The same where the format has keys that this version does not take yet.
bool check_keys(const Node& table, const std::string& owner, const std::vector<std::string>& known,
                const std::vector<std::string>& later, const std::string& help, Report& report);

bool contains_name(const std::vector<std::string>& names, const std::string& name);

/// A table must be one: `[name]` where lists of tables and values are reported. `owner` as above.
bool check_is_table(const Node& node, const std::string& owner, const std::string& mend, Report& report);

}  // namespace bowstring
