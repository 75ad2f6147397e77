// Two solves in two threads give the bits that they give one after the other.
#include <doctest/doctest.h>

#include <thread>
#include <vector>

#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

Simulation scene(const std::string& file, const std::vector<std::pair<const char*, const char*>>& set) {
  Simulation out = Simulation::from_file(scene_file(file));
  for (const auto& [path, value] : set) out.set(path, value);
  return out;
}

/// In the plane and in space, with every kinematics, contact formulation and solver, with units that only UDUNITS-2
/// knows, and one that ends as `stalled`.
std::vector<Simulation> simulations(const PluginHost& host) {
  std::vector<Simulation> out = {
      small_planar(),
      scene("planar-iliac.toml", {{"vessel.iliac.geometry.nodes", "30"},
                                  {"vessel.iliac.kinematics", "nodes"},
                                  {"wire.lunderquist.kinematics", "nodes"},
                                  {"energy.axial-tension.tension", "2.5 lbf"}}),
      scene("helical-iliac.toml", {{"vessel.iliac.geometry.nodes", "20"}}),
      scene("helical-iliac-full.toml", {{"vessel.iliac.geometry.nodes", "20"}}),
      scene("tortuous-iliac.toml", {{"solver.max-iterations", "5"}}),
      scene("planar-iliac-smooth.toml",
            {{"constraint.lumen.type", "segment-wise-contact"}, {"vessel.iliac.geometry.chord", "15 decimeter"}}),
      scene("cantilever.toml", {}),
      scene("buckled-rod.toml", {}),
  };
  for (const std::string& solver : host.names(Kind::solver)) {
    if (solver == "ipopt") continue;
    if (solver == "trust-region") {  // takes no contact
      out.push_back(scene("column.toml", {}));
      continue;
    }
    Simulation other = small_planar();
    other.set("vessel.iliac.geometry.nodes", 12);
    other.set("solver.type", solver);
    out.push_back(other);
  }
  return out;
}

/// Solves all at once, each in a thread of its own.
std::vector<SimulationResult> all_at_once(const std::vector<Simulation>& simulations,
                                          const std::vector<PluginHost*>& hosts) {
  std::vector<SimulationResult> results(simulations.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    threads.emplace_back([&, i] { results[i] = simulations[i].solve(*hosts[i % hosts.size()]); });
  }
  for (std::thread& thread : threads) thread.join();
  return results;
}

void check_same(const std::vector<SimulationResult>& results, const std::vector<SimulationResult>& expected) {
  REQUIRE(results.size() == expected.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    CAPTURE(i);
    REQUIRE_MESSAGE(results[i].ok(), results[i].refusal().text());
    CHECK(difference(results[i].json(), expected[i].json()) == "");
  }
}

}  // namespace

// The first of this program, so that the threads open the libraries.
TEST_CASE("different scenes, kinematics and solvers at once, with one host that has opened nothing yet") {
  PluginHost cold;
  const std::vector<Simulation> all = simulations(cold);
  REQUIRE(all.size() >= 8);
  const std::vector<SimulationResult> at_once = all_at_once(all, {&cold});
  std::vector<SimulationResult> in_turn;
  PluginHost host;
  for (const Simulation& simulation : all) in_turn.push_back(simulation.solve(host));
  for (const SimulationResult& result : in_turn) {
    REQUIRE_MESSAGE(result.ok(), result.refusal().text());
    CHECK(result.number("solver.iterations").value > 1.0);
    CHECK(result.status() != Verdict::failed);
  }
  check_same(at_once, in_turn);

  PluginHost other;
  check_same(all_at_once(all, {&host, &other}), in_turn);
}

TEST_CASE("one simulation in several threads at once") {
  PluginHost host;
  for (const Simulation& simulation : simulations(host)) {
    const SimulationResult alone = simulation.solve(host);
    REQUIRE_MESSAGE(alone.ok(), alone.refusal().text());
    const std::vector<Simulation> three(3, simulation);
    check_same(all_at_once(three, {&host}), std::vector<SimulationResult>(3, alone));
  }
}

TEST_CASE("refusals, progress and files of threads do not meet") {
  PluginHost host;
  Simulation wrong = small_planar();
  wrong.set("energy.axial-tension.tension", "10 parsec");
  const std::string expected = wrong.check(host).text();
  REQUIRE(contains(expected, "wrong unit"));
  const std::string reference = small_planar().solve(host).json();
  std::vector<std::thread> threads;
  std::vector<std::string> refused(4), documents(4);
  std::vector<int> calls(4, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      refused[i] = wrong.check(host).text();
      const SimulationResult result =
          small_planar().solve(host, [&](const IterationRecord&) { return ++calls[i] > 0; });
      documents[i] = result.json();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(refused[i] == expected);
    CHECK(difference(documents[i], reference) == "");
    CHECK(calls[i] == calls[0]);
    CHECK(calls[i] > 1);
  }
}

}  // namespace bowstring
