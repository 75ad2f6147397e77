#include <cmath>
#include <string>

#include "core/curve/arc_length.hpp"
#include "core/curve/placement.hpp"
#include "core/interfaces/geometry.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr double two_pi = 6.283185307179586476925287;

constexpr ParameterDeclaration schema[] = {
    {.key = "chord",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "length along the axis",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "radius",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "distance from the axis",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "turns",
     .type = ParameterType::scalar,
     .unit = "",
     .default_text = "1.0",
     .description = "turns about the axis from end to end; positive is right-handed",
     .lower = -1e4,
     .upper = 1e4},
    nodes_declaration,
    origin_declaration,
    rotation_declaration,
};

/// p(t) = (chord t, r cos φ, r sin φ), φ = 2π turns t, t from 0 to 1: the local origin is on the axis, the
/// first node at (0, r, 0). Nodes uniform in t, and so in arc length.
class Helix final : public Geometry {
 public:
  explicit Helix(const ParameterSet& parameters) : parameters_(parameters) {}

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      if (dimension != 3) {
        return Status::failure(
            Code::invalid_input,
            "a helix in a scene of dimension " + std::to_string(dimension) +
                "; expected dimension 3; set dimension = 3 in [scene], or use a planar geometry such as "
                "'sinusoid'");
      }
      const double chord = parameters_.scalar("chord");
      const double radius = parameters_.scalar("radius");
      const double angle = two_pi * parameters_.scalar("turns");
      const double speed = std::hypot(chord, radius * angle);
      const auto tangent = [&](double phase) {
        return Vector3{
            {chord / speed, -radius * angle / speed * std::sin(phase), radius * angle / speed * std::cos(phase)}};
      };
      LocalCurve curve;
      for (const double t : even_stations(1.0, static_cast<int>(parameters_.integer("nodes")))) {
        curve.points.push_back({{chord * t, radius * std::cos(angle * t), radius * std::sin(angle * t)}});
      }
      curve.first_tangent = tangent(0.0);
      curve.last_tangent = tangent(angle);
      return place(curve, parameters_, dimension, out);
    });
  }

 private:
  ParameterSet parameters_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Helix>(
    bowstring::Kind::geometry, "helix", "A helix that winds about the x axis; its first node is at (0, radius, 0)",
    bowstring::schema))
