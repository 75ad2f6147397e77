#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;

namespace {

/// small_scene with one line more, at its end: in the table of the constraint.
std::string scene_with(const std::string& lines) { return test::small_scene + lines; }

Override wire_radius(const std::string& value) { return {"wire.w.radius", value}; }

}  // namespace

TEST_CASE("numbers are bare, or text with a unit") {
  Workbench bench;
  const auto radius = [&](const std::string& value) {
    return bench.loaded(test::small_scene, {wire_radius(value)}).wires[0].radius.profile.constant;
  };
  CHECK(radius("1") == 1.0);
  CHECK(radius("0.5") == 0.5);
  CHECK(radius("\"0.5 mm\"") == 0.5);
  CHECK(radius("6 Fr") == 2.0);
  CHECK(radius("0.035 in") == 0.889);
  CHECK(radius("0.05 cm") == 0.5);
  CHECK(radius("1 inch") == doctest::Approx(25.4));
}

TEST_CASE("the unit decides between alternatives") {
  Workbench bench;
  const auto stiffness = [&](const std::string& value) {
    const Composition scene = bench.loaded(test::small_scene, {{"energy.anchoring.stiffness", value}});
    return scene.energies[2].component.parameters.at("stiffness");
  };
  CHECK(stiffness("0.02 N/mm^2").unit_alternative == 0);
  CHECK(stiffness("0.02 N/mm").unit_alternative == 1);
  CHECK(stiffness("20 kPa").unit_alternative == 0);
  CHECK(stiffness("20 kPa").profile.constant == 0.02);
  CHECK(stiffness("20 N/m").unit_alternative == 1);
  CHECK(stiffness("20 N/m").profile.constant == 0.02);
}

TEST_CASE("a bare number is the alternative without a unit, where there is one") {
  Workbench bench;
  const auto window = [&](const std::string& value) {
    return bench.loaded(scene_with("window = " + value + "\n")).constraints[0].component.parameters.at("window");
  };
  CHECK(window("3").unit_alternative == 0);
  CHECK(window("3").number == 3.0);
  CHECK(window("\"1 cm\"").unit_alternative == 1);
  CHECK(window("\"1 cm\"").number == 10.0);
}

TEST_CASE("a profile is a value, a table, values by segment, or a column") {
  Workbench bench;
  const auto radius = [&](const std::string& value) {
    return bench.loaded(test::small_scene, {wire_radius(value)}).wires[0].radius.profile;
  };
  const Profile table = radius(R"({ table = [["0 mm", "0.5 mm"], ["10 cm", 0.25]], measured-from = "tip" })");
  CHECK(table.form == Profile::Form::table);
  CHECK(table.arc == std::vector<double>{0.0, 100.0});
  CHECK(table.value == std::vector<double>{0.5, 0.25});
  CHECK(table.measured_from == Profile::Origin::tip);
  CHECK(radius("{ table = [[0, 1]], measured-from = \"sheath\" }").measured_from == Profile::Origin::sheath);
  CHECK(radius("{ table = [[0, 1]] }").measured_from == Profile::Origin::first_end);

  const Profile segments = radius(R"({ segments = { cia = "5 mm", eia = "4 mm" } })");
  CHECK(segments.form == Profile::Form::segments);
  CHECK(segments.segment == std::vector<std::string>{"cia", "eia"});
  CHECK(segments.value == std::vector<double>{5.0, 4.0});

  const Profile column = radius(R"({ column = "radius_mm" })");
  CHECK(column.form == Profile::Form::column);
  CHECK(column.column == "radius_mm");
}

TEST_CASE("a factor scales the values of a profile") {
  Workbench bench;
  const auto values = [&](const std::string& value) {
    return bench.loaded(test::small_scene, {wire_radius(value)}).wires[0].radius.profile.value;
  };
  CHECK(values(R"({ table = [["0 mm", "0.5 mm"], ["10 cm", 0.25]], factor = 1.5 })") ==
        std::vector<double>{0.75, 0.375});
  CHECK(values(R"({ segments = { cia = "5 mm", eia = "4 mm" }, factor = 2 })") == std::vector<double>{10.0, 8.0});
}

TEST_CASE("lists of tables and vectors") {
  Workbench bench;
  const Composition scene = bench.loaded(R"(schema = 1
[scene]
dimension = 3
[[vessel]]
name = "v"
geometry = { type = "arcs", segments = [{ length = "60 mm" }, { length = "4 cm", bend = "90 deg" }], nodes = 30 }
[[energy]]
type = "point-load"
on = "v"
force = [0, "1 N", "500 mN"]
)");
  const std::vector<ParameterSet>& segments = scene.vessels[0].geometry.parameters.at("segments").items;
  REQUIRE(segments.size() == 2);
  CHECK(segments[0].scalar("bend") == 0.0);
  CHECK(segments[1].scalar("length") == 40.0);
  CHECK(segments[1].scalar("bend") == doctest::Approx(1.5707963267948966));
  CHECK(segments[1].at("bend").position == "scene.toml:6:89");
  CHECK(scene.energies[0].component.parameters.vector("force") == std::vector<double>{0.0, 1.0, 0.5});
}

TEST_CASE("ends are names or tables") {
  Workbench bench;
  const Composition scene = bench.loaded(
      test::small_scene,
      {{"wire.w.ends", R"(["held-edge", { type = "clamped", tangent = [1, 0.5] }])"}, {"vessel.v.rigid", "true"}});
  CHECK(scene.wires[0].end[0].type == "held-edge");
  CHECK(scene.wires[0].end[1].type == "clamped");
  CHECK(scene.wires[0].end[1].tangent == std::vector<double>{1.0, 0.5});
  CHECK(scene.wires[0].end[1].position ==
        "--set wire.w.ends=[\"held-edge\", { type = \"clamped\", tangent = [1, 0.5] }]");
  CHECK(scene.vessels[0].rigid);
}

TEST_CASE("kinematics are a name or a table with parameters") {
  Workbench bench;
  CHECK(bench.loaded(test::small_scene, {{"wire.w.kinematics", "nodes"}}).wires[0].kinematics.name == "nodes");
  const Composition scene =
      bench.loaded(test::small_scene, {{"wire.w.kinematics", R"({ type = "edge-frames", regularised = true })"}});
  CHECK(scene.wires[0].kinematics.parameters.flag("regularised"));
  CHECK_FALSE(scene.vessels[0].kinematics.parameters.flag("regularised"));
}
