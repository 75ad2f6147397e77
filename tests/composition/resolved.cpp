#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "core/composition/resolved_toml.hpp"
#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;
using Json = nlohmann::ordered_json;

TEST_CASE("the resolved composition has every default, in a fixed order") {
  Workbench bench;
  CHECK(bench.loaded(test::small_scene).resolved_json ==
        R"({"schema":1,"title":"","scene":{"dimension":2},)"
        R"("vessel":[{"name":"v","geometry":{"type":"sinusoid","chord":150.0,"amplitude":25.0,"periods":1.0,)"
        R"("nodes":80,"sampling":"uniform-arc"},"radius":6.0,)"
        R"("kinematics":{"type":"edge-frames","regularised":false},"ends":["pinned","pinned"],"rigid":false}],)"
        R"("wire":[{"name":"w","vessel":"v","radius":0.4,)"
        R"("kinematics":{"type":"edge-frames","regularised":false},"ends":["pinned","pinned"]}],)"
        R"("energy":[{"name":"wire-bending","on":"w","type":"wire-bending","bending-stiffness":65.0},)"
        R"({"name":"axial-tension","on":"w","type":"axial-tension","tension":10.0},)"
        R"({"name":"anchoring","on":"v","type":"anchoring","stiffness":"0.01 N/mm^2"}],)"
        R"("constraint":[{"name":"lumen","on":["w","v"],"type":"node-wise-contact","centerline":"spline"}],)"
        R"("enforcement":{"type":"kkt"},"solver":{"type":"interior-point","tolerance":1e-08,"max-iterations":500},)"
        R"("certificate":{"stationarity":1e-06,"penetration":1e-08,"complementarity":1e-08,"multiplier":-1e-08,)"
        R"("minimum-stretch":0.2,"require":"none"}})");
}

TEST_CASE("numbers come back as the same doubles") {
  Workbench bench;
  const Composition scene = bench.loaded(test::small_scene, {{"wire.w.radius", "1 Fr"}, {"wire.w.nodes", "7"}});
  const Json resolved = Json::parse(scene.resolved_json);
  CHECK(resolved["wire"][0]["radius"].get<double>() == scene.wires[0].radius.profile.constant);
  CHECK(resolved["wire"][0]["radius"].get<double>() == 1.0 / 3.0);
  CHECK(resolved["wire"][0]["nodes"] == 7);
}

TEST_CASE("a resolved composition resolves to itself") {
  Workbench bench;
  bench.write("plugins/.keep", "");
  const std::string everything = R"(schema = 1
title = "all \"forms\" é"
plugin-path = "plugins"
[scene]
dimension = 3
[[vessel]]
name = "a"
geometry = { type = "arcs", segments = [{ length = "60 mm" }, { length = "4 cm", bend = "70 deg" }] }
radius = { column = "radius_mm" }
ends = [{ type = "clamped", tangent = [1, 2, 3] }, "free"]
[[vessel]]
name = "b"
geometry = { type = "csv", file = "b.csv", coordinates = "RAS" }
radius = { segments = { cia = "5 mm", "e i a" = "1 Fr" } }
kinematics = { type = "edge-frames", regularised = true }
rigid = true
[[wire]]
name = "w"
vessel = "a"
nodes = 33
radius = { table = [["0 mm", "0.035 in"], ["50 mm", "0.4 mm"]], measured-from = "tip" }
[[energy]]
name = "fat"
type = "anchoring"
on = "a"
stiffness = { table = [["0 mm", "20 kPa"], ["10 mm", "0.1 N/mm^2"]] }
[[energy]]
type = "point-load"
on = "w"
force = [0, "1 mN", "0.1 N"]
[[constraint]]
type = "segment-wise-contact"
on = ["w", "a"]
window = "1 cm"
[solver]
time-limit = "3 min"
[certificate]
multiplier = "-1 mN"
)";
  const std::string first = bench.loaded(everything).resolved_json;
  const std::string again = bench.loaded(resolved_toml(first)).resolved_json;
  CHECK(first.size() > 1000);
  CHECK(again == first);
  CHECK(bench.loaded(everything).resolved_json == first);
}
