#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::texts;
using test::Workbench;
using Texts = std::vector<std::string>;

TEST_CASE("a composition overrides its base by path") {
  Workbench bench;
  bench.write("base.toml", test::small_scene);
  bench.write("more/derived.toml", R"(schema = 1
base = "../base.toml"
title = "derived"
[set]
"wire.w.radius" = "0.5 mm"
"vessel.v.geometry" = { type = "arcs", segments = [{ length = 150 }] }
"solver.tolerance" = 1e-9
[[energy]]
name = "pull"
type = "axial-tension"
on = "w"
tension = "1 N"
)");
  const CompositionOutcome outcome = bench.load("more/derived.toml", {{"energy.pull.tension", "2 N"}});
  REQUIRE(texts(outcome.errors) == Texts{});
  REQUIRE(outcome.composition.has_value());
  const Composition& scene = *outcome.composition;
  CHECK(scene.title == "derived");
  CHECK(scene.wires[0].radius.profile.constant == 0.5);
  CHECK(scene.wires[0].radius.position == "more/derived.toml:5:19");
  CHECK(scene.vessels[0].geometry.name == "arcs");
  CHECK(scene.vessels[0].position == "base.toml:4:1");
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-9);
  REQUIRE(scene.energies.size() == 4);
  CHECK(scene.energies[3].component.parameters.scalar("tension") == 2.0);
}

TEST_CASE("a chain of bases, each relative to its own file, the nearest to the user winning") {
  Workbench bench;
  bench.write("a/first.toml",
              "schema = 1\nplugin-path = \"plug\"\n[scene]\ndimension = 3\n[[vessel]]\nname = \"v\"\n"
              "geometry = { type = \"csv\", file = \"one.csv\" }\nradius = 5\n");
  bench.write("b/second.toml",
              "schema = 1\nbase = \"../a/first.toml\"\n[solver]\ntolerance = 1e-7\n"
              "max-iterations = 9\n[set]\n\"vessel.v.radius\" = 6\n");
  bench.write("third.toml",
              "schema = 1\nbase = \"b/second.toml\"\nplugin-path = [\"x\", \"/y\"]\n[solver]\n"
              "tolerance = 1e-6\n[set]\n\"vessel.v.geometry.coordinates\" = \"RAS\"\n");
  const CompositionOutcome outcome = bench.load("third.toml");
  REQUIRE(texts(outcome.errors) == Texts{});
  const Composition& scene = *outcome.composition;
  CHECK(scene.vessels[0].radius->profile.constant == 6.0);
  CHECK(scene.vessels[0].geometry.parameters.text("file") == (bench.folder() / "a/one.csv").string());
  CHECK(scene.vessels[0].geometry.parameters.text("coordinates") == "RAS");
  CHECK(scene.solver.parameters.scalar("tolerance") == 1e-6);
  CHECK(scene.solver.parameters.integer("max-iterations") == 9);
  CHECK(composition_plugin_path({"third.toml", {}}) ==
        Texts{(bench.folder() / "x").string(), "/y", (bench.folder() / "a/plug").string()});
  CHECK(composition_plugin_path({"absent.toml", {}}).empty());
}

TEST_CASE("an error in a base stands at its place in the base, before none of the user's own") {
  Workbench bench;
  bench.write("base.toml",
              "schema = 1\n[scene]\ndimension = 3\n[[vessel]]\nname = \"v\"\ncolour = 1\n"
              "geometry = { type = \"csv\", file = \"one.csv\" }\n");
  CHECK(bench.errors("schema = 1\nbase = \"base.toml\"\n[set]\n\"vessel.v.radius\" = \"0 mm\"\n"
                     "\"vessel.v.geometry.coordinates\" = \"RSA\"\n") ==
        Texts{"scene.toml:4:21: 'radius' of vessel 'v' is 0 mm, out of bounds; expected more than 0 mm; write "
              "a larger number",
              "scene.toml:5:35: 'coordinates' of geometry 'csv' of vessel 'v' is text \"RSA\"; expected 'LPS' or "
              "'RAS'; did you mean 'RAS'?",
              "base.toml:6:1: unknown key 'colour' in vessel 'v'; expected one of: name, geometry, ends, kinematics, "
              "radius, rigid; remove it"});
}

TEST_CASE("a path of [set] that fits nothing is reported where it stands") {
  Workbench bench;
  bench.write("base.toml", test::small_scene);
  CHECK(bench.errors("schema = 1\nbase = \"base.toml\"\n[set]\n\"wire.x.radius\" = 1\n") ==
        Texts{"scene.toml:4:1: path 'wire.x.radius': no entry 'x' in 'wire'; expected one of: w; name an entry that "
              "the file has"});
  CHECK(bench.errors("schema = 1\nbase = \"base.toml\"\n[set]\nwire.w.radius = 1\n") ==
        Texts{"scene.toml:4:1: 'wire' in [set] opens a table; expected a whole path in quotes, with a value or an "
              "inline table { … }; write it as in \"solver.tolerance\" = 1e-9"});
}

TEST_CASE("bases that go round, are missing, or are no text") {
  Workbench bench;
  bench.write("b.toml", "schema = 1\nbase = \"sub/../scene.toml\"\n");
  CHECK(bench.errors("schema = 1\nbase = \"b.toml\"\n") ==
        Texts{"b.toml:2:8: the bases go round in a circle: 'scene.toml' → 'b.toml' → 'scene.toml'; expected a chain "
              "of files that ends; take `base` out of one of them"});
  CHECK(bench.errors("schema = 1\nbase = \"scene.toml\"\n") ==
        Texts{"scene.toml:2:8: the bases go round in a circle: 'scene.toml' → 'scene.toml'; expected a chain of files "
              "that ends; take `base` out of one of them"});
  CHECK(bench.errors("schema = 1\nbase = \"none.toml\"\n") ==
        Texts{"scene.toml:2:8: cannot read the base 'none.toml' (No such file or directory); expected a composition in "
              "TOML; paths are relative to the file that they stand in"});
  CHECK(bench.errors("schema = 1\nbase = 3\n") ==
        Texts{"scene.toml:2:8: 'base' is whole number 3; expected a file; write base = \"other.toml\""});
}

TEST_CASE("an entry that a base has already is a duplicate") {
  Workbench bench;
  bench.write("base.toml", test::small_scene);
  CHECK(bench.errors("schema = 1\nbase = \"base.toml\"\n[[energy]]\ntype = \"axial-tension\"\non = \"w\"\n"
                     "tension = 1\n") ==
        Texts{"scene.toml:3:1: duplicate name: energy 'axial-tension', after the energy at base.toml:16:1; expected a "
              "name for each; add name = \"<name>\" to each"});
}
