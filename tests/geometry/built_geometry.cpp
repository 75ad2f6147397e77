#include "tests/geometry/built_geometry.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/composition/parameters.hpp"
#include "core/composition/toml_text.hpp"
#include "core/model/scene.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::testing {

double BuiltGeometry::edge(int first) const {
  double step[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < dimension; ++k) step[k] = at(first + 1, k) - at(first, k);
  return std::hypot(step[0], step[1], step[2]);
}

double BuiltGeometry::length() const {
  double sum = 0.0;
  for (int i = 0; i + 1 < nodes(); ++i) sum += edge(i);
  return sum;
}

namespace {

PluginHostOptions search() {
  PluginHostOptions options;
  const char* folders = std::getenv("BOWSTRING_PLUGIN_PATH");
  if (folders != nullptr) options.environment_path = folders;
  return options;
}

}  // namespace

BuiltGeometry build_geometry(const std::string& plugin, const std::string& toml, int dimension) {
  static PluginHost host(search());
  BuiltGeometry result;
  result.dimension = dimension;
  ComponentChoice choice;
  choice.kind = Kind::geometry;
  choice.name = plugin;
  choice.descriptor = host.find(Kind::geometry, plugin, result.status);
  if (choice.descriptor == nullptr) return result;

  Report report;
  const auto source = std::make_shared<const Source>(Source{"scene.toml", std::filesystem::current_path(), 0});
  const auto table = read_toml(toml, source, report);
  if (table) {
    const Span<const ParameterDeclaration> schema(choice.descriptor->parameters,
                                                  static_cast<std::size_t>(choice.descriptor->parameter_count));
    const SchemaOwner owner{"geometry '" + plugin + "'", "", {}, {}};
    choice.parameters = read_parameters(*table, owner, schema, result.status, report);
  }
  for (const InputError& error : report.sorted()) {
    result.status.code = Code::invalid_input;
    result.status.text += (result.status.text.empty() ? "" : "\n") + error.text();
  }
  if (!result.status.ok()) return result;

  const Owned<Geometry> geometry = create<Geometry>(choice, result.status);
  if (!result.status.ok()) return result;
  CurveGraph graph;
  result.status = geometry->build(dimension, graph);
  if (!result.status.ok()) return result;
  REQUIRE(graph.curves.size() == 1);
  result.curve = graph.curves.front();
  result.warnings = graph.warnings;
  return result;
}

BuiltGeometry built(const std::string& plugin, const std::string& toml, int dimension) {
  BuiltGeometry result = build_geometry(plugin, toml, dimension);
  REQUIRE_MESSAGE(result.status.ok(), result.status.text);
  return result;
}

double unevenness(const BuiltGeometry& geometry) {
  const int edges = geometry.nodes() - 1;
  const double mean = geometry.length() / edges;
  double largest = 0.0;
  for (int i = 0; i < edges; ++i) largest = std::max(largest, std::abs(geometry.edge(i) / mean - 1.0));
  return largest;
}

double tangent_error(const BuiltGeometry& geometry) {
  const int last = geometry.nodes() - 1;
  const double weight[4] = {-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0};
  const auto error = [&](int end, int step, const std::vector<double>& tangent) {
    REQUIRE(static_cast<int>(tangent.size()) == geometry.dimension);
    double slope[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < geometry.dimension; ++k) {
      for (int j = 0; j < 4; ++j) slope[k] += step * weight[j] * geometry.at(end + step * j, k);
    }
    const double norm = std::hypot(slope[0], slope[1], slope[2]);
    double square = 0.0;
    for (int k = 0; k < geometry.dimension; ++k) {
      square += std::pow(slope[k] / norm - tangent[static_cast<std::size_t>(k)], 2);
    }
    return std::sqrt(square);
  };
  return std::max(error(0, 1, geometry.curve.first_tangent), error(last, -1, geometry.curve.last_tangent));
}

}  // namespace bowstring::testing
