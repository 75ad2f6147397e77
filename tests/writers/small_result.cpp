#include "tests/writers/small_result.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/composition/defaults.hpp"
#include "core/interfaces/writer.hpp"
#include "core/model/scene.hpp"
#include "plugins/host/plugin_host.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::testing {

std::string small_result(int dimension) {
  const bool space = dimension == 3;
  const auto point = [&](const char* xy, const char* z) {
    return std::string("[") + xy + (space ? std::string(", ") + z : "") + "]";
  };
  const std::string low = point("0, 0", "0"), middle = point("50, 0", "3"), high = point("100, 0", "0");
  const std::string moved = point("50, 2", "3");
  return R"({"format": "bowstring.result/1", "status": "converged", "reason": "all thresholds of the certificate hold",
 "composition": {"title": "Small & straight", "vessel": [{"name": "iliac", "geometry": {"type": "line"}}]},
 "energy": {"total": 12.5},
 "quantities": {"peak_displacement_mm": 2.0, "contact_count": 2, "contact_force_N": 5.0},
 "curves": [
  {"name": "iliac", "kind": "vessel", "s_mm": [0, 50.04, 100.08], "points": [)" +
         low + ", " + moved + ", " + high + R"(],
   "reference_points": [)" +
         low + ", " + middle + ", " + high + R"(], "radius_mm": [6, 5, 6],
   "curvature_per_mm": [0, 0.0016, 0], "frames": [[1, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]], "moment_N_mm": )" +
         (space ? "[[1, 2, 3], [4, 5, 6], [7, 8, 9]]" : "[3, 6, 9]") + R"(},
  {"name": "wire, stiff", "kind": "wire", "s_mm": [0, 30, 70, 100], "points": [)" +
         low + ", " + point("30, 0", "1") + ", " + point("70, 0", "1") + ", " + high + R"(], "reference_points": [)" +
         low + ", " + point("30, 0", "1") + ", " + point("70, 0", "1") + ", " + high +
         R"(], "radius_mm": [0.4, 0.4, 0.4, 0.4],
   "curvature_per_mm": [0, 0, 0, null],
   "frames": [[0, 1, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0]], "twist_per_mm": null}],
 "contacts": [
  {"wire": "wire, stiff", "vessel": "iliac", "wire_edge": 1, "t": 0.0, "gap_mm": -0.125,
   "direction": )" +
         point("0, 1", "0") + R"(, "s_mm": 30, "force_N": 1.0},
  {"wire": "wire, stiff", "vessel": "iliac", "wire_edge": 1, "t": 0.75, "gap_mm": 0.0,
   "direction": )" +
         point("0.6, -0.8", "0") + R"(, "s_mm": 70, "force_N": 4.0}],
 "supports": [{"on": "iliac", "end": "first"}, {"on": "iliac", "end": "last"}, {"on": "wire, stiff", "end": "first"}]}
)";
}

std::string edited_result(std::string text, const std::string& word, const std::string& by) {
  const std::size_t at = text.find(word);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(word, at + 1) == std::string::npos);
  return text.replace(at, word.size(), by);
}

Written written(const std::string& writer, const std::string& document) {
  PluginHostOptions options;
  if (const char* folders = std::getenv("BOWSTRING_PLUGIN_PATH")) options.environment_path = folders;
  static PluginHost host(options);
  Status status;
  ComponentChoice choice;
  choice.kind = Kind::writer;
  choice.name = writer;
  choice.descriptor = host.find(Kind::writer, writer, status);
  REQUIRE_MESSAGE(choice.descriptor != nullptr, status.text);
  choice.parameters = default_parameters(*choice.descriptor);
  const auto made = create<Writer>(choice, status);
  REQUIRE_MESSAGE(made != nullptr, status.text);
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/file";
  status = made->write(document.c_str(), file.c_str());
  if (!status.ok()) return {false, status.text};
  std::ifstream in(file, std::ios::binary);
  return {true, std::string(std::istreambuf_iterator<char>(in), {})};
}

}  // namespace bowstring::testing
