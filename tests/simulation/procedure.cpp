#include "core/procedure/procedure.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/result/document.hpp"
#include "core/simulation/prepared_simulation.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

const char* tension = "energy.axial-tension.tension";

Simulation walked(const std::string& path, const std::string& from, const std::string& to) {
  Simulation out = small_planar();
  out.set("continuation.path", path);
  out.set("continuation.from", from);
  out.set("continuation.to", to);
  return out;
}

/// The first of what is wrong, without its position.
std::string refusal_of(const Simulation& simulation) {
  const Refusal refusal = simulation.check(plugins());
  return refusal.any() ? refusal.text() : "";
}

std::string two_steps(const std::string& second) {
  return "schema = 1\nbase = \"planar-iliac-smooth.toml\"\n[set]\n\"vessel.iliac.geometry.nodes\" = 24\n"
         "[[step]]\nname = \"stiff\"\n\"energy.wire-bending.bending-stiffness\" = \"4857 N mm^2\"\n" +
         second;
}

}  // namespace

TEST_CASE("a walk ends where a cold solve ends, and every point of it is certified") {
  const SimulationResult cold = small_planar().solve(plugins());
  const SimulationResult result = walked(tension, "0.1 N", "10 N").solve(plugins());
  REQUIRE(cold.converged());
  REQUIRE_MESSAGE(result.converged(), result.reason());
  CHECK(std::fabs(result.number("energy.total").value / cold.number("energy.total").value - 1.0) < 1e-10);
  CHECK(result.text("continuation.path").value == tension);
  const NumberTable parameter = result.numbers("path.parameter").value;
  REQUIRE(parameter.rows > 3);
  CHECK(parameter(0) == 0.1);
  CHECK(parameter(parameter.rows - 1) == 10.0);
  for (int k = 0; k < parameter.rows; ++k) {
    const std::string point = "path." + std::to_string(k) + ".";
    CHECK(result.text(point + "verdict").value == "converged");
    CHECK(result.text(point + "second_order").value == "minimum");
    if (k > 0) CHECK(parameter(k) > parameter(k - 1));
  }
}

TEST_CASE("a mesh, an end that is turned, a clearance and a stiffness are walked alike") {
  const auto arrives = [](const std::string& path, const std::string& from, const std::string& to) {
    const SimulationResult result = walked(path, from, to).solve(plugins());
    REQUIRE_MESSAGE(result.ok(), result.refusal().text());
    CHECK_MESSAGE(result.converged(), path << ": " << result.reason());
    return result.numbers("path.parameter").value.rows;
  };
  CHECK(arrives("vessel.iliac.geometry.nodes", "12", "40") > 2);
  CHECK(arrives("energy.wire-bending.bending-stiffness", "65 N mm^2", "4857 N mm^2") > 2);
  CHECK(arrives("vessel.iliac.radius", "10 mm", "4 mm") > 2);
  Simulation turned = walked("wire.lunderquist.ends.first.turn", "0 deg", "-20 deg");
  turned.set("wire.lunderquist.ends.first", "{ type = 'clamped', turn = '-20 deg' }");
  const SimulationResult result = turned.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  CHECK_MESSAGE(result.converged(), result.reason());
}

TEST_CASE("a walk that is a fallback is taken where the cold solve fails, which a warning says") {
  Simulation simulation = walked(tension, "0.5 N", "10 N");
  simulation.set("continuation.when", "fallback");
  const SimulationResult without = simulation.solve(plugins());
  CHECK(without.converged());
  CHECK(without.numbers("path.parameter").value.rows == 0);
  simulation.set("solver.max-iterations", 8);
  const SimulationResult with = simulation.solve(plugins());
  if (with.converged() && with.numbers("path.parameter").value.rows > 0) {
    CHECK(contains(with.warnings().back(), "[continuation] came to"));
  } else {
    CHECK_FALSE(with.converged());
    CHECK(contains(with.warnings().back(), "[continuation] did not help"));
  }
}

TEST_CASE("a fallback whose first value has no answer begins at the next that has one") {
  Simulation simulation = walked("solver.max-iterations", "1", "101");
  simulation.set("continuation.when", "fallback");
  simulation.set("solver.max-iterations", 2);
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE(result.ok());
  CHECK_MESSAGE(result.converged(), result.reason());
  CHECK(contains(result.warnings().back(), "[continuation] came to"));
  const NumberTable parameter = result.numbers("path.parameter").value;
  REQUIRE(parameter.rows > 0);
  CHECK(parameter(0) > 1.0);
  CHECK(parameter(parameter.rows - 1) == 101.0);
  CHECK(result.text("path.0.verdict").value == "converged");

  simulation.set("continuation.when", "always");
  const SimulationResult walk = simulation.solve(plugins());
  REQUIRE(walk.ok());
  CHECK_FALSE(walk.converged());
  CHECK(contains(walk.reason(), "the solve at its first value ended 'stalled'"));
}

TEST_CASE("a walk that cannot arrive says where it ended") {
  Simulation simulation = walked(tension, "10 N", "-40 N");
  simulation.set("continuation.max-points", 60);
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE(result.ok());
  CHECK_FALSE(result.converged());
  CHECK_MESSAGE(contains(result.reason(), "the walk of 'energy.axial-tension.tension' ended at "), result.reason());
  CHECK(result.text("continuation.reached").error != "");
}

TEST_CASE("what is wrong with a walk is told before anything is solved") {
  CHECK(contains(refusal_of(walked("energy.axial-tensoin.tension", "1 N", "2 N")),
                 "path 'energy.axial-tensoin.tension': no entry 'axial-tensoin' in 'energy'"));
  CHECK(contains(refusal_of(walked("energy.axial-tension.tensoin", "1 N", "2 N")), "unknown key 'tensoin'"));
  CHECK(contains(refusal_of(walked(tension, "1 N", "1000 mN")), "'from' and 'to' of [continuation] are equal"));
  CHECK(contains(refusal_of(walked(tension, "1 N", "2 mm")), "two units of one dimension"));
  CHECK(contains(
      refusal_of(walked("energy.wire-bending.bending-stiffness", "65 N mm^2", "-65 N mm^2")),
      "with 'energy.wire-bending.bending-stiffness' at \"-65 N mm^2\" of [continuation]: 'bending-stiffness' of "
      "energy 'wire-bending' is"));
  CHECK(contains(refusal_of(walked("vessel.iliac.radius", "6 mm", "0.2 mm")), "of [continuation]: "));
  Simulation logarithmic = walked(tension, "-1 N", "2 N");
  logarithmic.set("continuation.scale", "log");
  CHECK(contains(refusal_of(logarithmic), "two values of one sign, neither of them 0"));
  Simulation incomplete = small_planar();
  incomplete.set("continuation.path", tension);
  CHECK(contains(refusal_of(incomplete), "[continuation] has no 'from'"));
  CHECK(contains(refusal_of(incomplete), "[continuation] has no 'to'"));
  const Refusal refusal = [] {
    PreparedSimulation prepared = walked(tension, "1 N", "2 N").prepared(plugins());
    return prepared.check();
  }();
  CHECK(contains(refusal.text(), "[continuation] in a composition that is prepared"));
}

TEST_CASE("a chain of steps in one file equals the chain run in two files") {
  const std::string soft =
      "\"energy.wire-bending.bending-stiffness\" = \"65 N mm^2\"\n" + std::string("\"") + tension + "\" = \"1 N\"\n";
  for (const std::string rest : {"state-1", "previous"}) {
    const SimulationResult chain =
        Simulation::from_text(two_steps("[[step]]\nname = \"soft\"\nrest = \"" + rest + "\"\n" + soft),
                              scene_file("chain.toml"))
            .solve(plugins());
    REQUIRE_MESSAGE(chain.converged(), chain.reason());
    CHECK(chain.names("states").value == std::vector<std::string>{"stiff", "soft"});

    const SimulationResult first = Simulation::from_text(two_steps(""), scene_file("chain.toml")).solve(plugins());
    REQUIRE(first.converged());
    const auto file = std::filesystem::temp_directory_path() / "bowstring-first-state.json";
    std::ofstream(file) << first.json();
    Simulation second = small_planar();
    second.set("energy.wire-bending.bending-stiffness", "65 N mm^2");
    second.set(tension, "1 N");
    second.set("start.from", file.string());
    second.set("start.rest", rest);
    const SimulationResult alone = second.solve(plugins());
    REQUIRE_MESSAGE(alone.converged(), alone.reason());
    for (const std::string path :
         {"curves.iliac.points", "curves.lunderquist.points", "curves.iliac.reference_points", "contacts.force_N"}) {
      const NumberTable one = chain.numbers(path).value, other = alone.numbers(path).value;
      REQUIRE(one.rows > 1);
      CHECK(one.values == other.values);
    }
    CHECK(chain.number("energy.total").value == alone.number("energy.total").value);
    std::filesystem::remove(file);
  }
}

TEST_CASE("a chain ends with the step that does not converge") {
  const SimulationResult result =
      Simulation::from_text(
          two_steps("[[step]]\n\"solver.max-iterations\" = 1\n\"energy.axial-tension.tension\" = \"1 N\"\n[[step]]\n"),
          scene_file("chain.toml"))
          .solve(plugins());
  REQUIRE(result.ok());
  CHECK_FALSE(result.converged());
  CHECK(result.names("states").value.size() == 2);
  CHECK_MESSAGE(contains(result.reason(), "step 2 of 3, '2': "), result.reason());
}

TEST_CASE("what is wrong with steps is told before anything is solved, with its place") {
  const Refusal refusal =
      Simulation::from_text(
          two_steps("[[step]]\nname = \"stiff\"\n\"energy.axial-tensoin.tension\" = \"1 N\"\nrest = \"now\"\n"),
          scene_file("chain.toml"))
          .check(plugins());
  const std::string text = refusal.text();
  CHECK_MESSAGE(contains(text, "chain.toml:8:1: duplicate name: step 'stiff', after the one at "), text);
  CHECK_MESSAGE(contains(text, "chain.toml:10:1: path 'energy.axial-tensoin.tension': no entry 'axial-tensoin'"), text);
  CHECK_MESSAGE(contains(text, "chain.toml:11:8: 'rest' of step 2 is text \"now\"; expected 'state-1' or 'previous'"),
                text);
}

TEST_CASE("several starts list equilibria with their basins; without a seed the default is told") {
  Simulation simulation = Simulation::from_file(scene_file("column.toml"));
  simulation.set("multistart.starts", 5);
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.converged(), result.reason());
  CHECK(contains(result.warnings().back(), "[multistart] has no seed; 1 was taken"));
  REQUIRE(result.numbers("equilibria.basin_count").value.rows == 3);
  CHECK(result.number("equilibria.2.index").value == 1);
  CHECK(result.number("energy.total").value == result.number("equilibria.0.energy.total").value);
  double starts = 0.0;
  for (const double count : result.numbers("equilibria.basin_count").value.values) starts += count;
  CHECK(starts == 5.0);
  simulation.set("multistart.starts", 0);
  CHECK(contains(simulation.check(plugins()).text(), "'starts' of [multistart] is 0, out of bounds"));
}

}  // namespace bowstring
