#include "kinematics/nodes/nodes.hpp"
#include "plugins/sdk/plugin.hpp"

BOWSTRING_PLUGIN(bowstring::component<bowstring::Kinematics, bowstring::Nodes>(
    bowstring::Kind::kinematics, "nodes", "Node positions alone; a wire's edges keep their shares of its length"))
