#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::texts;
using test::Workbench;
using Texts = std::vector<std::string>;

namespace {

/// small_scene with a part of it written otherwise.
std::string scene_with(const std::string& part, const std::string& replacement) {
  std::string text = test::small_scene;
  const std::size_t place = text.find(part);
  REQUIRE(place != std::string::npos);
  return text.replace(place, part.size(), replacement);
}

}  // namespace

TEST_CASE("everything that is wrong with a file is said at once, in its order") {
  Workbench bench;
  CHECK(bench.errors(R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "iliac"
geometry = { type = "sinusoid", chord = "150 N", amplitude = nan, nodes = 2 }
radius = "6 mm"
[[wire]]
name = "iliac"
vessel = "ilac"
radius = 0
[[energy]]
type = "anchorin"
on = "iliac"
[[energy]]
type = "anchoring"
on = "iliac"
stiffness = 0.03
stifness = 0.03
[solver]
max-iterations = 2.5
)") == Texts{
           "scene.toml:6:41: wrong unit: 'chord' of geometry 'sinusoid' of vessel 'iliac' is text \"150 N\"; expected "
           "a quantity in mm, more than 0; write \"150 mm\"",
           "scene.toml:6:62: 'amplitude' of geometry 'sinusoid' of vessel 'iliac' is number nan, which is not finite; "
           "expected a finite number; write \"<number> mm\"",
           "scene.toml:6:75: 'nodes' of geometry 'sinusoid' of vessel 'iliac' is 2, out of bounds; expected at least "
           "3; write a larger number",
           "scene.toml:9:8: duplicate name: wire 'iliac', after the vessel at scene.toml:4:1; expected a name for "
           "each; rename one of the two",
           "scene.toml:10:10: unknown vessel 'ilac' in 'vessel' of wire 'iliac'; expected one of: iliac; did you "
           "mean 'iliac'?",
           "scene.toml:11:10: 'radius' of wire 'iliac' is 0, out of bounds; expected more than 0 mm; "
           "write a larger number",
           "scene.toml:13:8: unknown energy 'anchorin'; expected one of: anchoring, axial-tension, point-load, "
           "vessel-strain, wire-bending; did you mean 'anchoring'?",
           "scene.toml:18:13: ambiguous unit: 'stiffness' of energy 'anchoring' is the bare number 0.03; expected a "
           "quantity in N/mm^2 or N/mm; write \"0.03 N/mm^2\" or \"0.03 N/mm\", which mean different things",
           "scene.toml:19:1: unknown key 'stifness' in energy 'anchoring'; expected one of: type, name, on, "
           "stiffness; did you mean 'stiffness'?",
           "scene.toml:21:18: 'max-iterations' of solver 'interior-point' is number 2.5; expected a whole number, at "
           "least 1; "
           "write max-iterations = <whole number>",
       });
}

TEST_CASE("a file that cannot be read") {
  Workbench bench;
  CHECK(texts(bench.load("none.toml").errors) ==
        Texts{"none.toml: cannot read the file (No such file or directory); expected a composition in TOML; check the "
              "path"});
  bench.write("folder/x.toml", "");
  CHECK(texts(bench.load("folder").errors) ==
        Texts{"folder: cannot read the file (it is a folder); expected a composition in TOML; check the path"});
}

TEST_CASE("the first error of syntax, in the same form") {
  Workbench bench;
  CHECK(bench.errors("schema = 1\ntitle = \"a\nb\"\n").front().find("scene.toml:2:") == 0);
  CHECK(bench.errors("schema = 1\nradius = 10 N\n") ==
        Texts{"scene.toml:2:13: not TOML: expected a comment or whitespace, saw 'N'; expected valid TOML; mend this "
              "first: what stands behind it has not been read"});
  CHECK(bench.errors("schema = 1\n[solver]\n  tolerance = 1\n  tolerance = 2\n") ==
        Texts{"scene.toml:4:3: duplicate key 'tolerance'; expected each key once; remove one of the two"});
  CHECK(bench.errors("schema = 1\nx = { a = 1, b = 2, a = 3 }\n") ==
        Texts{"scene.toml:2:21: duplicate key 'a'; expected each key once; remove one of the two"});
  CHECK(bench.errors("schema = 1\n[solver]\n[solver]\n").front() ==
        "scene.toml:3:1: duplicate key 'solver'; expected each key once; remove one of the two");
}

TEST_CASE("a table whose name begins with a letter that needs quotes") {
  Workbench bench;
  CHECK(bench.errors("schema = 1\n[[@x]]\n").front() ==
        "scene.toml:2:3: not TOML: expected bare key starting character or string delimiter, saw '@'; expected valid "
        "TOML; mend this first: what stands behind it has not been read");
  CHECK(bench.errors("schema = 1\n[é]\n").front().find("scene.toml:2:2: not TOML: ") == 0);
}

TEST_CASE("a long text is shown in part, and no letter of it is cut") {
  Workbench bench;
  std::string title, shown = "\"x";
  for (int i = 0; i < 60; ++i) title += "é";
  for (int i = 0; i < 39; ++i) shown += "é";
  const std::vector<std::string> errors = bench.errors(scene_with("dimension = 2", "dimension = \"x" + title + "\""));
  REQUIRE(!errors.empty());
  CHECK(errors.front().find(shown + "…\"") != std::string::npos);
}

TEST_CASE("an empty file lacks everything that has no default") {
  Workbench bench;
  CHECK(bench.errors("") ==
        Texts{"scene.toml:1:1: the file has no 'schema'; expected the version of the format that it is written in; add "
              "schema = 1 at the top",
              "scene.toml:1:1: the file has no [scene]; expected a table with the scene's dimension; add [scene] with "
              "dimension = 2 or dimension = 3",
              "scene.toml:1:1: the scene has no curve; expected a [[vessel]]; add [[vessel]] with name and geometry"});
}

TEST_CASE("keys that a table must have") {
  Workbench bench;
  CHECK(bench.errors("schema = 1\n[scene]\n[[vessel]]\n[[wire]]\n[[energy]]\ntype = \"anchoring\"\n[[energy]]\n"
                     "[[constraint]]\ntype = \"node-wise-contact\"\n") ==
        Texts{"scene.toml:2:1: [scene] has no 'dimension'; expected 2 or 3; add dimension = 2 or dimension = 3",
              "scene.toml:3:1: a vessel without a name; expected every vessel to have one; add name = \"<name>\"",
              "scene.toml:3:1: a vessel without a name has no 'geometry'; expected a table with the 'type' of a "
              "geometry; add geometry = { type = \"<geometry>\", … }",
              "scene.toml:4:1: wire 'wire' has no 'radius'; expected a quantity in mm, more than 0, or a table with "
              "'table', 'segments' or 'column'; add radius = \"<number> mm\"",
              "scene.toml:4:1: wire 'wire' has no 'vessel' and no 'geometry'; expected the vessel that the wire starts "
              "along, or a geometry of its own; add vessel = \"<name>\", or geometry = { type = \"<geometry>\", … }",
              "scene.toml:5:1: energy 'anchoring' has no 'on'; expected the curve that it acts on; add on = "
              "\"<curve>\"",
              "scene.toml:5:1: energy 'anchoring' has no 'stiffness'; expected a quantity in N/mm^2 or N/mm, at least "
              "0, or a table with 'table', 'segments' or 'column'; add stiffness = \"<number> N/mm^2\" or \"<number> "
              "N/mm\"",
              "scene.toml:7:1: energy 'energy' has no 'on'; expected the curve that it acts on; add on = \"<curve>\"",
              "scene.toml:7:1: energy 'energy' has no 'type'; expected one of: anchoring, axial-tension, point-load, "
              "vessel-strain, wire-bending; add type = \"<energy>\"",
              "scene.toml:8:1: constraint 'node-wise-contact' has no 'on'; expected a list of curves, for contact "
              "[wire, vessel]; add on = [\"<wire>\", \"<vessel>\"]"});
}

TEST_CASE("what belongs to a later version is said to") {
  Workbench bench;
  const std::string text = std::string(test::small_scene) + "[[residual]]\n";
  const std::string tables =
      "expected one of: schema, title, base, plugin-path, set, scene, vessel, wire, energy, "
      "constraint, loss, enforcement, solver, certificate, start, continuation, multistart, step; remove it";
  CHECK(bench.errors(text) ==
        Texts{"scene.toml:28:3: key 'residual' in the composition is not available in this version; " + tables});
}

TEST_CASE("a start names a result document that can be read") {
  Workbench bench;
  const auto errors = [&](const std::string& table) { return bench.errors(std::string(test::small_scene) + table); };
  const std::string document = "a result document, as `bowstring solve --out` writes it; ";
  CHECK(errors("[start]\n") ==
        Texts{"scene.toml:28:1: [start] has no 'from'; expected a result document to start from; add from = "
              "\"result.json\", or remove the table"});
  CHECK(
      errors("[start]\nfrom = 3\n") ==
      Texts{"scene.toml:29:8: 'from' of [start] is whole number 3; expected text, the path of a result document; write "
            "from = \"result.json\""});
  CHECK(errors("[start]\nfrom = \"none.json\"\nrest = \"before\"\n") ==
        Texts{"scene.toml:29:8: cannot read the start 'none.json' (No such file or directory); expected " + document +
                  "paths are relative to the file that they stand in",
              "scene.toml:30:8: 'rest' of [start] is text \"before\"; expected one of: state-1, previous; write rest = "
              "\"previous\" where the state that it starts from is without stress in the vessels"});
  CHECK(errors("[start]\nrest = \"previous\"\n") ==
        Texts{"scene.toml:28:1: [start] has no 'from'; expected a result document to start from; add from = "
              "\"result.json\", or remove the table"});
  CHECK(bench.errors(test::small_scene, {{"start.from", "none.json"}}) ==
        Texts{"--set start.from=none.json: cannot read the start 'none.json' (No such file or directory); expected " +
              document + "paths of --set are relative to the working directory"});
  bench.write("results/a.json", R"({"format": "bowstring.result/1", "state": {"fields": {"v.position": [1, 2]},
                                    "multipliers": {}}, "problem": {"fields": [{"name": "v.position", "manifold": "R"}]}})");
  const Composition composition = bench.loaded(std::string(test::small_scene) + "[start]\nfrom = \"results/a.json\"\n");
  CHECK(composition.start.from == (bench.folder() / "results/a.json").string());
  REQUIRE(composition.start.state != nullptr);
  REQUIRE(composition.start.state->fields.size() == 1);
  CHECK(composition.start.state->fields[0].manifold == "R");
  CHECK(composition.start.state->fields[0].values == std::vector<double>{1.0, 2.0});
  CHECK(composition.input_files.back() == composition.start.from);
  CHECK(composition.resolved_json.find("\"start\":{\"from\":\"" + composition.start.from +
                                       "\",\"rest\":\"state-1\"}") != std::string::npos);
  CHECK_FALSE(composition.start.rest_is_previous);
  CHECK(bench.loaded(std::string(test::small_scene) + "[start]\nfrom = \"results/a.json\"\nrest = \"previous\"\n")
            .start.rest_is_previous);
}

TEST_CASE("a wire with a geometry of its own takes that geometry's nodes, and needs no vessel") {
  Workbench bench;
  const std::string rod = "geometry = { type = \"csv\", file = \"a.csv\" }\n";
  CHECK(bench.loaded(scene_with("vessel = \"v\"\n", rod), {}).wires[0].geometry->name == "csv");
  CHECK(bench.errors(scene_with("vessel = \"v\"\n", rod + "nodes = 20\n")) ==
        Texts{"scene.toml:11:9: 'nodes' of wire 'w' beside a geometry of its own; expected the nodes of that geometry; "
              "write them as 'nodes' of the geometry"});
  CHECK(bench.errors(test::small_scene, {{"wire.w.length", "slidin"}}) ==
        Texts{"--set wire.w.length=slidin: 'length' of wire 'w' is text \"slidin\"; expected 'sliding' or 'fixed'; did "
              "you mean 'sliding'?"});
}

TEST_CASE("a move is a displacement of an end that is held") {
  Workbench bench;
  const auto error = [&](const std::string& end) {
    const Texts all = bench.errors(test::small_scene, {{"wire.w.ends", "[" + end + ", \"pinned\"]"}});
    REQUIRE(all.size() == 1);
    return all[0].substr(all[0].find("]: ") + 3);
  };
  CHECK(error("{ type = \"free\", move = [1, 0] }") ==
        "'move' of the first end of wire 'w', which is free; expected an end whose position is held; hold it, as in "
        "type = "
        "\"pinned\"");
  CHECK(error("{ type = \"pinned\", move = [1, 0, 0] }") ==
        "'move' of the first end of wire 'w' has 3 entries; expected a list of as many numbers as the scene has "
        "dimensions; write the displacement from State 1, one number per axis");
  CHECK(error("{ type = \"pinned\", move = [\"1 N\", 0] }") ==
        "wrong unit: an entry of 'move' of the first end of wire 'w' is text \"1 N\"; expected a quantity in mm; write "
        "\"1 mm\"");
  const Composition scene =
      bench.loaded(test::small_scene, {{"wire.w.ends", "[{ type = \"pinned\", move = [\"1 cm\", 0] }, \"pinned\"]"}});
  CHECK(scene.wires[0].end[0].move == std::vector<double>{10.0, 0.0});
}

TEST_CASE("what `converged` demands: a minimum, and thresholds in their bounds") {
  Workbench bench;
  CHECK(bench.loaded(test::small_scene, {{"certificate.require", "minimum"}}).certificate.require == "minimum");
  CHECK(bench.errors(test::small_scene, {{"certificate.require", "maximum"}}) ==
        Texts{"--set certificate.require=maximum: 'require' of [certificate] is text \"maximum\"; expected 'none' or "
              "'minimum'; did you mean 'minimum'?"});
  CHECK(bench.errors(test::small_scene, {{"certificate.multiplier", "1 N"}}) ==
        Texts{"--set certificate.multiplier=1 N: 'multiplier' of [certificate] is 1 N, out of bounds; "
              "expected at most 0 N; write a smaller number"});
}

TEST_CASE("tables and lists of tables in each other's place") {
  Workbench bench;
  CHECK(bench.errors("schema = 1\n[scene]\ndimension = 3\n[vessel]\nname = \"v\"\n[[solver]]\n") ==
        Texts{"scene.toml:4:1: 'vessel' is a table; expected a list of tables; write [[vessel]]",
              "scene.toml:6:1: 'solver' is a list; expected a table; write [solver] with type = \"interior-point\""});
  CHECK(bench.errors("schema = 2\ntitle = 1\nscene = { dimension = 4, dimensions = 2 }\nvessel = [1]\n") ==
        Texts{"scene.toml:1:10: 'schema' is whole number 2; expected 1; write schema = 1; this version reads no other",
              "scene.toml:2:9: 'title' is whole number 1; expected text; write it in quotes",
              "scene.toml:3:23: 'dimension' of [scene] is whole number 4; expected 2 or 3; write dimension = 2 or "
              "dimension = 3",
              "scene.toml:3:26: unknown key 'dimensions' in [scene]; expected one of: dimension; did you mean "
              "'dimension'?",
              "scene.toml:4:11: a vessel without a name is whole number 1; expected a table; write it under "
              "[[vessel]]"});
}

TEST_CASE("references to curves") {
  Workbench bench;
  CHECK(bench.errors(scene_with("vessel = \"v\"", "vessel = \"w\"")) ==
        Texts{"scene.toml:10:10: unknown vessel 'w' in 'vessel' of wire 'w'; expected one of: v; 'w' is a wire"});
  CHECK(bench.errors(scene_with("on = \"v\"", "on = [\"v\"]")) ==
        Texts{"scene.toml:22:6: 'on' of energy 'anchoring' is a list; expected the name of a curve; write it in "
              "quotes"});
  CHECK(bench.errors(scene_with("[\"w\", \"v\"]", "[\"v\", \"w\"]")) ==
        Texts{"scene.toml:27:6: 'on' of constraint 'lumen' has the vessel first; expected [wire, vessel]; write on = "
              "[\"w\", \"v\"]"});
  CHECK(bench.errors(scene_with("[\"w\", \"v\"]", "[\"w\", \"u\"]")) ==
        Texts{"scene.toml:27:12: unknown curve 'u' in 'on' of constraint 'lumen'; expected one of: v, w; name one that "
              "the file has"});
  CHECK(bench.errors(scene_with("[\"w\", \"v\"]", "[]")) ==
        Texts{"scene.toml:27:6: 'on' of constraint 'lumen' is empty; expected a list of curves, for contact [wire, "
              "vessel]; write on = [\"<wire>\", \"<vessel>\"]"});
  CHECK(
      bench.errors(scene_with("[\"w\", \"v\"]", "\"w\"")) ==
      Texts{"scene.toml:27:6: 'on' of constraint 'lumen' is text \"w\"; expected a list of curves, for contact [wire, "
            "vessel]; write on = [\"<wire>\", \"<vessel>\"]"});
}

TEST_CASE("names that paths could not address") {
  Workbench bench;
  CHECK(bench.errors(scene_with("name = \"lumen\"", "name = \"lu.men\"")) ==
        Texts{"scene.toml:25:8: 'name' of constraint 'lu.men' is text \"lu.men\"; expected text without '.' and '=', "
              "which paths are split at; choose another name"});
}

TEST_CASE("a name of another kind") {
  Workbench bench;
  CHECK(bench.errors(scene_with("type = \"node-wise-contact\"", "type = \"anchoring\"")) ==
        Texts{"scene.toml:26:8: unknown constraint 'anchoring'; expected one of: node-wise-contact, "
              "segment-wise-contact; 'anchoring' is an energy, not a constraint"});
  CHECK(bench.errors(scene_with("type = \"node-wise-contact\"", "type = \"envelope\"")) ==
        Texts{"scene.toml:26:8: unknown constraint 'envelope'; expected one of: node-wise-contact, "
              "segment-wise-contact; `bowstring plugins constraint` says what is installed"});
}

TEST_CASE("kinds of values") {
  Workbench bench;
  const auto error = [&](const std::string& path, const std::string& value) {
    const Texts all = bench.errors(test::small_scene, {{path, value}});
    REQUIRE(all.size() == 1);
    return all[0].substr(("--set " + path + "=" + value + ": ").size());
  };
  CHECK(error("wire.w.radius", "\"0.4\"") ==
        "'radius' of wire 'w' is text \"0.4\" without a unit; expected a quantity in mm, more than 0; write \"0.4 "
        "mm\"");
  CHECK(error("wire.w.radius", "3 furlongz") ==
        "unknown unit 'furlongz' of 'radius' of wire 'w'; expected a quantity in mm, more than 0; write \"3 mm\"");
  CHECK(error("wire.w.radius", "inf") ==
        "'radius' of wire 'w' is number inf, which is not finite; expected a finite number; write \"<number> mm\"");
  CHECK(error("wire.w.radius", "nan mm") ==
        "'radius' of wire 'w' is text \"nan mm\", which is not finite; expected a finite number; write \"<number> "
        "mm\"");
  CHECK(error("wire.w.nodes", "80.0") ==
        "'nodes' of wire 'w' is number 80; expected a whole number, at least 3 and at most 1e+06; write nodes = <whole "
        "number>");
  CHECK(error("vessel.v.rigid", "yes") ==
        "'rigid' of vessel 'v' is text \"yes\"; expected true or false; write rigid "
        "= true");
  CHECK(error("solver.tolerance", "1e-8 N") ==
        "wrong unit: 'tolerance' of solver 'interior-point' is text \"1e-8 N\"; expected a number, more than 0; write "
        "1e-08");
  CHECK(error("solver.tolerance", "\"1e-8\"") ==
        "'tolerance' of solver 'interior-point' is text \"1e-8\"; expected a number, more than 0; write 1e-08");
  CHECK(error("vessel.v.geometry.periods", "90 deg") ==
        "wrong unit: 'periods' of geometry 'sinusoid' of vessel 'v' is text \"90 deg\"; expected a number; write 90");
  CHECK(error("vessel.v.geometry.origin", "1") ==
        "'origin' of geometry 'sinusoid' of vessel 'v' is whole number 1; expected a list, each entry a quantity in "
        "mm; write origin = [\"<number> mm\", …]");
  CHECK(error("constraint.lumen.centerline", "splin") ==
        "'centerline' of constraint 'lumen' is text \"splin\"; expected 'spline' or 'polyline'; did you mean "
        "'spline'?");
  CHECK(error("constraint.lumen.window", "1 N") ==
        "wrong unit: 'window' of constraint 'lumen' is text \"1 N\"; expected a number or a quantity in mm, more than "
        "0; write 1 or \"1 mm\"");
  CHECK(error("wire.w.kinematics", "3") ==
        "'kinematics' of wire 'w' is whole number 3; expected the name of a kinematics, or a table with its 'type'; "
        "write kinematics = \"edge-frames\"");
  CHECK(error("wire.w.ends", "[\"pinned\"]") ==
        "'ends' of wire 'w' has 1 entries; expected two: the first end and the last end; write ends = [\"pinned\", "
        "\"pinned\"]");
  CHECK(error("wire.w.ends.last", "pined") ==
        "the last end of wire 'w' is text \"pined\"; expected 'free', 'pinned', 'clamped' or 'held-edge'; did you mean "
        "'pinned'?");
  CHECK(error("wire.w.ends.last.tangent", "[1, 0, 0]") ==
        "'tangent' of the last end of wire 'w' has 3 entries; expected a list of as many numbers as the scene has "
        "dimensions; write the direction that is held, along the curve");
  CHECK(error("wire.w.ends.last.tangent", "[0, 0]") ==
        "'tangent' of the last end of wire 'w' has no length; expected a direction; write the direction that is held, "
        "along the curve");
}

TEST_CASE("profiles") {
  Workbench bench;
  const auto error = [&](const std::string& path, const std::string& value) {
    const Texts all = bench.errors(test::small_scene, {{path, value}});
    REQUIRE(all.size() == 1);
    return all[0].substr(("--set " + path + "=" + value + ": ").size());
  };
  CHECK(error("wire.w.radius", "{ colum = \"r\" }") ==
        "unknown key 'colum' in 'radius' of wire 'w'; expected one of: table, segments, column, unit, measured-from, "
        "factor; did you mean 'column'?");
  CHECK(error("wire.w.radius", "{}") ==
        "'radius' of wire 'w' has none of 'table', 'segments' and 'column'; expected exactly one of them; write a "
        "value, or a table with one of these keys");
  CHECK(error("wire.w.radius", "{ table = [[0, 1], [0, 2]] }") ==
        "arc length 0 mm of 'radius' of wire 'w' follows 0 mm; expected arc lengths that increase; sort the rows, one "
        "per arc length");
  CHECK(error("wire.w.radius", "{ table = [[0, 1, 2]] }") ==
        "a row of 'table' of 'radius' of wire 'w' is a list of 3; expected a pair [arc length, value]; write [\"0 "
        "mm\", <value>]");
  CHECK(error("wire.w.radius", "{ table = [[0, 0]] }") ==
        "a value of 'radius' of wire 'w' is 0, out of bounds; expected more than 0 mm; write a larger "
        "number");
  CHECK(error("wire.w.radius", "{ segments = { a = 1 }, measured-from = \"tip\" }") ==
        "'measured-from' of 'radius' of wire 'w' without a 'table'; expected it beside arc lengths only; remove it");
  CHECK(error("wire.w.radius", "{ table = [[0, 1]], measured-from = \"top\" }") ==
        "'measured-from' of 'radius' of wire 'w' is text \"top\"; expected 'tip' or 'sheath'; write one of them");
  CHECK(error("wire.w.radius", "{ table = [[0, 1]], factor = 0 }") ==
        "'factor' of 'radius' of wire 'w' is 0, out of bounds; expected more than 0; write a larger number");
  CHECK(error("wire.w.radius", "{ column = \"a\", factor = 2 }") ==
        "'factor' of 'radius' of wire 'w' with a 'column'; expected it beside values that stand in the composition; "
        "scale the column's own numbers");
  CHECK(error("wire.w.radius", "{ segments = {}, column = \"a\" }") ==
        "'radius' of wire 'w' has more than one of 'table', 'segments' and 'column'; expected exactly one of them; "
        "write a value, or a table with one of these keys");
  CHECK(error("vessel.v.radius", "{ table = [[0, 1]], measured-from = \"tip\" }") ==
        "'measured-from' in 'radius' of vessel 'v'; expected it on a wire only; remove it: a vessel's arc length "
        "counts from its first end");
  CHECK(error("energy.anchoring.stiffness", "{ table = [[0, \"1 N/mm^2\"]], measured-from = \"tip\" }") ==
        "'measured-from' in 'stiffness' of energy 'anchoring', which acts on a vessel; expected it on a wire only; "
        "remove it: a vessel's arc length counts from its first end");
  CHECK(error("energy.anchoring.stiffness", "{ column = \"k\" }") ==
        "'column' of 'stiffness' of energy 'anchoring' without a unit; expected one of: N/mm^2, N/mm; write { column = "
        "\"k\", unit = \"N/mm^2\" }");
  CHECK(
      error("energy.anchoring.stiffness", "{ column = \"k\", unit = \"N/m\" }") ==
      "'unit' of 'stiffness' of energy 'anchoring' is text \"N/m\"; expected one of: N/mm^2, N/mm; write the unit that "
      "the column's numbers are in");
  CHECK(error("wire.w.radius", "{ table = [[0, 1]], unit = \"mm\" }") ==
        "'unit' of 'radius' of wire 'w' without a 'column'; expected units in the values themselves; remove it");
  CHECK(error("energy.anchoring.stiffness", "{ segments = { a = \"1 N/mm\", b = \"1 N/mm^2\" } }") ==
        "segment 'b' of 'stiffness' of energy 'anchoring' is in N/mm^2, an earlier one in N/mm; expected one kind of "
        "unit in a profile; write all values in N/mm");
}
