#include <algorithm>
#include <cmath>

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
    {.key = "amplitude",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "largest distance from the axis; positive bends toward +y first"},
    {.key = "periods",
     .type = ParameterType::scalar,
     .unit = "",
     .default_text = "1.0",
     .description = "number of periods between the ends",
     .lower = 0.0,
     .upper = 1e4,
     .lower_exclusive = true},
    {.key = "sampling",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"uniform-arc\"",
     .description = "nodes uniform in arc length, or in x as the preprint's planar case has them",
     .choices = "uniform-arc|uniform-x"},
    nodes_declaration,
    origin_declaration,
    rotation_declaration,
};

/// y = A sin kx in the plane z = 0, with k = 2π periods/chord.
class Sinusoid final : public Geometry {
 public:
  explicit Sinusoid(const ParameterSet& parameters) : parameters_(parameters) {}

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      const double chord = parameters_.scalar("chord");
      const double amplitude = parameters_.scalar("amplitude");
      const double periods = parameters_.scalar("periods");
      const double wave_number = two_pi * periods / chord;
      const int nodes = static_cast<int>(parameters_.integer("nodes"));
      const auto slope = [&](double x) { return amplitude * wave_number * std::cos(wave_number * x); };
      const auto tangent = [&](double x) {
        const double speed = std::hypot(1.0, slope(x));
        return Vector3{{1.0 / speed, slope(x) / speed, 0.0}};
      };

      std::vector<double> x = even_stations(chord, nodes);
      if (parameters_.text("sampling") == "uniform-arc") {
        const int panels = std::max(1, static_cast<int>(std::ceil(4.0 * periods)));
        const ArcLength arc([&](double at) { return std::hypot(1.0, slope(at)); }, even_stations(chord, panels + 1));
        x = arc.even_parameters(nodes);
      }
      LocalCurve curve;
      for (const double at : x) curve.points.push_back({{at, amplitude * std::sin(wave_number * at), 0.0}});
      curve.first_tangent = tangent(0.0);
      curve.last_tangent = tangent(chord);
      return place(curve, parameters_, dimension, out);
    });
  }

 private:
  ParameterSet parameters_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Sinusoid>(
    bowstring::Kind::geometry, "sinusoid", "A sinusoid about the x axis, in the plane z = 0", bowstring::schema))
