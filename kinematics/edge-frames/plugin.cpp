#include "kinematics/edge-frames/edge_frames.hpp"
#include "plugins/sdk/plugin.hpp"

BOWSTRING_PLUGIN(bowstring::component<bowstring::Kinematics, bowstring::EdgeFrames>(
    bowstring::Kind::kinematics, "edge-frames",
    "Node positions and an orientation per straight edge; the internal force is the multiplier of the edge closure"))
