#include "core/curve/arc_length.hpp"
#include "core/curve/placement.hpp"
#include "core/interfaces/geometry.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "length",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "length of the line",
     .lower = 0.0,
     .lower_exclusive = true},
    nodes_declaration,
    origin_declaration,
    rotation_declaration,
};

/// A straight line along +x, nodes uniform in arc length.
class Line final : public Geometry {
 public:
  explicit Line(const ParameterSet& parameters) : parameters_(parameters) {}

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      const int nodes = static_cast<int>(parameters_.integer("nodes"));
      LocalCurve curve;
      for (const double x : even_stations(parameters_.scalar("length"), nodes)) curve.points.push_back({{x, 0.0, 0.0}});
      return place(curve, parameters_, dimension, out);
    });
  }

 private:
  ParameterSet parameters_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Line>(bowstring::Kind::geometry, "line",
                                                                            "A straight line along +x",
                                                                            bowstring::schema))
