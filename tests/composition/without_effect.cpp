#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;
using Texts = std::vector<std::string>;

TEST_CASE("what acts on a scene is not called idle") {
  Workbench bench;
  CHECK(bench.loaded(test::small_scene).without_effect.empty());
}

TEST_CASE("a scene without constraints has no use for radii, an enforcement and the thresholds of rows") {
  Workbench bench;
  const std::string text = std::string(test::small_scene) +
                           "[enforcement]\ntype = \"kkt\"\n[certificate]\n"
                           "multiplier = -1e-7\nstationarity = 1e-5\n";
  CHECK(bench.loaded(text, {{"constraint", "[]"}}).without_effect ==
        Texts{"scene.toml:7:1: 'radius' of vessel 'v' has no effect: no constraint acts on it",
              "scene.toml:11:1: 'radius' of wire 'w' has no effect: no constraint acts on it",
              "scene.toml:28:1: [enforcement] has no effect: the scene has no constraint",
              "scene.toml:31:1: 'multiplier' of [certificate] has no effect: the scene has no constraint"});
}

TEST_CASE("a rigid vessel has no use for ends, kinematics and energies") {
  Workbench bench;
  CHECK(bench
            .loaded(test::small_scene, {{"vessel.v.rigid", "true"},
                                        {"vessel.v.ends", "[\"free\", \"free\"]"},
                                        {"vessel.v.kinematics", "nodes"}})
            .without_effect ==
        Texts{"--set vessel.v.ends=[\"free\", \"free\"]: 'ends' of vessel 'v' has no effect: a rigid vessel has no "
              "unknowns",
              "--set vessel.v.kinematics=nodes: 'kinematics' of vessel 'v' has no effect: a rigid vessel has no "
              "unknowns",
              "scene.toml:20:1: energy 'anchoring' has no effect: vessel 'v' is rigid and has no unknowns"});
}

TEST_CASE("only a clamped end holds a tangent") {
  Workbench bench;
  CHECK(bench.loaded(test::small_scene, {{"wire.w.ends.last.tangent", "[1, 0]"}}).without_effect ==
        Texts{"--set wire.w.ends.last.tangent=[1, 0]: 'tangent' of the last end of wire 'w' has no effect: an end "
              "that is pinned holds no tangent"});
  CHECK(bench.loaded(test::small_scene, {{"wire.w.ends.last.tangent", "[1, 0]"}, {"wire.w.ends.last.type", "clamped"}})
            .without_effect.empty());
}
