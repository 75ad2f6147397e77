#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/composition/sha256.hpp"
#include "core/simulation/prepared_simulation.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Json = nlohmann::ordered_json;

const std::string bending = "energy.wire-bending.bending-stiffness";

/// A folder that is gone when this is.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "bowstring-start-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

SimulationResult solved(const Simulation& simulation) {
  SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  return result;
}

double iterations(const SimulationResult& result) { return result.number("solver.iterations").value; }

bool warns(const SimulationResult& result, const std::string& part) {
  for (const std::string& warning : result.warnings()) {
    if (contains(warning, part)) return true;
  }
  return false;
}

/// A document without what tells a file from memory.
std::string without_origin(const SimulationResult& result) {
  Json document = Json::parse(result.json());
  document["composition"].erase("start");
  document["provenance"]["start"].erase("file");
  return document.dump();
}

/// small_planar from a file's state.
Simulation continued(const std::string& file) {
  Simulation out = small_planar();
  out.set("start.from", file);
  return out;
}

std::string refusal_of(const Simulation& simulation) {
  const SimulationResult result = simulation.solve(plugins());
  CHECK_FALSE(result.ok());
  CHECK(result.refusal().kind() == RefusalKind::wrong_input);
  return result.refusal().text();
}

}  // namespace

TEST_CASE("a solve from a result takes few iterations to the same equilibrium, and says where it began") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  REQUIRE(first.converged());
  REQUIRE(first.write(folder.file("first.json")).ok());

  const SimulationResult again = solved(continued(folder.file("first.json")));
  CHECK(again.converged());
  CHECK(iterations(again) <= 2.0);
  CHECK(again.number("solver.epochs").value == 1.0);
  CHECK(again.text("composition.start.from").value == folder.file("first.json"));
  CHECK(again.text("provenance.start.file").value == folder.file("first.json"));
  CHECK(again.text("provenance.start.sha256").value == sha256_hex(first.json()));

  Simulation stiffer = continued(folder.file("first.json"));
  stiffer.set(bending, 1.05 * 65.0, "N mm^2");
  const SimulationResult warm = solved(stiffer);
  stiffer.unset("start.from");
  const SimulationResult cold = solved(stiffer);
  REQUIRE(warm.converged());
  REQUIRE(cold.converged());
  CHECK(2.0 * iterations(warm) < iterations(cold));
  CHECK(cold.number("provenance.start.file").error != "");
  const double moved = std::fabs(cold.number("energy.total").value - first.number("energy.total").value);
  CHECK(moved > 1e-3);
  CHECK(std::fabs(warm.number("energy.total").value - cold.number("energy.total").value) < 1e-5 * moved);
}

TEST_CASE("in process and from the file the same bits come out") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  REQUIRE(first.write(folder.file("first.json")).ok());
  Simulation stiffer = small_planar();
  stiffer.set(bending, 80.0, "N mm^2");
  const SimulationResult in_process = stiffer.solve(plugins(), {}, first);
  REQUIRE_MESSAGE(in_process.ok(), in_process.refusal().text());
  CHECK(in_process.converged());
  stiffer.set("start.from", folder.file("first.json"));
  CHECK(difference(without_origin(in_process), without_origin(solved(stiffer))) == "");
}

TEST_CASE("what stalled at a limit, or was stopped, goes on from its result") {
  const Folder folder;
  Simulation limited = small_planar();
  const double whole = iterations(solved(limited));
  limited.set("solver.max-iterations", 6);
  const SimulationResult part = solved(limited);
  REQUIRE(part.status() == Verdict::stalled);
  REQUIRE(part.write(folder.file("part.json")).ok());
  const SimulationResult rest = solved(continued(folder.file("part.json")));
  CHECK(rest.converged());
  CHECK(iterations(rest) < whole);

  limited.set("start.from", folder.file("part.json"));
  limited.set("solver.max-iterations", 1);
  const SimulationResult little = solved(limited);
  CHECK(little.status() == Verdict::stalled);
  CHECK_FALSE(warns(little, "the scene's own start"));

  const SimulationResult stopped =
      small_planar().solve(plugins(), [](const IterationRecord& record) { return record.iteration < 5; });
  REQUIRE(stopped.status() == Verdict::stalled);
  CHECK(small_planar().solve(plugins(), {}, stopped).converged());
}

TEST_CASE("a start that the solver cannot use makes no status worse") {
  const Folder folder;
  Json document = Json::parse(solved(small_planar()).json());
  Json& positions = document["state"]["fields"]["lunderquist.position"];
  REQUIRE(positions.size() == 48);
  for (std::size_t i = 2; i + 2 < positions.size(); ++i) {
    positions[i] = positions[i].get<double>() + (i % 3 == 0 ? 30.0 : -25.0);
  }
  const SimulationResult result = solved(continued(folder.write("tangled.json", document.dump())));
  CHECK(result.converged());
  CHECK(result.number("quantities.peak_displacement_mm").value ==
        doctest::Approx(solved(small_planar()).number("quantities.peak_displacement_mm").value).epsilon(1e-6));
}

TEST_CASE("a start of another mesh or kinematics is interpolated, which is said, and saves most iterations") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  const std::string file = folder.write("first.json", first.json());
  const std::string start = "the start '" + file + "'";
  Simulation finer = continued(file);
  finer.set("vessel.iliac.geometry.nodes", 48);
  const SimulationResult warm = solved(finer);
  CHECK(warm.converged());
  CHECK(warns(warm, start + " is interpolated: 'iliac' from 24 nodes to 48; 'lunderquist' from 24 nodes to 48"));
  CHECK_FALSE(warns(warm, "multipliers"));
  finer.unset("start.from");
  const SimulationResult cold = solved(finer);
  CHECK(2.0 * iterations(warm) <= iterations(cold));
  CHECK(warm.number("energy.total").value == doctest::Approx(cold.number("energy.total").value).epsilon(1e-9));

  Simulation nodes = continued(file);
  nodes.set("wire.lunderquist.kinematics", "nodes");
  const SimulationResult other = solved(nodes);
  CHECK(other.converged());
  CHECK(iterations(other) <= 5.0);
  CHECK(warns(other, start + " is interpolated: 'lunderquist' from kinematics 'edge-frames' to 'nodes'"));
  CHECK_FALSE(warns(other, "interpolated: 'iliac'"));
  CHECK_FALSE(warns(other, "; 'iliac'"));

  // A field that is missing is made from the shape; what fits beside it stays.
  Json document = Json::parse(first.json());
  document["state"]["fields"].erase("iliac.orientation");
  const SimulationResult mended = solved(continued(folder.write("mended.json", document.dump())));
  CHECK(mended.converged());
  CHECK(iterations(mended) <= 2.0);
  CHECK(warns(mended, "is interpolated: 'iliac' to the fields position in R^n, orientation in S1, edge-length in R"));
}

TEST_CASE("multipliers of a graded mesh are carried as densities") {
  Simulation coarse = small_planar();
  coarse.set("wire.lunderquist.nodes", 30);
  const SimulationResult first = solved(coarse);
  REQUIRE(first.converged());
  std::ostringstream spacing;
  spacing.precision(17);
  double sum = 0.0;
  const auto share = [](int i) { return 1.0 + 0.5 * std::sin(0.2 * i); };
  for (int i = 0; i < 40; ++i) sum += share(i);
  for (int i = 0; i < 40; ++i) spacing << (i > 0 ? ", " : "[") << share(i) / sum;
  Simulation graded = small_planar();
  graded.set("wire.lunderquist.nodes", 41);
  graded.set("wire.lunderquist.spacing", spacing.str() + "]");
  const SimulationResult warm = graded.solve(plugins(), {}, first);
  REQUIRE_MESSAGE(warm.ok(), warm.refusal().text());
  CHECK(warm.converged());
  CHECK(2.0 * iterations(warm) <= iterations(solved(graded)));
}

TEST_CASE("a start of another scene is refused with all that differs") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  Json document = Json::parse(first.json());
  document["curves"][0]["name"] = "aorta";
  document["state"]["fields"].clear();
  const std::string file = folder.write("first.json", document.dump());
  const std::string by = "--set start.from=" + file + ": the start '" + file + "' ";
  const std::string rest = "; expected the vessels of this scene: iliac; start from a result of the same scene";
  CHECK(refusal_of(continued(file)) == by + "has no vessel 'iliac'" + rest + "\n" + by +
                                           "has a vessel 'aorta', which this scene does not have" + rest);
  Simulation helix = Simulation::from_file(scene_file("helical-iliac.toml"));
  const SimulationResult refused = helix.solve(plugins(), {}, first);
  CHECK_FALSE(refused.ok());
  CHECK(refused.refusal().text() ==
        "from: the result is in the plane; expected a state in space, as this scene is; start from a result of the "
        "same scene");
  CHECK(contains(small_planar().solve(plugins(), {}, refused).refusal().text(),
                 "from: the result to start from is a refusal (from: the result is in the plane"));
}

TEST_CASE("the file and the memory give the same bits, on another mesh and as a rest state") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  REQUIRE(first.write(folder.file("first.json")).ok());
  for (const bool rest : {false, true}) {
    for (const char* kinematics : {"edge-frames", "nodes"}) {
      CAPTURE(rest);
      CAPTURE(kinematics);
      Simulation next = small_planar();
      next.set("vessel.iliac.geometry.nodes", 31);
      next.set("vessel.iliac.kinematics", kinematics);
      if (rest) next.set("start.rest", "previous");
      const SimulationResult in_process = next.solve(plugins(), {}, first);
      REQUIRE_MESSAGE(in_process.ok(), in_process.refusal().text());
      CHECK(in_process.converged());
      CHECK(warns(in_process, std::string("the result is interpolated: 'iliac' from 24 nodes to 31") +
                                  (rest ? ", as its rest state; " : "")));
      CHECK_FALSE(warns(in_process, "what ends hold"));
      next.set("start.from", folder.file("first.json"));
      const SimulationResult from_file = solved(next);
      Json a = Json::parse(without_origin(in_process)), b = Json::parse(without_origin(from_file));
      CHECK(a["warnings"].size() == b["warnings"].size());
      a.erase("warnings"), b.erase("warnings");  // they name the state
      CHECK(difference(a.dump(), b.dump()) == "");
    }
  }
}

TEST_CASE("with rest = \"previous\" displacements and lengths count from the state before") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  REQUIRE(first.write(folder.file("first.json")).ok());
  Simulation next = continued(folder.file("first.json"));
  CHECK(solved(next).text("composition.start.rest").value == "state-1");
  next.set("start.rest", "previous");
  const SimulationResult second = solved(next);
  CHECK(second.converged());
  CHECK(second.text("composition.start.rest").value == "previous");
  CHECK(second.numbers("curves.iliac.reference_points").value.values ==
        first.numbers("curves.iliac.points").value.values);
  CHECK(second.numbers("curves.iliac.state_1_points").value.values ==
        first.numbers("curves.iliac.reference_points").value.values);
  CHECK(first.numbers("curves.iliac.state_1_points").error != "");
  CHECK(second.numbers("curves.lunderquist.reference_points").value.values ==
        first.numbers("curves.lunderquist.reference_points").value.values);
  CHECK(second.numbers("curves.iliac.radius_mm").value.values == first.numbers("curves.iliac.radius_mm").value.values);
  const double before = first.number("quantities.peak_displacement_mm").value;
  const double further = second.number("quantities.peak_displacement_mm").value;
  CHECK(further > 0.1);
  CHECK(further < before);
  CHECK(second.number("energy.total").value < first.number("energy.total").value);
  // A chain: the state after that is without stress once more.
  REQUIRE(second.write(folder.file("second.json")).ok());
  next.set("start.from", folder.file("second.json"));
  const SimulationResult third = solved(next);
  CHECK(third.converged());
  CHECK(third.numbers("curves.iliac.reference_points").value.values ==
        second.numbers("curves.iliac.points").value.values);
  CHECK(third.number("quantities.peak_displacement_mm").value < further);
}

TEST_CASE("a prepared simulation with rest = \"previous\" is built for every state, and gives a simulation's bits") {
  const SimulationResult first = solved(small_planar());
  Simulation simulation = small_planar();
  simulation.set("start.rest", "previous");
  PreparedSimulation prepared = simulation.prepared(plugins());
  CHECK(contains(prepared.solve().refusal().text(), "[start] has no 'from'"));
  const SimulationResult second = prepared.solve_from(first);
  REQUIRE_MESSAGE(second.ok(), second.refusal().text());
  const auto plain = [](const SimulationResult& result) {
    Json document = Json::parse(without_origin(result));
    document["provenance"]["start"]["sha256"] = nullptr;
    return document.dump();
  };
  CHECK(difference(plain(second), plain(simulation.solve(plugins(), {}, first))) == "");
  const SimulationResult third = prepared.solve();
  REQUIRE_MESSAGE(third.ok(), third.refusal().text());
  CHECK(difference(plain(third), plain(simulation.solve(plugins(), {}, second))) == "");
}

TEST_CASE("a document that is none, or whose state is not known, is refused where 'from' stands") {
  const Folder folder;
  const auto said = [&](const std::string& text) { return refusal_of(continued(folder.write("a.json", text))); };
  const std::string from = "--set start.from=" + folder.file("a.json") + ": the start '" + folder.file("a.json") + "'";
  const std::string document = "a result document, as `bowstring solve --out` writes it";
  CHECK(contains(said("{"), from + " is no JSON (parse error at line 1, column 2"));
  CHECK(said("[]") == from + " has no 'format'; expected " + document + "; name a file that was written with --out");
  CHECK(said(R"({"format": "bowstring.result/2"})") ==
        from +
            " has format \"bowstring.result/2\"; expected \"bowstring.result/1\"; solve it again with this version, "
            "which reads no other");
  CHECK(said(R"({"format": "bowstring.result/1"})") ==
        from + " has no 'state'; expected a table of numbers by name; name a file that was written with --out");
  CHECK(
      said(R"({"format": "bowstring.result/1", "state": {"fields": {"a.b": [1, null]}, "multipliers": {"c": 1}}})") ==
      from +
          " has null as number 1 of field 'a.b'; expected finite numbers; start from a result whose state is known\n" +
          from + " has 1 as multipliers 'c'; expected a list of numbers; name a file that was written with --out");
  CHECK(contains(refusal_of(continued(folder.file("none.json"))),
                 "none.json: cannot read the start '" + folder.file("none.json") +
                     "' (No such file or directory); expected " + document +
                     "; paths of --set are relative to the working directory"));

  Json unknown = Json::parse(solved(small_planar()).json());
  unknown["problem"]["fields"][1]["manifold"] = "SO3";  // a field of another meaning does not fit …
  CHECK(solved(continued(folder.write("a.json", unknown.dump()))).converged());
  unknown["curves"][0]["frames"][3][1] = nullptr;  // … and what replaces it is not known
  CHECK(contains(said(unknown.dump()),
                 from.substr(0, from.find("the start")) + "the numbers of 'iliac' in the start '" +
                     folder.file("a.json") +
                     "' do not fit, and it has the curve with 'frames' that are not known, so that nothing can be "
                     "interpolated; expected a shape, or the fields position in R^n, "));
}

TEST_CASE("a path in the composition is relative to it, and the document is an input that no result replaces") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  folder.write("first.json", first.json());
  const std::string text = "schema = 1\nbase = \"" + scene_file("planar-iliac-smooth.toml") +
                           "\"\n[start]\nfrom = \"first.json\"\n[set]\n\"vessel.iliac.geometry.nodes\" = 24\n";
  const Simulation simulation = Simulation::from_text(text, folder.file("scene.toml"));
  const SimulationResult result = solved(simulation);
  CHECK(result.text("composition.start.from").value == folder.file("first.json"));
  CHECK(contains(result.write(folder.file("first.json")).text, "it is what the composition reads"));
  CHECK(contains(refusal_of(Simulation::from_text(text + "[start.x]\n", folder.file("scene.toml"))),
                 "unknown key 'x' in [start]; expected one of: from, rest"));
}

TEST_CASE("other rows take the state without their multipliers, and say so") {
  const Folder folder;
  const std::string file = folder.write("first.json", solved(small_planar()).json());
  Simulation denser = continued(file);
  denser.set("constraint.lumen.rows-per-segment", 2);
  const SimulationResult result = solved(denser);
  CHECK(result.converged());
  CHECK(warns(result, "the start '" + file +
                          "' has 22 multipliers of 'lumen', which has 45 rows here: its state is "
                          "taken, and these multipliers start at 0"));
  const SimulationResult same = solved(continued(file));
  CHECK_FALSE(warns(same, "multipliers"));
}

TEST_CASE("what an end holds is the composition's, which may have moved it") {
  const Folder folder;
  const SimulationResult first = solved(small_planar());
  const std::string file = folder.write("first.json", first.json());
  Simulation moved = continued(file);
  moved.set("vessel.iliac.ends.last", R"({ type = "pinned", move = [0.5, 0.25] })");
  const SimulationResult result = solved(moved);
  CHECK(result.converged());
  CHECK(warns(result, "the start '" + file +
                          "' differs in what ends hold, which stays as this composition has it: 'iliac.position' by up "
                          "to 0.5"));
  const NumberTable before = first.numbers("curves.iliac.points").value;
  const NumberTable after = result.numbers("curves.iliac.points").value;
  REQUIRE(after.rows == 24);
  CHECK(after(23, 0) == doctest::Approx(before(23, 0) + 0.5).epsilon(1e-14));
  CHECK(after(23, 1) == doctest::Approx(before(23, 1) + 0.25).epsilon(1e-14));
}

TEST_CASE("a rod in space goes on from its frames") {
  Simulation rod = Simulation::from_file(scene_file("helical-iliac.toml"));
  rod.set("vessel.iliac.geometry.nodes", 24);
  const SimulationResult first = rod.solve(plugins());
  REQUIRE_MESSAGE(first.ok(), first.refusal().text());
  REQUIRE(first.converged());
  const SimulationResult again = rod.solve(plugins(), {}, first);
  REQUIRE_MESSAGE(again.ok(), again.refusal().text());
  CHECK(again.converged());
  CHECK(iterations(again) <= 3.0);
}

TEST_CASE("a prepared simulation gives a simulation's bits, and is built once for numbers") {
  PreparedSimulation prepared = small_planar().prepared(plugins());
  const SimulationResult first = prepared.solve();
  REQUIRE_MESSAGE(first.ok(), first.refusal().text());
  CHECK(difference(first.json(), solved(small_planar()).json()) == "");

  Simulation simulation = small_planar();
  const auto set = [&](const std::string& path, double value, const std::string& unit) {
    simulation.set(path, value, unit);
    prepared.set(path, value, unit);
  };
  set(bending, 70.0, "N mm^2");
  set("energy.anchoring.stiffness", 0.014, "N/mm^2");
  set("energy.axial-tension.tension", 0.0105, "kN");
  const SimulationResult warm = prepared.solve();
  CHECK(prepared.builds() == 1);
  CHECK(warm.converged());
  CHECK(difference(without_origin(warm), [&] {
          const SimulationResult other = simulation.solve(plugins(), {}, first);
          Json document = Json::parse(without_origin(other));
          document["provenance"]["start"]["sha256"] = nullptr;
          return document.dump();
        }()) == "");
  CHECK(warm.number("provenance.start.file").error != "");
  CHECK(difference(prepared.solve_afresh().json(), solved(simulation).json()) == "");
  CHECK(prepared.builds() == 1);

  set("constraint.lumen.window", 3.0, "1");
  simulation.set("constraint.lumen.window", 3.0);
  prepared.set("constraint.lumen.window", 3.0);
  CHECK(difference(prepared.solve_afresh().json(), solved(simulation).json()) == "");
  prepared.set("constraint.lumen.window", 4.0);
  simulation.set("constraint.lumen.window", 4.0);
  const int builds = prepared.builds();
  CHECK(difference(prepared.solve_afresh().json(), solved(simulation).json()) == "");
  CHECK(prepared.builds() == builds);

  // What an earlier result says does not change with later ones.
  CHECK(first.number("composition.energy.wire-bending.bending-stiffness").value == 65.0);
  CHECK(warm.number("composition.energy.wire-bending.bending-stiffness").value == 70.0);
}

TEST_CASE("a prepared simulation is built again where a value changes more than numbers") {
  PreparedSimulation prepared = small_planar().prepared(plugins());
  REQUIRE(prepared.solve().converged());
  prepared.set("energy.anchoring.stiffness", 0.03, "N/mm");  // per node, not per length
  CHECK(prepared.solve().converged());
  CHECK(prepared.builds() == 2);
  prepared.set("vessel.iliac.geometry.nodes", 30);
  const SimulationResult finer = prepared.solve();
  CHECK(finer.converged());
  CHECK(prepared.builds() == 3);
  CHECK(warns(finer, "the result is interpolated: 'iliac' from 24 nodes to 30; 'lunderquist' from 24 nodes to 30"));
  CHECK(prepared.solve().converged());
  CHECK(prepared.builds() == 3);
  CHECK(prepared.solve_afresh().converged());
  CHECK(prepared.builds() == 4);
  prepared.unset("vessel.iliac.geometry.nodes");
  const SimulationResult coarser = prepared.solve();
  REQUIRE_MESSAGE(coarser.ok(), coarser.refusal().text());
  CHECK(coarser.numbers("curves.iliac.points").value.rows == 80);
}

TEST_CASE("a prepared simulation refuses in a simulation's words, and recovers") {
  PreparedSimulation prepared = small_planar().prepared(plugins());
  REQUIRE(prepared.solve().converged());
  Simulation simulation = small_planar();
  for (const auto& [value, unit] : {std::pair{-1.0, "N mm^2"}, std::pair{1.0, "N"}}) {
    prepared.set(bending, value, unit);
    simulation.set(bending, value, unit);
    const std::string text = simulation.check(plugins()).text();
    REQUIRE(text != "");
    CHECK(prepared.check().text() == text);
    CHECK(prepared.solve().refusal().text() == text);
  }
  prepared.set(bending, 66.0, "N mm^2");
  CHECK_FALSE(prepared.check().any());
  const SimulationResult result = prepared.solve();
  CHECK(result.converged());
  CHECK(iterations(result) <= 5.0);
}

}  // namespace bowstring
