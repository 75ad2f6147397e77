#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/measure/given_measure.hpp"
#include "core/simulation/simulation.hpp"
#include "core/transport/transport_comparison.hpp"
#include "plugins/host/plugin_host.hpp"
#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::bowstring_command;
using testing::CommandResult;
using testing::contains;
using testing::read_text;
using testing::TemporaryFolder;

namespace {

using Json = nlohmann::ordered_json;

const char* const observed =
    "x_mm,y_mm,z_mm\n0,0,0\n20,12,0\n40,15,0\n60,9,0\n80,-3,0\n100,-12,0\n120,-13,0\n150,0,0\n";

std::string scene(const std::string& more) {
  return "schema = 1\nbase = \"" + testing::source_root() + "/studies/scenes/planar-iliac-coarse.toml\"\n" + more;
}

Json solved(const TemporaryFolder& folder, const std::string& text, const std::vector<std::string>& more = {}) {
  folder.write("scene.toml", text);
  std::vector<std::string> arguments{"solve", "scene.toml", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult result = bowstring_command(folder.path(), arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return Json::parse(result.out);
}

}  // namespace

TEST_CASE("losses: the same value from a composition, from the command and in process") {
  const TemporaryFolder folder;
  folder.write("observed.csv", observed);
  folder.write("weighted.csv", "x_mm,y_mm,z_mm,weight\n10,5,0,0.25\n70,3,0,0.5\n140,-6,0,0.25\n");
  const std::string by_arc = "weights = \"arc-length\"\n", by_volume = "weights = \"lumen-section\"\npoints = 31\n";
  for (const auto& [against, sampling] :
       {std::pair(std::string("observed.csv"), by_arc), {"observed.csv#curve", by_arc}, {"weighted.csv", by_volume}}) {
    CAPTURE(against);
    CAPTURE(sampling);
    const std::string text =
        scene("[[loss]]\nname = \"shape\"\non = \"iliac\"\nagainst = \"" + against + "\"\n" + sampling);
    const Json found = solved(folder, text, {"--out", "r.json"})["losses"][0];
    std::vector<std::string> arguments{"transport", "r.json#iliac", against, "--json", "--weights", "arc-length"};
    if (contains(sampling, "lumen")) {
      arguments.back() = "lumen-section";
      arguments.insert(arguments.end(), {"--points", "31"});
    }
    const CommandResult command = bowstring_command(folder.path(), arguments);
    REQUIRE_MESSAGE(command.exit_code == 0, command.err);
    const Json by_command = Json::parse(command.out);
    CHECK(by_command["value"] == found["value"]);
    CHECK(by_command["plan"] == found["plan"]);
    CHECK(by_command["gradient"]["positions_a"] == found["gradient"]["positions"]);
    CHECK(by_command["gradient"]["frames_a"] == found["gradient"]["frames"]);

    PluginHost plugins;
    const SimulationResult result = Simulation::from_file(folder.path() + "/scene.toml").solve(plugins);
    REQUIRE_MESSAGE(result.ok(), result.refusal().text());
    CHECK(result.number("losses.shape.value").value == found["value"].get<double>());

    std::vector<InputError> errors;
    const auto given = [&](const std::string& name) {
      const MeasureName measure = measure_name(folder.path() + "/" + name);
      return *read_given_measure(measure, read_text(measure.file), errors);
    };
    CurveSampling how{contains(sampling, "lumen") ? 31 : 0, CurveWeights::arc_length, {}};
    if (contains(sampling, "lumen")) how.weights = CurveWeights::lumen_section;
    Refusal refused;
    auto transport = TransportComparison::open({"exact", "euclidean", {}}, plugins, refused);
    REQUIRE_MESSAGE(transport, refused.text());
    TransportResult compared;
    const Status status = transport->compare(measure_of(given("r.json#iliac"), how, true, errors)->measure,
                                             measure_of(given(against), how, true, errors)->measure, compared);
    CHECK(status.ok());
    CHECK(compared.answer.value == found["value"].get<double>());
  }
}

}  // namespace bowstring
