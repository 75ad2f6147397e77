#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "core/lie/small_matrix.hpp"
#include "tests/writers/small_result.hpp"
#include "tests/writers/vtp_file.hpp"

namespace bowstring::testing {

namespace {

using Names = std::vector<std::string>;
using Triple = std::array<double, 3>;

VtpFile file(const std::string& document) {
  const Written result = written("vtp", document);
  REQUIRE_MESSAGE(result.good, result.text);
  return read_vtp(result.text);
}

template <class Table>
Names keys(const Table& table) {
  Names out;
  for (const auto& entry : table) out.push_back(entry.first);
  return out;
}

}  // namespace

TEST_CASE("vtp: parts, their kinds and what they are called") {
  const VtpFile vtp = file(small_result(3));
  CHECK(vtp.fields.at("part_names") == Names{"iliac: centerline", "wire, stiff: centerline", "iliac: lumen surface",
                                             "wire, stiff: wire surface", "wire, stiff: contact forces on it"});
  CHECK(vtp.fields.at("kind_names") ==
        Names{"vessel centerline", "wire centerline", "lumen surface", "wire surface", "contact forces"});
  CHECK(vtp.points.size() == 3 + 4 + 32 * 3 + 12 * 4 + 2);
  CHECK(vtp.vertices.offsets.size() == 2);
  CHECK(vtp.lines.offsets.size() == 2);
  CHECK(vtp.polygons.offsets.size() == 2 * (32 * 2 + 12 * 3));
  CHECK(vtp.lines.cell(0) == std::vector<std::size_t>{0, 1, 2});
  CHECK(vtp.lines.cell(1) == std::vector<std::size_t>{3, 4, 5, 6});
  const std::vector<std::int32_t>&part = vtp.cell_data.at("part"), &kind = vtp.cell_data.at("kind");
  REQUIRE(part.size() == kind.size());
  CHECK(kind == part);  // as many parts here as kinds, in the same order
  CHECK(vtp.cells_of("wire, stiff: contact forces on it").size() == 2);
  CHECK(std::set<std::int32_t>(part.begin(), part.end()).size() == 5);
}

TEST_CASE("vtp: the axes are stated where 3D Slicer looks for them, and in words") {
  const std::string words = "LPS, mm: x to the patient's left, y to posterior, z to superior";
  const VtpFile generated = file(small_result(3));
  CHECK(generated.fields.at("SPACE") == Names{"LPS"});
  CHECK(generated.fields.at("coordinates") ==
        Names{words + "; the scene is generated, not measured, and its own x, y, z are written as such"});
  const VtpFile measured = file(edited_result(small_result(3), R"("type": "line")", R"("type": "csv")"));
  CHECK(measured.fields.at("SPACE") == Names{"LPS"});
  CHECK(measured.fields.at("coordinates") == Names{words});
  CHECK(measured.fields.at("title") == Names{"Small & straight"});
  CHECK(measured.fields.at("status") == Names{"converged: all thresholds of the certificate hold"});
  CHECK(written("vtp", small_result(3)).text.find("<!-- SPACE=LPS:") != std::string::npos);
}

TEST_CASE("vtp: nodes hold the numbers of the document") {
  const VtpFile vtp = file(small_result(3));
  CHECK(keys(vtp.scalars) == Names{"curvature_per_mm", "gap_mm", "radius_mm", "s_mm"});  // no curve has a twist
  CHECK(keys(vtp.vectors) ==
        Names{"displacement_mm", "force_N", "frame_1", "frame_2", "frame_3", "moment_N_mm", "normal"});
  CHECK(vtp.active_vectors == "force_N");
  CHECK(vtp.active_normals == "normal");
  CHECK(vtp.points[0] == Triple{0.0, 0.0, 0.0});
  CHECK(vtp.points[1] == Triple{50.0, 2.0, 3.0});
  CHECK(vtp.points[2] == Triple{100.0, 0.0, 0.0});
  CHECK(vtp.points[6] == Triple{100.0, 0.0, 0.0});
  CHECK(vtp.scalars.at("s_mm")[1] == 50.04);
  CHECK(vtp.scalars.at("radius_mm")[1] == 5.0);
  CHECK(vtp.scalars.at("curvature_per_mm")[1] == 0.0016);
  CHECK(std::isnan(vtp.scalars.at("curvature_per_mm")[6]));
  CHECK(std::isnan(vtp.scalars.at("gap_mm")[1]));
  CHECK(vtp.vectors.at("displacement_mm")[1] == Triple{0.0, 2.0, 0.0});
  CHECK(vtp.vectors.at("moment_N_mm")[1] == Triple{4.0, 5.0, 6.0});
  CHECK(std::isnan(vtp.vectors.at("moment_N_mm")[3][0]));
  CHECK(vtp.vectors.at("force_N")[1] == Triple{0.0, 0.0, 0.0});
  // The wire's frame is half a turn about x.
  CHECK(vtp.vectors.at("frame_1")[3] == Triple{1.0, 0.0, 0.0});
  CHECK(vtp.vectors.at("frame_2")[3] == Triple{0.0, -1.0, 0.0});
  CHECK(vtp.vectors.at("frame_3")[3] == Triple{0.0, 0.0, -1.0});
}

TEST_CASE("vtp: in the plane the third coordinate is 0 and moments are about the third axis") {
  const VtpFile vtp = file(small_result(2));
  CHECK(vtp.points[1] == Triple{50.0, 2.0, 0.0});
  for (const std::size_t line : {0, 1}) {
    for (const std::size_t i : vtp.lines.cell(line)) CHECK(vtp.points[i][2] == 0.0);
  }
  CHECK(vtp.vectors.at("moment_N_mm")[1] == Triple{0.0, 0.0, 6.0});
}

TEST_CASE("vtp: contacts stand at their place on the wire, with force and gap") {
  const VtpFile vtp = file(small_result(2));
  const std::vector<std::size_t> cells = vtp.cells_of("wire, stiff: contact forces on it");
  REQUIRE(cells.size() == 2);
  const std::size_t first = vtp.vertices.cell(cells[0]).at(0), second = vtp.vertices.cell(cells[1]).at(0);
  CHECK(vtp.points[first] == Triple{30.0, 0.0, 0.0});
  CHECK(vtp.points[second] == Triple{60.0, 0.0, 0.0});  // edge 1 from 30 to 70, three quarters along
  CHECK(vtp.scalars.at("s_mm")[second] == 60.0);
  CHECK(vtp.vectors.at("frame_2")[second] == Triple{0.0, -1.0, 0.0});
  CHECK(vtp.vectors.at("force_N")[first] == Triple{0.0, 1.0, 0.0});
  CHECK(vtp.vectors.at("force_N")[second][0] == doctest::Approx(2.4).epsilon(1e-15));
  CHECK(vtp.vectors.at("force_N")[second][1] == doctest::Approx(-3.2).epsilon(1e-15));
  CHECK(vtp.scalars.at("gap_mm")[first] == -0.125);
  CHECK(vtp.scalars.at("gap_mm")[second] == 0.0);
}

TEST_CASE("vtp: a surface has a ring around every node, at the node's radius, and faces outward") {
  const VtpFile vtp = file(small_result(3));
  const double radius[] = {6.0, 5.0, 6.0};
  std::set<std::size_t> seen;
  for (const std::size_t c : vtp.cells_of("iliac: lumen surface")) {
    const std::vector<std::size_t> corners = vtp.polygons.cell(c);
    REQUIRE(corners.size() == 3);
    Vector3 at[3], out;
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = Vector3::load(vtp.points[corners[k]].data());
      const std::size_t node = (corners[k] - 7) / 32;  // behind the nodes of both centerlines
      const Vector3 spoke = at[k] - Vector3::load(vtp.points.at(node).data());
      CHECK(std::abs(norm(spoke) - radius[node]) < 1e-12);
      CHECK(std::abs(spoke[0]) < 1e-12);  // the frames' first axis is x
      CHECK(vtp.scalars.at("radius_mm")[corners[k]] == radius[node]);
      out += Vector3::load(vtp.vectors.at("normal")[corners[k]].data());
      seen.insert(corners[k]);
    }
    CHECK(dot(cross(at[1] - at[0], at[2] - at[0]), out) > 0.0);
    CHECK(dot(out, (at[0] + at[1] + at[2]) / 3.0 - Vector3{{at[0][0], 1.0, 1.5}}) > 0.0);
  }
  CHECK(seen.size() == 3 * 32);
}

TEST_CASE("vtp: what is not there is left out") {
  std::string document = edited_result(small_result(2), "[0.4, 0.4, 0.4, 0.4]", "null");
  document = edited_result(document, "\"force_N\": 4.0", "\"force_N\": null");
  const VtpFile vtp = file(document);
  CHECK(vtp.fields.at("part_names") ==
        Names{"iliac: centerline", "wire, stiff: centerline", "iliac: lumen surface",
              "wire, stiff: contact forces on it, without 1 rows whose force is unknown"});
  CHECK(vtp.points.size() == 3 + 4 + 3 * 32 + 1);
  CHECK(vtp.vertices.offsets.size() == 1);

  const std::size_t contacts = document.find("\"contacts\""), supports = document.find("\"supports\"");
  REQUIRE(contacts < supports);
  const VtpFile free = file(document.erase(contacts, supports - contacts));
  CHECK(free.vertices.offsets.empty());
  CHECK(free.active_vectors == "displacement_mm");
  CHECK(free.scalars.count("gap_mm") == 0);
  CHECK(free.vectors.count("force_N") == 0);
}

TEST_CASE("vtp: a twist is written where a curve has one, and the others have no number") {
  const VtpFile vtp =
      file(edited_result(small_result(3), "\"twist_per_mm\": null", "\"twist_per_mm\": [0, 0.5, 1, 2]"));
  const std::vector<double>& twist = vtp.scalars.at("twist_per_mm");
  CHECK(std::isnan(twist[0]));
  CHECK(twist[4] == 0.5);
  CHECK(twist[6] == 2.0);
}

}  // namespace bowstring::testing
