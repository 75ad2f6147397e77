#include <cmath>

#include "core/curve/arc_length.hpp"
#include "core/curve/placement.hpp"
#include "core/interfaces/geometry.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr double full_turn = 6.283185307179586476925287;

constexpr ParameterDeclaration schema[] = {
    {.key = "radius",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "radius of the circle",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "angle",
     .type = ParameterType::scalar,
     .unit = "rad",
     .default_text = nullptr,
     .description = "angle that the tangent turns from end to end; positive bends toward +y, negative toward -y",
     .lower = -full_turn,
     .upper = full_turn},
    nodes_declaration,
    origin_declaration,
    rotation_declaration,
};

/// An arc of a circle in the plane z = 0 that leaves the origin along +x, nodes uniform in arc length.
class Arc final : public Geometry {
 public:
  explicit Arc(const ParameterSet& parameters) : parameters_(parameters) {
    if (parameters_.scalar("angle") == 0.0) {
      throw StatusError(Code::invalid_input,
                        "'angle' is 0; expected an angle other than 0; give one, or use geometry 'line'");
    }
  }

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      const double radius = parameters_.scalar("radius");
      const double angle = parameters_.scalar("angle");
      const double side = std::copysign(1.0, angle);
      LocalCurve curve;
      for (const double turned : even_stations(std::abs(angle), static_cast<int>(parameters_.integer("nodes")))) {
        const double half_chord = radius * std::sin(0.5 * turned);
        curve.points.push_back({radius * std::sin(turned), side * 2.0 * half_chord * std::sin(0.5 * turned), 0.0});
      }
      curve.last_tangent = {{std::cos(angle), std::sin(angle), 0.0}};
      return place(curve, parameters_, dimension, out);
    });
  }

 private:
  ParameterSet parameters_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Arc>(
    bowstring::Kind::geometry, "arc", "An arc of a circle that leaves the origin along +x and bends toward +y",
    bowstring::schema))
