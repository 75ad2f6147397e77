#include "core/curve/placement.hpp"

#include <string>
#include <utility>

#include "core/lie/so3.hpp"

namespace bowstring {

namespace {

std::string wrong_count(const char* key, std::size_t found, std::size_t expected, int dimension, const char* mend) {
  return "'" + std::string(key) + "' has " + std::to_string(found) + (found == 1 ? " number" : " numbers") +
         "; expected " + std::to_string(expected) + " in a scene of dimension " + std::to_string(dimension) + "; " +
         mend;
}

}  // namespace

Status place(const LocalCurve& curve, const ParameterSet& parameters, int dimension, CurveGraph& out) {
  const bool planar = dimension == 2;
  const std::size_t d = static_cast<std::size_t>(dimension);
  Vector3 origin{};
  Vector3 rotation{};
  std::string errors;
  if (const ParameterValue* given = parameters.find("origin")) {
    if (given->vector.size() == d) {
      for (int k = 0; k < dimension; ++k) origin[k] = given->vector[static_cast<std::size_t>(k)];
    } else {
      errors = wrong_count("origin", given->vector.size(), d, dimension, "give one coordinate for each axis");
    }
  }
  if (const ParameterValue* given = parameters.find("rotation")) {
    const std::size_t expected = planar ? 1 : 3;
    if (given->vector.size() == expected) {
      rotation = planar ? Vector3{{0.0, 0.0, given->vector[0]}} : Vector3::load(given->vector.data());
    } else {
      errors += (errors.empty() ? "" : "\n") +
                wrong_count("rotation", given->vector.size(), expected, dimension,
                            planar ? "give the angle, as in [\"30 deg\"]"
                                   : "give a rotation vector: the axis times the angle, as in [0, 0, \"30 deg\"]");
    }
  }
  if (!errors.empty()) return Status::failure(Code::invalid_input, errors);

  CurveGeometry placed;
  placed.label = curve.label;
  placed.points.reserve(curve.points.size() * d);
  const lie::Rotation turn = lie::exp(rotation);
  const auto append = [dimension](const Vector3& v, std::vector<double>& numbers) {
    for (int k = 0; k < dimension; ++k) numbers.push_back(v[k]);
  };
  for (const Vector3& local : curve.points) append(origin + turn * local, placed.points);
  append(turn * curve.first_tangent, placed.first_tangent);
  append(turn * curve.last_tangent, placed.last_tangent);
  out.curves.push_back(std::move(placed));
  return {};
}

}  // namespace bowstring
