#include "core/model/declarations.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int most_values = 8;  // of a place's y
constexpr int most_width = 32;  // of its stencil

std::string counted(std::size_t count, const char* what) { return std::to_string(count) + " " + what; }

std::string flaw_of(const LawDescription& law, const ParameterSet& parameters) {
  for (const std::string& key : law.parameters) {
    const ParameterValue* value = parameters.find(key);
    if (value == nullptr) return "has a law that reads '" + key + "', which is not declared or has no value";
    if (value->type != ParameterType::profile && value->type != ParameterType::scalar) {
      return "has a law that reads '" + key + "', which is neither a profile nor a scalar";
    }
  }
  if (!law.weight.empty() && law.weight.size() != law.places.size()) {
    return "has a law with " + counted(law.weight.size(), "weights") + " for " + counted(law.places.size(), "places");
  }
  return "";
}

std::string flaw_of(const FieldDeclaration& field) {
  const std::string name = "field '" + field.name + "'";
  const auto numbers = at(field.count * coordinate_count(field.manifold, field.dimension));
  const int per_entry = tangent_count(field.manifold, field.dimension);
  const auto tangents = at(field.count * per_entry);
  if (field.reference.size() != numbers || field.start.size() != numbers) {
    return "declares " + name + " with coordinates that do not fit its count";
  }
  if (!field.fixed.empty() && field.fixed.size() != tangents) {
    return "declares " + name + " with 'fixed' flags that do not fit its count";
  }
  for (const std::vector<double>* bounds : {&field.lower, &field.upper}) {
    if (!bounds->empty() && bounds->size() != at(field.count)) {
      return "declares " + name + " with bounds that do not fit its count";
    }
  }
  if (!field.station.empty() && field.station.size() != at(field.count)) {
    return "declares " + name + " with arc coordinates that do not fit its count";
  }
  for (int i = 0; is_curved(field.manifold) && !field.fixed.empty() && i < field.count; ++i) {
    const auto first = field.fixed.begin() + i * per_entry;
    const auto free = std::count(first, first + per_entry, 0);
    if (free != 0 && free != per_entry) {
      return "holds entry " + std::to_string(i) + " of " + name +
             " in part; a rotation or direction is held as a whole";
    }
  }
  return "";
}

}  // namespace

std::string flaw_of(const CurveGeometry& geometry, int dimension) {
  const std::size_t numbers = geometry.points.size();
  if (numbers == 0 || numbers % at(dimension) != 0) {
    return "gives " + counted(numbers, "coordinates") + ", which are no points of dimension " +
           std::to_string(dimension);
  }
  const std::size_t nodes = numbers / at(dimension);
  for (const PointData& data : geometry.data) {
    if (data.value.size() == nodes) continue;
    return "gives " + counted(data.value.size(), "values") + " of '" + data.name + "' for " + counted(nodes, "nodes");
  }
  if (!geometry.label.empty() && geometry.label.size() != nodes) {
    return "gives " + counted(geometry.label.size(), "labels") + " for " + counted(nodes, "nodes");
  }
  for (const std::vector<double>* tangent : {&geometry.first_tangent, &geometry.last_tangent}) {
    if (tangent->empty() || tangent->size() == at(dimension)) continue;
    return "gives an end tangent of " + counted(tangent->size(), "numbers") + " in dimension " +
           std::to_string(dimension);
  }
  return "";
}

std::string flaw_of(const EnergyDeclaration& declaration, const ParameterSet& parameters) {
  if (declaration.laws.size() != declaration.descriptions.size()) {
    return "declares " + counted(declaration.laws.size(), "laws") + " with " +
           counted(declaration.descriptions.size(), "descriptions");
  }
  if (std::find(declaration.laws.begin(), declaration.laws.end(), nullptr) != declaration.laws.end()) {
    return "declares a law that is null";
  }
  for (const LawDescription& law : declaration.descriptions) {
    if (std::string flaw = flaw_of(law, parameters); !flaw.empty()) return flaw;
  }
  return "";
}

std::string flaw_of(const KinematicsDeclaration& declaration, int unknowns) {
  for (const FieldDeclaration& field : declaration.fields) {
    if (std::string flaw = flaw_of(field); !flaw.empty()) return flaw;
  }
  bool has_nodes = false;
  for (const SiteDeclaration& site : declaration.sites) {
    has_nodes = has_nodes || site.site == Site::node;
    const bool stencil_fits = site.stencil.size() == at(site.count * site.width);
    const bool known =
        std::all_of(site.stencil.begin(), site.stencil.end(), [&](int u) { return u >= -1 && u < unknowns; });
    if (!stencil_fits || !known || site.values > most_values || site.width > most_width) {
      return "declares a site whose stencil does not fit its unknowns";
    }
    if (site.bent_first < 0 || site.bent() < 0 || site.bent_first > site.width - site.bent()) {
      return "declares a site that bends in unknowns that its stencil does not have";
    }
  }
  return has_nodes ? "" : "declares no node positions";
}

std::string flaw_of(const RowDeclaration& rows) {
  const bool sizes_fit = rows.rows >= 0 && rows.lower.size() == at(rows.rows) && rows.upper.size() == at(rows.rows) &&
                         rows.place_begin.size() == at(rows.rows + 1);
  if (!sizes_fit) return "declares " + std::to_string(rows.rows) + " rows with bounds or places of another number";
  const bool places_fit = rows.place_begin.front() == 0 &&
                          rows.place_begin.back() == static_cast<int>(rows.places.size()) &&
                          std::is_sorted(rows.place_begin.begin(), rows.place_begin.end());
  if (!places_fit) return "declares rows whose places do not follow each other";
  for (int r = 0; r < rows.rows; ++r) {
    if (rows.lower[at(r)] <= rows.upper[at(r)]) continue;
    return "declares row " + std::to_string(r) + " with a lower bound that is not below its upper one";
  }
  return "";
}

std::string flaw_of(const SolverResult& result, const Problem& problem) {
  if (!result.q.empty() && result.q.size() != at(problem.coordinates())) {
    return "answers a state of " + counted(result.q.size(), "numbers") + " for " +
           std::to_string(problem.coordinates());
  }
  if (!result.multipliers.empty() && result.multipliers.size() != at(problem.rows())) {
    return "answers " + counted(result.multipliers.size(), "multipliers") + " for " +
           counted(at(problem.rows()), "rows");
  }
  const auto finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(result.q.begin(), result.q.end(), finite)) return "answers a state that is not finite";
  if (!std::all_of(result.multipliers.begin(), result.multipliers.end(), finite)) {
    return "answers a multiplier that is not finite";
  }
  return "";
}

}  // namespace bowstring
