#include <doctest/doctest.h>

#include <cmath>
#include <new>

#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

/// A registry that breaks down, in the place of anything that was not thought of.
class BrokenRegistry final : public Registry {
 public:
  std::vector<std::string> names(Kind) const override { return {}; }
  const ComponentDescriptor* find(Kind, const std::string&, Status&) override { throw std::bad_alloc(); }
  ComponentOrigin origin(Kind, const std::string&) const override { return {}; }
};

}  // namespace

TEST_CASE("all that is wrong with the input is in one refusal, with where it stands") {
  Simulation simulation = small_planar();
  simulation.set("wire.lunderqist.radius", 1);
  simulation.set("energy.axial-tension.tension", 10, "mm");
  const SimulationResult result = simulation.solve(plugins());
  CHECK_FALSE(result.ok());
  CHECK(result.refusal().kind() == RefusalKind::wrong_input);
  CHECK(static_cast<int>(result.refusal().kind()) == 2);
  CHECK(result.refusal().text() ==
        "--set wire.lunderqist.radius=1: path 'wire.lunderqist.radius': no entry 'lunderqist' in 'wire'; expected one "
        "of: lunderquist; did you mean 'lunderquist'?\n"
        "--set energy.axial-tension.tension=\"10 mm\": wrong unit: 'tension' of energy 'axial-tension' is text \"10 "
        "mm\"; expected a quantity in N; write \"10 N\"");
  CHECK(simulation.check(plugins()).text() == result.refusal().text());
  CHECK(result.status() == Verdict::failed);
  CHECK(result.json().empty());
}

TEST_CASE("a file that is not there, and text that is no composition, are refusals") {
  const Refusal absent = Simulation::from_file("absent.toml").check(plugins());
  CHECK(absent.kind() == RefusalKind::wrong_input);
  CHECK(
      absent.text() ==
      "absent.toml: cannot read the file (No such file or directory); expected a composition in TOML; check the path");
  const Refusal broken = Simulation::from_text("schema = 1\n[scene]\ndimension = = 2\n").check(plugins());
  CHECK(broken.kind() == RefusalKind::wrong_input);
  CHECK(contains(broken.text(), "composition.toml:3:13: not TOML: "));
  const Simulation circle = Simulation::from_text("schema = 1\nbase = \"a.toml\"\n", "nowhere/a.toml");
  CHECK(contains(circle.check(plugins()).text(), "nowhere/a.toml:2:8: cannot read the base 'nowhere/a.toml'"));
}

TEST_CASE("a refused result says why wherever it is asked") {
  const SimulationResult refused = Simulation::from_file("absent.toml").solve(plugins());
  const std::string why = "there is no result: " + refused.refusal().text();
  CHECK(refused.number("quantities.peak_displacement_mm").error == why);
  CHECK(std::isnan(refused.number("quantities.peak_displacement_mm").value));
  CHECK(refused.numbers("curves.iliac.points").error == why);
  CHECK(refused.text("status").error == why);
  CHECK(refused.names("energy").error == why);
  CHECK(contains(refused.write("refused.json").text, "there is no result"));
  CHECK(SimulationResult().refusal().text() == "nothing was solved yet");
}

TEST_CASE("an exception from below becomes a refusal") {
  BrokenRegistry registry;
  const Simulation simulation = small_planar();
  const Refusal refusal = simulation.check(registry);
  CHECK(refusal.kind() == RefusalKind::plugin_failed);
  CHECK(static_cast<int>(refusal.kind()) == 3);
  CHECK(refusal.text() == std::bad_alloc().what());
  CHECK(simulation.solve(registry).refusal().text() == refusal.text());
}

TEST_CASE("a plugin that nobody offers, and one that is not there to be opened") {
  Simulation simulation = small_planar();
  simulation.set("solver.type", "ipop");
  const Refusal unknown = simulation.check(plugins());
  CHECK(unknown.kind() == RefusalKind::wrong_input);
  CHECK(contains(unknown.text(), "did you mean 'ipopt'?"));
  PluginHostOptions nowhere;
  nowhere.executable_path = "";
  PluginHost none(nowhere);
  const Refusal empty = small_planar().check(none);
  CHECK(empty.kind() == RefusalKind::wrong_input);
  CHECK(contains(empty.text(), "unknown solver 'interior-point'; expected an installed solver, but none is; "));
}

}  // namespace bowstring
