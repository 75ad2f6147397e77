#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "core/lie/small_matrix.hpp"
#include "tests/apps/command.hpp"
#include "tests/plugins/plugin_folders.hpp"
#include "tests/writers/vtp_file.hpp"

namespace bowstring::testing {

namespace {

using Json = nlohmann::json;

struct Solved {
  Json document;
  std::string text;
  VtpFile vtp;
};

/// A helical vessel that turns once about its axis, its wire, and the contacts between them, through the command.
const Solved& solved() {
  static const Solved result = [] {
    const TemporaryFolder folder;
    const CommandResult run =
        bowstring_command(folder.path(), {"solve", source_root() + "/scenes/helical-iliac-full.toml", "--out",
                                          "result.json", "--write", "vtp=result.vtp"});
    REQUIRE_MESSAGE(run.exit_code == 0, run.err);
    const std::string text = read_text(folder.path() + "/result.vtp");
    return Solved{Json::parse(read_text(folder.path() + "/result.json")), text, read_vtp(text)};
  }();
  return result;
}

Vector3 vector(const std::array<double, 3>& row) { return Vector3::load(row.data()); }

Vector3 vector(const Json& row) { return {{row[0].get<double>(), row[1].get<double>(), row[2].get<double>()}}; }

/// Why Debian's VTK is not asked; empty where it can be.
std::string without_vtk() {
  if (std::getenv("BOWSTRING_TEST_FULL") == nullptr) return "BOWSTRING_TEST_FULL is not set";
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") == 0) return "";
  std::puts("skipped: /usr/bin/python3 cannot import vtkmodules.vtkIOXML (Debian: python3-vtk9)");
  return "no VTK";
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string out;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) out += buffer;
  CHECK(::pclose(pipe) == 0);
  return out;
}

}  // namespace

TEST_CASE("vtp of a solved scene: centerlines are the document's, with all that it says of their nodes") {
  const auto& [document, text, vtp] = solved();
  std::size_t first = 0;
  for (const Json& curve : document["curves"]) {
    const std::size_t nodes = curve["points"].size();
    REQUIRE(nodes == 60);
    const std::vector<std::size_t> cells = vtp.cells_of(curve["name"].get<std::string>() + ": centerline");
    REQUIRE(cells.size() == 1);
    const std::vector<std::size_t> line = vtp.lines.cell(cells[0]);
    REQUIRE(line.size() == nodes);
    CHECK(line.front() == first);
    double displaced = 0.0;
    for (std::size_t i = 0; i < nodes; ++i) {
      CHECK(vector(vtp.points[line[i]]) == vector(curve["points"][i]));
      const Vector3 displacement = vector(vtp.vectors.at("displacement_mm")[line[i]]);
      CHECK(displacement == vector(curve["points"][i]) - vector(curve["reference_points"][i]));
      displaced += norm(displacement);
      CHECK(vtp.scalars.at("s_mm")[line[i]] == curve["s_mm"][i].get<double>());
      CHECK(vtp.scalars.at("radius_mm")[line[i]] == curve["radius_mm"][i].get<double>());
      CHECK(vtp.scalars.at("curvature_per_mm")[line[i]] == curve["curvature_per_mm"][i].get<double>());
      CHECK(vector(vtp.vectors.at("moment_N_mm")[line[i]]) == vector(curve["moment_N_mm"][i]));
      if (curve["twist_per_mm"].is_null()) {
        CHECK(std::isnan(vtp.scalars.at("twist_per_mm")[line[i]]));
      } else {
        CHECK(vtp.scalars.at("twist_per_mm")[line[i]] == curve["twist_per_mm"][i].get<double>());
      }
    }
    CHECK(displaced > 1.0);
    first += nodes;
  }
}

TEST_CASE("vtp of a solved scene: frames are orthonormal, right-handed, and lie along the curve") {
  const VtpFile& vtp = solved().vtp;
  for (std::size_t i = 0; i < vtp.points.size(); ++i) {
    const Vector3 axes[] = {vector(vtp.vectors.at("frame_1")[i]), vector(vtp.vectors.at("frame_2")[i]),
                            vector(vtp.vectors.at("frame_3")[i])};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) CHECK(std::abs(dot(axes[a], axes[b]) - (a == b ? 1.0 : 0.0)) < 1e-14);
    }
    CHECK(dot(cross(axes[0], axes[1]), axes[2]) > 0.0);
  }
  for (const std::size_t c : {0, 1}) {
    const std::vector<std::size_t> line = vtp.lines.cell(c);
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const Vector3 chord = vector(vtp.points[line[i + 1]]) - vector(vtp.points[line[i - 1]]);
      CHECK(dot(normalized(chord), vector(vtp.vectors.at("frame_1")[line[i]])) > 0.999);
    }
  }
}

TEST_CASE("vtp of a solved scene: surfaces keep the radius and do not twist") {
  const VtpFile& vtp = solved().vtp;
  const std::string names[] = {"iliac: lumen surface", "lunderquist: wire surface"};
  const std::size_t sides[] = {32, 12};
  std::size_t ring = 120;  // behind the nodes of both centerlines
  for (std::size_t s = 0; s < 2; ++s) {
    CHECK(vtp.polygons.cell(vtp.cells_of(names[s]).front()).front() == ring);
    CHECK(vtp.cells_of(names[s]).size() == 59 * 2 * sides[s]);
    const std::vector<std::size_t> line = vtp.lines.cell(s);
    for (std::size_t i = 0; i < line.size(); ++i, ring += sides[s]) {
      const Vector3 center = vector(vtp.points[line[i]]), axis = vector(vtp.vectors.at("frame_1")[line[i]]);
      const double radius = vtp.scalars.at("radius_mm")[line[i]];
      const double turn = i + 1 < line.size() ? dot(axis, vector(vtp.vectors.at("frame_1")[line[i + 1]])) : 1.0;
      for (std::size_t k = 0; k < sides[s]; ++k) {
        const Vector3 spoke = vector(vtp.points[ring + k]) - center;
        CHECK(std::abs(norm(spoke) - radius) < 1e-12);
        CHECK(std::abs(dot(spoke, axis)) < 1e-12);
        CHECK(dot(spoke, vector(vtp.vectors.at("normal")[ring + k])) > 0.8 * radius);
        if (i + 1 == line.size()) continue;
        // Parallel transport moves no direction by more than the curve's own turn.
        const Vector3 next = vector(vtp.points[ring + sides[s] + k]) - vector(vtp.points[line[i + 1]]);
        CHECK(dot(normalized(spoke), normalized(next)) >= turn - 1e-12);
      }
    }
  }
}

TEST_CASE("vtp of a solved scene: contact forces add up to those of the document") {
  const auto& [document, text, vtp] = solved();
  Vector3 expected, sum;
  double forces = 0.0;
  for (const Json& contact : document["contacts"]) {
    expected += contact["force_N"].get<double>() * vector(contact["direction"]);
    forces += contact["force_N"].get<double>();
  }
  REQUIRE(forces > 1.0);
  const std::vector<std::size_t> cells = vtp.cells_of("lunderquist: contact forces on it");
  REQUIRE(cells.size() == document["contacts"].size());
  double norms = 0.0;
  for (const std::array<double, 3>& force : vtp.vectors.at("force_N")) {
    sum += vector(force);
    norms += norm(vector(force));
  }
  CHECK(norm(sum - expected) < 1e-12 * forces);
  CHECK(norms == doctest::Approx(forces).epsilon(1e-12));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t point = vtp.vertices.cell(cells[i]).at(0);
    CHECK(vtp.scalars.at("gap_mm")[point] == document["contacts"][i]["gap_mm"].get<double>());
  }
  CHECK(vtp.fields.at("SPACE") == std::vector<std::string>{"LPS"});
}

TEST_CASE("vtp of a solved scene: VTK reads the same" * doctest::skip(!without_vtk().empty())) {
  const auto& [document, text, vtp] = solved();
  const TemporaryFolder folder;
  const std::string file = folder.write("result.vtp", text);
  const Json read =
      Json::parse(output_of("/usr/bin/python3 '" + source_root() + "/tests/writers/read_vtp.py' '" + file + "'"));
  CHECK(read["points"] == vtp.points.size());
  CHECK(read["vertices"] == vtp.vertices.offsets.size());
  CHECK(read["lines"] == vtp.lines.offsets.size());
  CHECK(read["polygons"] == vtp.polygons.offsets.size());
  CHECK(read["vectors"] == "force_N");
  CHECK(read["normals"] == "normal");
  CHECK(read["fields"] == Json(vtp.fields));
  Vector3 low = vector(vtp.points.front()), high = low, sum;
  for (std::size_t i = 0; i < vtp.points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], vector(vtp.points[i])[k]);
      high[k] = std::max(high[k], vector(vtp.points[i])[k]);
    }
    sum += vector(vtp.vectors.at("force_N")[i]);
  }
  REQUIRE(norm(high - low) > 100.0);
  for (int k = 0; k < 3; ++k) {
    CHECK(read["bounds"][static_cast<std::size_t>(2 * k)] == low[k]);
    CHECK(read["bounds"][static_cast<std::size_t>(2 * k + 1)] == high[k]);
  }
  CHECK(norm(vector(read["force"]) - sum) < 1e-12);
  std::map<std::string, std::int64_t> kinds;
  for (const std::int32_t kind : vtp.cell_data.at("kind")) ++kinds[std::to_string(kind)];
  CHECK(read["kinds"] == Json(kinds));
}

}  // namespace bowstring::testing
