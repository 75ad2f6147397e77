#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "core/composition/resolved_toml.hpp"
#include "core/measure/given_measure.hpp"
#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::Workbench;
using Texts = std::vector<std::string>;

namespace {

const char* const observed = "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n";

/// A workbench that has the plugins of losses and something to compare with.
struct Bench : Workbench {
  Bench() {
    registry.add(Kind::transport, "exact", {});
    registry.add(Kind::transport, "sinkhorn", {{"epsilon", ParameterType::scalar, "mm^2", "1.0", ""}});
    registry.add(Kind::ground_cost, "euclidean", {});
    registry.add(Kind::ground_cost, "se3", {{"forward-weight", ParameterType::scalar, "1/mm", "1.0", ""}});
    write("observed.csv", observed);
  }
  static std::string scene(const std::string& loss) { return std::string(test::small_scene) + "[[loss]]\n" + loss; }
};

}  // namespace

TEST_CASE("a loss has defaults for all but its two measures") {
  Bench bench;
  const Composition scene = bench.loaded(Bench::scene("on = \"w\"\nagainst = \"observed.csv\"\n"));
  REQUIRE(scene.losses.size() == 1);
  const LossTable& loss = scene.losses.front();
  CHECK(loss.label == "loss");
  CHECK(loss.on == "w");
  CHECK(loss.against == (bench.folder() / "observed.csv").string());
  CHECK(loss.transport.name == "exact");
  CHECK(loss.ground_cost.name == "euclidean");
  CHECK(loss.sampling.points == 0);
  CHECK(loss.sampling.weights == CurveWeights::arc_length);
  REQUIRE(loss.observed != nullptr);
  CHECK(loss.observed->places.count() == 2);
  CHECK(scene.input_files.back() == (bench.folder() / "observed.csv").string());
  const std::vector<const ComponentChoice*> components = components_of(scene);
  CHECK(std::find(components.begin(), components.end(), &loss.transport) != components.end());
  CHECK(std::find(components.begin(), components.end(), &loss.ground_cost) != components.end());
}

TEST_CASE("everything that a loss can say, and it resolves to itself") {
  Bench bench;
  const std::string text = Bench::scene(R"(name = "shape"
on = "v"
against = "observed.csv#curve"
points = 40
weights = "lumen-section"
stations = [{ at = "80 mm", spread = "1 cm", weight = 3 }, { at = 10, spread = 2 }]
transport = { type = "sinkhorn", epsilon = "2 mm^2" }
ground-cost = "se3"
)");
  const Composition scene = bench.loaded(text);
  const CurveSampling& sampling = scene.losses.front().sampling;
  CHECK(sampling.points == 40);
  CHECK(sampling.weights == CurveWeights::lumen_section);
  REQUIRE(sampling.stations.size() == 2);
  CHECK(sampling.stations[0].at == 80.0);
  CHECK(sampling.stations[0].spread == 10.0);
  CHECK(sampling.stations[0].weight == 3.0);
  CHECK(sampling.stations[1].weight == 1.0);
  CHECK(bench.loaded(resolved_toml(scene.resolved_json)).resolved_json == scene.resolved_json);
  const auto loss = nlohmann::ordered_json::parse(scene.resolved_json)["loss"][0];
  CHECK(loss.dump() ==
        R"({"name":"shape","on":"v","against":")" + (bench.folder() / "observed.csv").string() +
            R"(#curve","points":40,"weights":"lumen-section","stations":[{"at":80.0,"spread":10.0,"weight":3.0},)"
            R"({"at":10.0,"spread":2.0,"weight":1.0}],"transport":{"type":"sinkhorn","epsilon":2.0},)"
            R"("ground-cost":{"type":"se3","forward-weight":1.0}})");
}

TEST_CASE("paths lead into a loss, through names of plugins too") {
  Bench bench;
  const std::string text =
      Bench::scene("name = \"shape\"\non = \"w\"\nagainst = \"observed.csv\"\ntransport = \"exact\"\n");
  const auto changed = [&](const std::string& path, const std::string& value) {
    return bench.loaded(text, {{path, value}}).losses.front();
  };
  CHECK(changed("loss.shape.transport.type", "sinkhorn").transport.name == "sinkhorn");
  CHECK(changed("loss.shape.transport", "sinkhorn").transport.name == "sinkhorn");
  CHECK(changed("loss.shape.ground-cost.type", "se3").ground_cost.name == "se3");
  CHECK(changed("loss.shape.points", "7").sampling.points == 7);
  CHECK(bench.loaded(text, {{"loss.shape.transport.type", "sinkhorn"}, {"loss.shape.transport.epsilon", "3"}})
            .losses.front()
            .transport.parameters.scalar("epsilon") == 3.0);
}

TEST_CASE("what is wrong with a loss, all at once") {
  Bench bench;
  CHECK(bench.errors(Bench::scene("weigths = \"uniform\"\n")) ==
        Texts{"scene.toml:28:1: loss 'loss' has no 'on'; expected the curve that is compared; add on = \"<curve>\"",
              "scene.toml:28:1: loss 'loss' has no 'against'; expected what the curve is compared with; add against = "
              "\"observed.csv\" or against = \"result.json#iliac\"",
              "scene.toml:29:1: unknown key 'weigths' in loss 'loss'; expected one of: name, on, against, transport, "
              "ground-cost, points, weights, stations; did you mean 'weights'?"});
  CHECK(
      bench.errors(Bench::scene("on = \"u\"\nagainst = 3\npoints = 0\ntransport = 3\nground-cost = \"euclidian\"\n")) ==
      Texts{
          "scene.toml:29:6: unknown curve 'u' in 'on' of loss 'loss'; expected one of: v, w; name one that the file "
          "has",
          "scene.toml:30:11: 'against' of loss 'loss' is whole number 3; expected text, a file of places or a curve of "
          "a result; write against = \"observed.csv\" or against = \"result.json#iliac\"",
          "scene.toml:31:10: 'points' of loss 'loss' is 0, out of bounds; expected at least 1 and at most 1e+06; write "
          "a "
          "larger number",
          "scene.toml:32:13: 'transport' of loss 'loss' is whole number 3; expected the name of a transport, or a "
          "table with its 'type'; write transport = \"exact\"",
          "scene.toml:33:15: unknown ground-cost 'euclidian'; expected one of: euclidean, se3; did you mean "
          "'euclidean'?"});
}

TEST_CASE("errors of a file that is compared with stand at the place that names it") {
  Bench bench;
  bench.write("bad.csv", "x_mm,y_mm,z_mm,weight\n0,0,0,1\n0,b,0,1\n0,0,0,-1\n");
  const std::string file = (bench.folder() / "bad.csv").string();
  CHECK(
      bench.errors(Bench::scene("on = \"w\"\nagainst = \"bad.csv\"\n")) ==
      Texts{
          "scene.toml:30:11: 'against' of loss 'loss': " + file +
              ":3: place 1: 'b' in column 'y_mm' is no number; expected a number, as 12.5; correct the cell or remove "
              "the row",
          "scene.toml:30:11: 'against' of loss 'loss': " + file +
              ":4: place 2: weight -1; expected a finite number, not negative; leave the place out or mend it"});
  CHECK(
      bench.errors(Bench::scene("on = \"w\"\nagainst = \"observed.csv\"\nstations = [{ at = 1, spread = 1 }]\n")) ==
      Texts{
          "scene.toml:31:1: 'stations' of loss 'loss' against places that have no weights; expected both drawn alike; "
          "write against = \"FILE.csv#curve\" where the rows of the file are a curve in order, or give it a column "
          "'weight'"});
  CHECK(bench.errors(Bench::scene("on = \"w\"\nagainst = \"observed.csv\"\nweights = \"lumen-section\"\n")).size() ==
        1);
  CHECK(
      bench.errors(Bench::scene("on = \"w\"\nagainst = \"none.csv\"\n")) ==
      Texts{
          "scene.toml:30:11: 'against' of loss 'loss': 'none.csv' cannot be read (No such file or directory); "
          "expected a file of places, or a curve of a result document as \"result.json#iliac\"; paths are relative to "
          "the file that they stand in"});
}

TEST_CASE("two losses need two names") {
  Bench bench;
  const std::string one = "on = \"w\"\nagainst = \"observed.csv\"\n";
  CHECK(
      bench.errors(Bench::scene(one + "[[loss]]\n" + one)) ==
      Texts{
          "scene.toml:31:1: duplicate name: loss 'loss', after the loss at scene.toml:28:1; expected a name for each; "
          "add name = \"<name>\" to each"});
}
