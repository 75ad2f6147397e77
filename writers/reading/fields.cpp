#include "writers/reading/fields.hpp"

#include <algorithm>
#include <cstring>

#include "plugins/sdk/guard.hpp"

namespace bowstring::fields {

namespace {

constexpr const char* mend = "; give the document as `bowstring` prints it with --json";

}  // namespace

void refuse(const std::string& where, const std::string& found, const std::string& expected) {
  throw StatusError(Code::invalid_input, where + ": found " + found + ", expected " + expected + mend);
}

std::string found(const Json& value) {
  return value.is_string() ? "\"" + value.get<std::string>() + "\"" : value.type_name();
}

Json parse(const char* text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const char* stop = text + std::min(error.byte > 0 ? error.byte - 1 : 0, std::strlen(text));
    const auto line = 1 + std::count(text, stop, '\n');
    const char* start = stop;
    while (start != text && start[-1] != '\n') --start;
    refuse("line " + std::to_string(line) + ", column " + std::to_string(stop - start + 1), "text that is not JSON",
           "a \"bowstring.result/1\" document");
  }
}

const Json& member(const Json& table, const char* key) {
  static const Json null;
  if (!table.is_object()) return null;
  const auto entry = table.find(key);
  return entry == table.end() ? null : *entry;
}

std::string text(const Json& table, const char* key) {
  const Json& value = member(table, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

double number(const Json& value, const std::string& where) {
  if (value.is_null()) return not_a_number;
  if (!value.is_number()) refuse(where, found(value), "a number or null");
  return value.get<double>();
}

double number(const Json& table, const char* key, const std::string& where) {
  return number(member(table, key), where + "." + key);
}

const Json& list(const Json& table, const char* key, const std::string& where) {
  static const Json none = Json::array();
  const Json& value = member(table, key);
  if (value.is_null()) return none;
  if (!value.is_array()) refuse(where + key, found(value), "a list");
  return value;
}

Vector3 point(const Json& row, int dimension, const std::string& where) {
  const auto expected = static_cast<std::size_t>(dimension);
  if (!row.is_array() || row.size() != expected) {
    refuse(where, row.is_array() ? std::to_string(row.size()) + " numbers" : found(row),
           std::to_string(dimension) + " numbers");
  }
  Vector3 out;
  for (int k = 0; k < dimension; ++k) out[k] = number(row[static_cast<std::size_t>(k)], where);
  return out;
}

std::vector<Vector3> points(const Json& table, const char* key, int dimension, const std::string& where) {
  const Json& rows = list(table, key, where + ".");
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.push_back(point(rows[i], dimension, where + "." + key + "[" + std::to_string(i) + "]"));
  }
  return out;
}

}  // namespace bowstring::fields
