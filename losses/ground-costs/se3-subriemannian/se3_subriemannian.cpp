#include "../geodesics/geodesic_cost.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::geodesics;

constexpr ParameterDeclaration schema[] = {forward_weight, bend_weight, roll_weight};

class Se3Subriemannian final : public GeodesicCost {
 public:
  explicit Se3Subriemannian(const ParameterSet& set)
      : GeodesicCost({set.scalar("forward-weight"), 1.0, set.scalar("bend-weight"), set.scalar("roll-weight")}, false) {
  }
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::GroundCost, Se3Subriemannian>(
    bowstring::Kind::ground_cost, "se3-subriemannian",
    "Squared distance of frames that drive forward and backward, bend and roll, and do not move sideways", schema))
