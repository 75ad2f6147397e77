#include "writers/reading/result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/sdk/guard.hpp"
#include "writers/reading/fields.hpp"

namespace bowstring {

namespace {

using fields::found;
using fields::list;
using fields::member;
using fields::number;
using fields::points;
using fields::refuse;
using fields::text;
using Json = nlohmann::json;

constexpr double not_a_number = fields::not_a_number;

void expect_nodes(std::size_t entries, std::size_t nodes, const std::string& where) {
  if (entries == nodes) return;
  refuse(where, std::to_string(entries) + " entries", std::to_string(nodes) + ", one per node");
}

std::vector<double> node_numbers(const Json& table, const char* key, std::size_t nodes, const std::string& where) {
  const Json& values = list(table, key, where + ".");
  if (values.empty()) return std::vector<double>(nodes, not_a_number);
  expect_nodes(values.size(), nodes, where + "." + key);
  std::vector<double> out;
  for (const Json& value : values) out.push_back(number(value, where + "." + key));
  return out;
}

/// Rows of `count` numbers, one per node; where the list is left out or empty, rows that are not numbers.
std::vector<std::vector<double>> node_rows(const Json& table, const char* key, std::size_t count, std::size_t nodes,
                                           const std::string& where) {
  const Json& rows = list(table, key, where + ".");
  if (rows.empty()) return {nodes, std::vector<double>(count, not_a_number)};
  expect_nodes(rows.size(), nodes, where + "." + key);
  std::vector<std::vector<double>> out;
  for (const Json& row : rows) {
    const std::string place = where + "." + key + "[" + std::to_string(out.size()) + "]";
    if (!row.is_array() || row.size() != count) {
      refuse(place, row.is_array() ? std::to_string(row.size()) + " numbers" : found(row),
             std::to_string(count) + " numbers");
    }
    out.emplace_back();
    for (const Json& value : row) out.back().push_back(number(value, place));
  }
  return out;
}

std::vector<Vector3> read_moment(const Json& table, int dimension, std::size_t nodes, const std::string& where) {
  std::vector<Vector3> out;
  if (dimension == 2) {
    for (const double moment : node_numbers(table, "moment_N_mm", nodes, where)) out.push_back({{0.0, 0.0, moment}});
    return out;
  }
  for (const auto& row : node_rows(table, "moment_N_mm", 3, nodes, where)) out.push_back(Vector3::load(row.data()));
  return out;
}

ResultCurve read_curve(const Json& table, int dimension, const std::string& where) {
  ResultCurve curve;
  curve.name = text(table, "name");
  const std::string kind = text(table, "kind");
  if (kind != "wire" && kind != "vessel")
    refuse(where + ".kind", found(member(table, "kind")), "\"wire\" or \"vessel\"");
  curve.wire = kind == "wire";
  curve.points = points(table, "points", dimension, where);
  curve.reference = points(table, "reference_points", dimension, where);
  const std::size_t nodes = curve.points.size();
  if (nodes == 0) refuse(where + ".points", "no point", "one per node");
  expect_nodes(curve.reference.size(), nodes, where + ".reference_points");
  curve.arc = node_numbers(table, "s_mm", nodes, where);
  curve.radius = node_numbers(table, "radius_mm", nodes, where);
  curve.curvature = node_numbers(table, "curvature_per_mm", nodes, where);
  curve.twist = node_numbers(table, "twist_per_mm", nodes, where);
  curve.moment = read_moment(table, dimension, nodes, where);
  for (const auto& row : node_rows(table, "frames", 4, nodes, where)) {
    curve.frames.push_back(lie::Rotation::load(row.data()));
  }
  return curve;
}

int read_dimension(const Json& curves) {
  const Json& rows = member(curves.front(), "points");
  if (!rows.is_array() || rows.empty()) refuse("curves[0].points", found(rows), "a list of points");
  const std::size_t size = rows.front().size();
  if (size != 2 && size != 3) {
    refuse("curves[0].points[0]", std::to_string(size) + " numbers", "2 in the plane, 3 in space");
  }
  return static_cast<int>(size);
}

int curve_index(const Result& result, const Json& table, const char* key, const std::string& where) {
  const std::string name = text(table, key);
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    if (result.curves[i].name == name) return static_cast<int>(i);
  }
  refuse(where + "." + key, found(member(table, key)), "the name of a curve of this document");
}

void read_curves(const Json& document, Result& out) {
  const Json& curves = list(document, "curves", "");
  if (curves.empty()) refuse("curves", "none", "at least one curve");
  out.dimension = read_dimension(curves);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    out.curves.push_back(read_curve(curves[i], out.dimension, "curves[" + std::to_string(i) + "]"));
  }
}

ResultContact read_contact(const Result& result, const Json& table, const std::string& where) {
  ResultContact contact;
  contact.wire = curve_index(result, table, "wire", where);
  contact.arc = number(table, "s_mm", where);
  contact.force = number(table, "force_N", where);
  contact.edge = number(table, "wire_edge", where);
  contact.part = number(table, "t", where);
  contact.gap = number(table, "gap_mm", where);
  const Json& direction = member(table, "direction");
  contact.direction = direction.is_null() ? Vector3{{not_a_number, not_a_number, not_a_number}}
                                          : fields::point(direction, result.dimension, where + ".direction");
  return contact;
}

void read_loads(const Json& document, Result& out) {
  const Json& contacts = list(document, "contacts", "");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    out.contacts.push_back(read_contact(out, contacts[i], "contacts[" + std::to_string(i) + "]"));
  }
  const Json& supports = list(document, "supports", "");
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const std::string where = "supports[" + std::to_string(i) + "]";
    out.supports.push_back({curve_index(out, supports[i], "on", where), text(supports[i], "end") == "last"});
  }
}

/// Geometries read from a file are in the patient's axes, and no others: the rest generate their shapes.
bool read_patient_axes(const Json& composition) {
  for (const Json& vessel : list(composition, "vessel", "composition.")) {
    if (text(member(vessel, "geometry"), "type") == "csv") return true;
  }
  return false;
}

}  // namespace

Result read_result(const char* json) {
  const Json document = fields::parse(json);
  if (text(document, "format") == "bowstring.transport/1") {
    throw StatusError(Code::unsupported,
                      "this writer takes results, and no comparison of measures; choose another, as svg, or --out");
  }
  if (text(document, "format") != "bowstring.result/1") {
    refuse("format", found(member(document, "format")), "\"bowstring.result/1\"");
  }
  Result out;
  const Json& composition = member(document, "composition");
  out.title = text(composition, "title");
  out.status = text(document, "status");
  out.reason = text(document, "reason");
  const Json& quantities = member(document, "quantities");
  out.peak_displacement = number(quantities, "peak_displacement_mm", "quantities");
  out.contact_count = number(quantities, "contact_count", "quantities");
  out.contact_force = number(quantities, "contact_force_N", "quantities");
  out.total_energy = number(member(document, "energy"), "total", "energy");
  read_curves(document, out);
  out.patient_axes = out.dimension == 3 && read_patient_axes(composition);
  read_loads(document, out);
  return out;
}

int nearest_node(const ResultCurve& curve, double arc) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < curve.nodes(); ++i) {
    const double distance = std::abs(curve.arc[static_cast<std::size_t>(i)] - arc);
    if (!(distance < least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

}  // namespace bowstring
