#include "core/simulation/simulation.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <stdexcept>

#include "core/procedure/procedure.hpp"
#include "core/result/document.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

TEST_CASE("a simulation gives the document of the command's own way, bit for bit") {
  CompositionRequest request;
  request.file = scene_file("planar-iliac-smooth.toml");
  request.overrides = {{"vessel.iliac.geometry.nodes", "24"}, {"energy.axial-tension.tension", "12.5 N"}};
  Refusal refusal;
  const auto procedure = Procedure::prepare(request, plugins(), refusal);
  REQUIRE_MESSAGE(procedure != nullptr, refusal.text());
  const std::vector<StateResult> solved = procedure->run({});
  REQUIRE(solved.back().solution.certificate.verdict == Verdict::converged);

  Simulation simulation = small_planar();
  simulation.set("energy.axial-tension.tension", 12.5, "N");
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  CHECK(result.converged());
  CHECK(difference(result.json(), result_document(solved)) == "");
}

TEST_CASE("values are set as text, numbers, numbers with a unit, and flags; the last one of a path counts") {
  Simulation simulation = small_planar();
  const auto said = [&](const std::string& path) {
    const SimulationResult result = simulation.solve(plugins());
    CHECK_MESSAGE(result.ok(), result.refusal().text());
    return result.number("composition." + path).value;
  };
  const std::string tension = "energy.axial-tension.tension";
  simulation.set(tension, "2 kN");
  simulation.set(tension, 0.1 + 0.2);
  CHECK(said(tension) == 0.1 + 0.2);
  simulation.set(tension, 5);
  CHECK(said(tension) == 5.0);
  simulation.set(tension, 0.0065, "kN");
  CHECK(said(tension) == 6.5);
  simulation.set(tension, "'7 N'");
  CHECK(said(tension) == 7.0);
  simulation.unset(tension);
  CHECK(said(tension) == 10.0);
  simulation.set("solver.tolerance", 1e-9);
  CHECK(said("solver.tolerance") == 1e-9);
}

TEST_CASE("a flag is true or false, not a number") {
  Simulation simulation = small_planar();
  simulation.set("vessel.iliac.rigid", true);
  CHECK(simulation.solve(plugins()).number("problem.unknowns").value <
        small_planar().solve(plugins()).number("problem.unknowns").value);
  simulation.set("vessel.iliac.rigid", false);
  CHECK_FALSE(simulation.check(plugins()).any());
}

TEST_CASE("a whole list may be set, and its parts afterwards") {
  Simulation simulation = small_planar();
  simulation.set("wire.lunderquist.ends.last", "clamped");
  simulation.set("wire.lunderquist.ends", R"(["pinned", "pinned"])");
  simulation.set("wire.lunderquist.ends.first", "clamped");
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  CHECK(result.text("composition.wire.lunderquist.ends.0").value == "clamped");
  CHECK(result.text("composition.wire.lunderquist.ends.1").value == "pinned");
}

TEST_CASE("a composition as text finds its base, and its own folder, from the name that it is given") {
  const std::string text = "schema = 1\nbase = \"planar-iliac-smooth.toml\"\n";
  const std::vector<std::string> path =
      Simulation::from_text(text + "plugin-path = \"my-plugins\"\n", scene_file("any.toml")).plugin_path();
  CHECK(path == std::vector<std::string>{scene_file("my-plugins")});
  // A file of that name may even be the text's own base.
  Simulation simulation = Simulation::from_text(text, scene_file("planar-iliac-smooth.toml"));
  simulation.set("vessel.iliac.geometry.nodes", 24);
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  CHECK(difference(result.json(), small_planar().solve(plugins()).json()) == "");
}

TEST_CASE("progress is told of every iteration, and stops the solver") {
  int calls = 0;
  const SimulationResult whole = small_planar().solve(plugins(), [&](const IterationRecord& record) {
    CHECK(record.iteration == calls);
    ++calls;
    return true;
  });
  REQUIRE(whole.converged());
  CHECK(calls == static_cast<int>(whole.number("solver.iterations").value) + 1);

  const SimulationResult part =
      small_planar().solve(plugins(), [](const IterationRecord& record) { return record.iteration < 3; });
  REQUIRE(part.ok());
  CHECK(part.status() == Verdict::stalled);
  CHECK(contains(part.reason(), "stopped by the user"));
  CHECK(part.number("solver.iterations").value == 3.0);
}

TEST_CASE("an exception of the progress function ends the solve, and nothing else") {
  const SimulationResult result = small_planar().solve(
      plugins(), [](const IterationRecord&) -> bool { throw std::runtime_error("the window was closed"); });
  REQUIRE(result.ok());
  CHECK(result.status() == Verdict::stalled);
  REQUIRE_FALSE(result.warnings().empty());
  CHECK(result.warnings().back() ==
        "the progress function threw 'the window was closed', which has stopped the solver");
  CHECK(small_planar().solve(plugins(), [](const IterationRecord&) -> bool { throw 1; }).warnings().back() ==
        "the progress function threw 'an exception that is no std::exception was thrown', which has stopped the "
        "solver");
}

TEST_CASE("a solve by Ipopt from within Ipopt's progress is refused, and does not wait for itself") {
  Simulation simulation = small_planar();
  simulation.set("solver.type", "ipopt");
  const SimulationResult outer = simulation.solve(plugins(), [&](const IterationRecord& record) {
    if (record.iteration != 2) return true;
    const SimulationResult nested = simulation.solve(plugins());
    CHECK(nested.ok());
    CHECK(nested.status() == Verdict::failed);
    CHECK(contains(nested.reason(),
                   "solver 'ipopt': a progress function of Ipopt has started another solve by Ipopt, "
                   "which solves one problem at a time; solve after it has returned"));
    return true;
  });
  CHECK(outer.converged());
  CHECK(small_planar().solve(plugins()).converged());
}

}  // namespace bowstring
