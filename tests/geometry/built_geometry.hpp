#pragma once

#include <string>
#include <vector>

#include "core/interfaces/geometry.hpp"

namespace bowstring::testing {

/// What a geometry plugin makes of the parameters that a composition would give it.
struct BuiltGeometry {
  Status status;  ///< with every error of the parameters, of the factory or of the geometry
  int dimension = 0;
  CurveGeometry curve;
  std::vector<std::string> warnings;

  int nodes() const { return static_cast<int>(curve.points.size()) / dimension; }
  /// Coordinate `axis` of a node.
  double at(int node, int axis) const { return curve.points[static_cast<std::size_t>(node * dimension + axis)]; }
  double edge(int first) const;
  /// Sum of the edges.
  double length() const;
};

/// Opens the plugin through the host, reads `toml` (the keys of the geometry's table) and builds.
BuiltGeometry build_geometry(const std::string& plugin, const std::string& toml, int dimension);

/// The same for what has to be right.
BuiltGeometry built(const std::string& plugin, const std::string& toml, int dimension);

/// Largest deviation of an edge from the mean edge, relative.
double unevenness(const BuiltGeometry& geometry);

/// Largest difference between the geometry's end tangents and those of the cubic through the four end nodes,
/// for nodes uniform in arc length or nearly so.
double tangent_error(const BuiltGeometry& geometry);

}  // namespace bowstring::testing
