#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bowstring {

/// The candidates that `word` was probably meant to be, best first, at most three: those fewest letters away
/// (insertions, deletions, substitutions and swaps of neighbours: one for a short word, at most three for a long
/// one), or else those that have `word` as a part ("strain" of "vessel-strain"). Case, hyphen and underscore do not
/// count. Ties are in the order of `candidates`. Empty where nothing is near.
std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates);

/// "did you mean 'a'?", "did you mean 'a', 'b' or 'c'?"; "" without names.
std::string did_you_mean(const std::vector<std::string>& names);

/// "'a', 'b' or 'c'" for choices in a message.
std::string quoted_alternatives(const std::vector<std::string>& names);

/// "a; b; c" with "; " between.
std::string joined(const std::vector<std::string>& texts, const char* between);

/// "1 row", "2 rows".
std::string counted(int count, const std::string& singular);

/// "a, b, c".
std::string comma_separated(const std::vector<std::string>& names);

}  // namespace bowstring
