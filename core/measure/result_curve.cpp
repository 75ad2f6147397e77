#include "core/measure/result_curve.hpp"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/composition.hpp"
#include "core/composition/json_words.hpp"
#include "core/composition/nearest.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// The numbers of `list`, each row of `columns` of them; empty where one is something else.
std::vector<double> numbers_of(const Json& list, std::size_t columns) {
  std::vector<double> out;
  if (!list.is_array()) return {};
  for (const Json& row : list) {
    if (columns == 1 && row.is_number()) {
      out.push_back(row.get<double>());
      continue;
    }
    if (columns == 1 || !row.is_array() || row.size() != columns) return {};
    for (const Json& entry : row) {
      if (!entry.is_number()) return {};
      out.push_back(entry.get<double>());
    }
  }
  return out;
}

const Json& member(const Json& table, const char* key) {
  static const Json none;
  const Json* found = table.is_object() ? find_key(table, key) : nullptr;
  return found != nullptr ? *found : none;
}

}  // namespace

std::optional<NodalCurve> read_result_curve(const std::string& text, const std::string& file, const std::string& curve,
                                            std::vector<InputError>& errors) {
  const auto refuse = [&](std::string found, std::string expected, std::string mend) {
    errors.push_back({file, std::move(found), std::move(expected), std::move(mend)});
    return std::nullopt;
  };
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::exception& error) {
    return refuse("it is no JSON (" + problem_of(error) + ")", written_by_solve, name_a_written_file);
  }
  const Json& format = member(document, "format");
  if (format != result_format) {
    return refuse(format.is_null() ? "JSON without 'format'" : "the format is " + shown(format),
                  "\"" + std::string(result_format) + "\"", name_a_written_file);
  }
  std::vector<std::string> names;
  const Json* found = nullptr;
  for (const Json& entry : member(document, "curves")) {
    names.push_back(text_of(entry, "name"));
    if (names.back() == curve) found = &entry;
  }
  if (found == nullptr) {
    const std::vector<std::string> near = nearest_names(curve, names);
    return refuse(curve.empty() ? "no curve of the document is named" : "the document has no curve '" + curve + "'",
                  names.empty() ? "a curve, but it has none" : "one of: " + comma_separated(names),
                  near.empty() ? "write " + file + "#" + (names.empty() ? "NAME" : names.front()) : did_you_mean(near));
  }
  const Json& rows = member(*found, "points");
  const std::size_t dimension = rows.is_array() && !rows.empty() && rows.front().is_array() ? rows.front().size() : 0;
  const std::vector<double> points =
      dimension == 2 || dimension == 3 ? numbers_of(rows, dimension) : std::vector<double>();
  if (points.empty()) {
    return refuse("the points of curve '" + curve + "' are not known", "two or three numbers for each node",
                  "look at the document's status and reason");
  }
  return nodal_curve(points, static_cast<int>(dimension), numbers_of(member(*found, "radius_mm"), 1));
}

}  // namespace bowstring
