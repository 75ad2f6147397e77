#include "../geodesics/geodesic_cost.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::geodesics;

constexpr ParameterDeclaration schema[] = {forward_weight, lateral_weight, bend_weight, roll_weight};

class Se3Riemannian final : public GeodesicCost {
 public:
  explicit Se3Riemannian(const ParameterSet& set)
      : GeodesicCost({set.scalar("forward-weight"), set.scalar("lateral-weight"), set.scalar("bend-weight"),
                      set.scalar("roll-weight")},
                     true) {}
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::GroundCost, Se3Riemannian>(
    bowstring::Kind::ground_cost, "se3-riemannian",
    "Squared distance of frames in a left-invariant metric: forward, lateral, bend and roll weigh apart", schema))
