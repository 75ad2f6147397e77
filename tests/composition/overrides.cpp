#include <doctest/doctest.h>

#include <filesystem>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;
using Texts = std::vector<std::string>;

namespace {

Texts errors_of(Workbench& bench, const std::string& path, const std::string& value) {
  return bench.errors(test::small_scene, {{path, value}});
}

}  // namespace

TEST_CASE("a path addresses tables by their key and entries by their name or else their type") {
  Workbench bench;
  const Composition scene = bench.loaded(test::small_scene, {{"wire.w.radius", "0.5"},
                                                             {"energy.axial-tension.tension", "20 N"},
                                                             {"vessel.v.geometry.nodes", "40"},
                                                             {"constraint.lumen.centerline", "polyline"},
                                                             {"constraint.node-wise-contact.window", "4"},
                                                             {"solver.tolerance", "1e-9"},
                                                             {"certificate.stationarity", "1 mN"},
                                                             {"scene.dimension", "3"},
                                                             {"title", "not quoted"}});
  CHECK(scene.wires[0].radius.profile.constant == 0.5);
  CHECK(scene.energies[1].component.parameters.scalar("tension") == 20.0);
  CHECK(scene.vessels[0].geometry.parameters.integer("nodes") == 40);
  CHECK(scene.constraints[0].component.parameters.text("centerline") == "polyline");
  CHECK(scene.constraints[0].component.parameters.scalar("window") == 4.0);
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-9);
  CHECK(scene.certificate.stationarity == 1e-3);
  CHECK(scene.dimension == 3);
  CHECK(scene.title == "not quoted");
}

TEST_CASE("an override replaces a whole table, and a named entry keeps its name") {
  Workbench bench;
  const Composition scene =
      bench.loaded(test::small_scene, {{"vessel.v.geometry", R"({ type = "csv", file = "a.csv" })"},
                                       {"wire.w", R"({ vessel = "v", radius = 1 })"},
                                       {"solver", R"({ type = "interior-point" })"}});
  CHECK(scene.vessels[0].geometry.name == "csv");
  CHECK(scene.wires[0].name == "w");
  CHECK(scene.wires[0].radius.profile.constant == 1.0);
  CHECK(scene.solver.name == "interior-point");
}

TEST_CASE("a plugin's name alone opens into a table, and ends are first and last") {
  Workbench bench;
  const Composition scene = bench.loaded(std::string(test::small_scene), {{"wire.w.kinematics", "edge-frames"},
                                                                          {"wire.w.kinematics.regularised", "true"},
                                                                          {"wire.w.ends.last", "clamped"},
                                                                          {"wire.w.ends.last.tangent", "[1, 0]"}});
  CHECK(scene.wires[0].kinematics.parameters.flag("regularised"));
  CHECK(scene.wires[0].end[0].type == "pinned");
  CHECK(scene.wires[0].end[1].type == "clamped");
  CHECK(scene.wires[0].end[1].tangent == std::vector<double>{1.0, 0.0});
}

TEST_CASE("a step may be written in quotes, as TOML writes keys") {
  Workbench bench;
  std::string text(test::small_scene);
  for (std::size_t at = text.find("\"w\""); at != std::string::npos; at = text.find("\"w\"")) {
    text.replace(at, 3, "\"w 018\"");
  }
  const Composition scene = bench.loaded(text, {{"wire.\"w 018\".radius", "0.5"}, {"'solver'.tolerance", "1e-9"}});
  CHECK(scene.wires[0].name == "w 018");
  CHECK(scene.wires[0].radius.profile.constant == 0.5);
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-9);
}

TEST_CASE("later overrides win") {
  Workbench bench;
  const Composition scene = bench.loaded(test::small_scene, {{"wire.w.radius", "0.5"}, {"wire.w.radius", "0.6"}});
  CHECK(scene.wires[0].radius.profile.constant == 0.6);
}

TEST_CASE("paths that lead nowhere") {
  Workbench bench;
  CHECK(errors_of(bench, "wire.v.radius", "1") ==
        Texts{"--set wire.v.radius=1: path 'wire.v.radius': no entry 'v' in 'wire'; expected one of: w; name an entry "
              "that the file has"});
  CHECK(errors_of(bench, "energy.axial-tention.tension", "1 N") ==
        Texts{"--set energy.axial-tention.tension=1 N: path 'energy.axial-tention.tension': no entry 'axial-tention' "
              "in 'energy'; expected one of: wire-bending, axial-tension, anchoring; did you mean 'axial-tension'?"});
  CHECK(errors_of(bench, "sovler.tolerance", "1") ==
        Texts{"--set sovler.tolerance=1: path 'sovler.tolerance': no table 'sovler'; expected one of: title, scene, "
              "vessel, wire, energy, constraint, loss, enforcement, solver, certificate, start, continuation, multistart, "
              "step; did you mean 'solver'?"});
  CHECK(errors_of(bench, "wire.w.radius.x.y", "1") ==
        Texts{"--set wire.w.radius.x.y=1: path 'wire.w.radius.x.y': 'wire.w.radius' is text \"0.4 mm\", not a table; "
              "expected a path that ends there; write 'wire.w.radius'"});
  CHECK(errors_of(bench, "wire..radius", "1") ==
        Texts{"--set wire..radius=1: path 'wire..radius': a step without a name; expected names with one dot between "
              "two of them; write it as in 'wire.lunderquist.radius'"});
  CHECK(errors_of(bench, "schema", "2") ==
        Texts{"--set schema=2: path 'schema': 'schema' is read before any override; expected one of: title, scene, "
              "vessel, wire, energy, constraint, loss, enforcement, solver, certificate, start, continuation, multistart, "
              "step; write it in the file itself"});
  CHECK(errors_of(bench, "residual.a.b", "2") ==
        Texts{"--set residual.a.b=2: path 'residual.a.b': 'residual' is not available in this version; expected one of: title, "
              "scene, vessel, wire, energy, constraint, loss, enforcement, solver, certificate, start, continuation, "
              "multistart, step; leave this override out"});
}

TEST_CASE("an ambiguous path names every entry that it fits") {
  Workbench bench;
  const std::string two = std::string(test::small_scene) + R"([[energy]]
name = "push"
type = "axial-tension"
on = "w"
tension = "1 N"
[[energy]]
name = "pull"
type = "axial-tension"
on = "w"
tension = "2 N"
)";
  const Composition scene =
      bench.loaded(two, {{"energy.pull.tension", "3 N"}, {"energy.axial-tension.tension", "4 N"}});
  CHECK(scene.energies[1].component.parameters.scalar("tension") == 4.0);
  CHECK(scene.energies[4].component.parameters.scalar("tension") == 3.0);

  const std::string named = std::string(two).replace(two.find("type = \"axial-tension\""), 0, "name = \"drag\"\n");
  CHECK(bench.errors(named, {{"energy.axial-tension.tension", "4 N"}}) ==
        Texts{"--set energy.axial-tension.tension=4 N: path 'energy.axial-tension.tension': 'axial-tension' fits 3 "
              "entries of 'energy': 'drag' at scene.toml:16:1, 'push' at scene.toml:29:1 and 'pull' at "
              "scene.toml:34:1; expected a path that fits one; use their names, and give each its own `name`"});
}

TEST_CASE("an override is checked like what stands in a file, at its own place") {
  Workbench bench;
  CHECK(errors_of(bench, "wire.w.raduis", "1") ==
        Texts{"--set wire.w.raduis=1: unknown key 'raduis' in wire 'w'; expected one of: name, vessel, geometry, ends, "
              "kinematics, span, spacing, nodes, radius, length; did you mean 'radius'?"});
  CHECK(errors_of(bench, "wire.w.radius", "0 mm") ==
        Texts{"--set wire.w.radius=0 mm: 'radius' of wire 'w' is 0 mm, out of bounds; expected more than 0 "
              "mm; write a larger number"});
  CHECK(errors_of(bench, "wire.w.radius", "[1, 2") ==
        Texts{"--set wire.w.radius=[1, 2: 'radius' of wire 'w' is text \"[1, 2\"; expected a quantity in mm, more "
              "than 0; write \"<number> mm\""});
}

TEST_CASE("files named on the command line are relative to the working directory") {
  Workbench bench;
  bench.write("deep/scene.toml", R"(schema = 1
[scene]
dimension = 3
[[vessel]]
name = "v"
geometry = { type = "csv", file = "data/a.csv" }
)");
  const auto file = [&](const std::vector<Override>& overrides) {
    const CompositionOutcome outcome = bench.load("deep/scene.toml", overrides);
    REQUIRE(outcome.composition.has_value());
    return outcome.composition->vessels[0].geometry.parameters.text("file");
  };
  CHECK(file({}) == (bench.folder() / "deep/data/a.csv").string());
  CHECK(file({{"vessel.v.geometry.file", "../b.csv"}}) == (bench.folder().parent_path() / "b.csv").string());
  CHECK(file({{"vessel.v.geometry", R"({ type = "csv", file = "c.csv" })"}}) == (bench.folder() / "c.csv").string());
  CHECK(file({{"vessel.v.geometry.file", "/d.csv"}}) == "/d.csv");
}
