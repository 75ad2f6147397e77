#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/lie/small_matrix.hpp"
#include "writers/svg/tube.hpp"

namespace bowstring {

/// Text for XML: markup characters escaped, control characters, which XML 1.0 has none of, as blanks.
std::string escaped(const std::string& text);

/// Two decimals; "–" for what is not finite.
std::string two_decimals(double value);

/// A number with at most so many significant digits and without trailing zeros: "20", "0.5".
std::string short_number(double value, int digits = 6);

/// The text in lines of at most `columns` characters, broken at blanks where it has any.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

using Attributes = std::vector<std::pair<const char*, std::string>>;

std::string element(const char* name, const Attributes& attributes);
std::string open_group(const Attributes& attributes);
std::string close_group();

/// Text whose baseline starts (or, with another `anchor`, has its middle or end) at `at`.
std::string text_at(const Vector2& at, const std::string& text, const char* anchor = "start");
std::string line(const Vector2& from, const Vector2& to, const Attributes& more = {});
std::string circle(const Vector2& center, double radius, const Attributes& more = {});
std::string polyline(const Polyline& points, const Attributes& more = {});
/// The union of polygons of one orientation.
std::string area(const std::vector<Polyline>& polygons, const Attributes& more = {});

}  // namespace bowstring
