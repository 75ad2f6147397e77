#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "core/curve/arc_length.hpp"
#include "core/curve/bend_chain.hpp"
#include "core/curve/placement.hpp"
#include "core/interfaces/geometry.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr double full_turn = 6.283185307179586476925287;

constexpr ParameterDeclaration segment_schema[] = {
    {.key = "length",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = nullptr,
     .description = "arc length of the segment",
     .lower = 0.0,
     .lower_exclusive = true},
    {.key = "bend",
     .type = ParameterType::scalar,
     .unit = "rad",
     .default_text = "0.0",
     .description = "angle that the tangent turns along the segment; 0 is straight",
     .lower = -full_turn,
     .upper = full_turn},
    {.key = "plane",
     .type = ParameterType::scalar,
     .unit = "rad",
     .default_text = "0.0",
     .description = "direction of the bend about the tangent, from the +y of the start, carried along without twist, "
                    "toward +z",
     .lower = -full_turn,
     .upper = full_turn},
    {.key = "name",
     .type = ParameterType::text,
     .unit = "",
     .default_text = "",
     .description = "label of the segment's nodes, for profiles that give values by segment"},
};

constexpr ParameterDeclaration schema[] = {
    {.key = "segments",
     .type = ParameterType::list,
     .unit = "",
     .default_text = nullptr,
     .description = "the segments from the first end on",
     .items = segment_schema,
     .item_count = static_cast<int>(std::size(segment_schema))},
    nodes_declaration,
    origin_declaration,
    rotation_declaration,
};

std::string name_of(const ParameterSet& segment) {
  const ParameterValue* name = segment.find("name");
  return name == nullptr ? "" : name->text;
}

/// Straight pieces and bends one after the other, nodes uniform in arc length. See README.md.
class Arcs final : public Geometry {
 public:
  explicit Arcs(const ParameterSet& parameters) : parameters_(parameters) {
    if (parameters_.at("segments").items.empty()) {
      throw StatusError(Code::invalid_input,
                        "'segments' is empty; expected at least one segment; give one, as in segments = [{ "
                        "length = \"60 mm\" }, { length = \"40 mm\", bend = \"70 deg\" }]");
    }
  }

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      const std::vector<ParameterSet>& items = parameters_.at("segments").items;
      if (dimension == 2) check_planar(items);
      std::vector<BendSegment> segments;
      for (const ParameterSet& item : items) {
        segments.push_back({item.scalar("length"), item.scalar("bend"), item.scalar("plane")});
      }
      const BendChain chain(segments);
      const bool named =
          std::any_of(items.begin(), items.end(), [](const auto& item) { return !name_of(item).empty(); });
      LocalCurve curve;
      for (const double s : even_stations(chain.length(), static_cast<int>(parameters_.integer("nodes")))) {
        curve.points.push_back(chain.position(s));
        if (named) curve.label.push_back(name_of(items[chain.segment_at(s)]));
      }
      curve.last_tangent = chain.tangent(chain.length());
      return place(curve, parameters_, dimension, out);
    });
  }

 private:
  static void check_planar(const std::vector<ParameterSet>& items) {
    std::string errors;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].scalar("bend") == 0.0 || items[i].scalar("plane") == 0.0) continue;
      errors += (errors.empty() ? "" : "\n") + ("segment " + std::to_string(i + 1)) +
                " bends out of the plane ('plane' is not 0) in a scene of dimension 2; expected plane = 0; give "
                "'bend' a sign instead, positive toward +y, or set dimension = 3 in [scene]";
    }
    if (!errors.empty()) throw StatusError(Code::invalid_input, errors);
  }

  ParameterSet parameters_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Arcs>(
    bowstring::Kind::geometry, "arcs",
    "Straight pieces and bends one after the other, with curvature that rises and falls smoothly", bowstring::schema))
