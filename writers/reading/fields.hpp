#pragma once

#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/lie/so3.hpp"

/// What readers of documents have in common. They throw a StatusError with `invalid_input` that says where, what was
/// found and what was expected.
namespace bowstring::fields {

using Json = nlohmann::json;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& expected);

/// What stands there, for messages.
std::string found(const Json& value);

Json parse(const char* text);

/// A member, or null where the table has none.
const Json& member(const Json& table, const char* key);
/// A member that is text, or "".
std::string text(const Json& table, const char* key);

/// A number; not one where it is null.
double number(const Json& value, const std::string& where);
double number(const Json& table, const char* key, const std::string& where);

/// The entries of a list that may be left out.
const Json& list(const Json& table, const char* key, const std::string& where);

/// Points of 2 or 3 numbers, the third 0 in the plane.
Vector3 point(const Json& row, int dimension, const std::string& where);
std::vector<Vector3> points(const Json& table, const char* key, int dimension, const std::string& where);

}  // namespace bowstring::fields
