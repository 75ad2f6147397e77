#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;

TEST_CASE("the documented composition loads, every number in mm, N and rad") {
  Workbench bench;
  const Composition scene = bench.loaded(test::planar_iliac);
  CHECK(scene.schema == 1);
  CHECK(scene.title == "Planar iliac with a Lunderquist wire");
  CHECK(scene.file == "scene.toml");
  CHECK(scene.dimension == 2);

  REQUIRE(scene.vessels.size() == 1);
  const VesselTable& vessel = scene.vessels[0];
  CHECK(vessel.name == "iliac");
  CHECK(vessel.position == "scene.toml:7:1");
  CHECK(vessel.geometry.name == "sinusoid");
  CHECK(vessel.geometry.position == "scene.toml:9:12");
  CHECK(vessel.geometry.parameters.scalar("chord") == 150.0);
  CHECK(vessel.geometry.parameters.scalar("amplitude") == 25.0);
  CHECK(vessel.geometry.parameters.integer("nodes") == 80);
  CHECK(vessel.geometry.parameters.text("sampling") == "uniform-x");
  CHECK_FALSE(vessel.geometry.parameters.has("origin"));
  REQUIRE(vessel.radius.has_value());
  CHECK(vessel.radius->profile.constant == 6.0);
  CHECK(vessel.kinematics.name == "edge-frames");
  CHECK(vessel.end[0].type == "pinned");
  CHECK_FALSE(vessel.rigid);

  REQUIRE(scene.wires.size() == 1);
  const WireTable& wire = scene.wires[0];
  CHECK(wire.name == "lunderquist");
  CHECK(wire.vessel == "iliac");
  CHECK(wire.nodes == 80);
  CHECK(wire.radius.profile.constant == 0.4445);
  CHECK_FALSE(wire.geometry.has_value());

  REQUIRE(scene.energies.size() == 4);
  CHECK(scene.energies[0].label == "wire-bending");
  CHECK(scene.energies[0].on == "lunderquist");
  CHECK(scene.energies[0].component.parameters.profile("bending-stiffness").constant == 65.0);
  CHECK(scene.energies[2].component.parameters.at("stiffness").unit_alternative == 1);
  CHECK(scene.energies[2].component.parameters.at("stiffness").position == "scene.toml:34:13");
  CHECK(scene.energies[3].component.parameters.scalar("tension") == 10.0);

  REQUIRE(scene.constraints.size() == 1);
  CHECK(scene.constraints[0].label == "lumen");
  CHECK(scene.constraints[0].on == std::vector<std::string>{"lunderquist", "iliac"});
  CHECK(scene.enforcement.name == "kkt");
  CHECK(scene.solver.name == "interior-point");
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-8);
  CHECK(scene.certificate.stationarity == 1e-5);
  CHECK(scene.certificate.require == "none");
  CHECK(scene.without_effect.empty());
}

TEST_CASE("only the plugins that a composition names are asked for") {
  Workbench bench;
  bench.loaded(test::planar_iliac);
  CHECK(bench.registry.opened ==
        std::vector<std::string>{"geometry/sinusoid", "kinematics/edge-frames", "energy/wire-bending",
                                 "energy/vessel-strain", "energy/anchoring", "energy/axial-tension",
                                 "constraint/node-wise-contact", "enforcement/kkt", "solver/interior-point"});
}

TEST_CASE("defaults stand where the file says nothing") {
  Workbench bench;
  const Composition scene = bench.loaded(test::small_scene);
  CHECK(scene.solver.name == "interior-point");
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-8);
  CHECK_FALSE(scene.solver.parameters.at("tolerance").given);
  CHECK(scene.solver.parameters.at("tolerance").position == "");
  CHECK_FALSE(scene.solver.parameters.has("time-limit"));
  CHECK(scene.enforcement.name == "kkt");
  CHECK(scene.wires[0].nodes == 0);
  CHECK(scene.wires[0].end[0].type == "pinned");
  CHECK(scene.wires[0].end[1].type == "pinned");
  CHECK(scene.constraints[0].component.parameters.text("centerline") == "spline");
  CHECK(scene.certificate.stationarity == 1e-6);
  CHECK(scene.certificate.penetration == 1e-8);
  CHECK(scene.certificate.complementarity == 1e-8);
  CHECK(scene.certificate.multiplier == -1e-8);
  CHECK(scene.certificate.minimum_stretch == 0.2);
}

TEST_CASE("a wire without a name is called wire") {
  Workbench bench;
  const Composition scene = bench.loaded(R"(schema = 1
scene = { dimension = 3 }
[[vessel]]
name = "v"
geometry = { type = "csv", file = "a.csv" }
[[wire]]
vessel = "v"
radius = 0.4
)",
                                         {{"wire.wire.radius", "0.5"}});
  CHECK(scene.wires[0].name == "wire");
  CHECK(scene.wires[0].radius.profile.constant == 0.5);
}
