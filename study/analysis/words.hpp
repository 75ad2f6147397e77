#pragma once

#include <string>
#include <vector>

namespace bowstring::study {

/// "9.75", "0.0031", "1.2e-07", "1234": so many significant digits, and all before the point.
std::string figure(double value, int digits = 3);
/// "12 %", "0.31 %" of a share.
std::string percent(double share);
/// "10…14 %", "12 %" where both read the same.
std::string percent_range(double low, double high);
/// "31 ms", "2.4 s", "310 s".
std::string seconds_text(double seconds);
/// "2.0", "1.98" of an order of convergence.
std::string order_text(double order, int decimals = 1);
/// "1.9…2.1", or one of them where both read the same.
std::string range_text(const std::string& low, const std::string& high);
/// "3 of 6".
std::string of_all(int count, int all);
/// "a; b; and 3 more." of so many that the first eight are enough; "" of none.
std::string listed(const std::vector<std::string>& parts);
/// "a", "a or b", "a, b or c".
std::string alternatives_text(const std::vector<std::string>& names);

/// Adds `clause` where the text then still has at most `limit` characters; whether it did.
bool add_clause(std::string& text, const std::string& clause, std::size_t limit);
/// Characters, not bytes, of UTF-8.
std::size_t characters(const std::string& text);

/// So long may a headline be, unless a part of it that cannot go is longer.
inline constexpr std::size_t headline_length = 160;

}  // namespace bowstring::study
