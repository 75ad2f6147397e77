#include "kinematics/edge-frames/edge_frames.hpp"
#include "kinematics/nodes/nodes.hpp"
#include "tests/kinematics/curve_cases.hpp"
#include "tests/kinematics/differences.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::testing;

/// Every site that is declared. `bases_are_coordinates`: ζ's basis is carried by the coordinates, so that its numbers
/// can be compared one by one; otherwise only |ζ| has a meaning.
template <class Declared>
void check_all_sites(const Declared& curve, const std::vector<double>& q, bool bases_are_coordinates,
                     Tolerance tolerance = {}) {
  for (const SiteDeclaration& site : curve.declaration.sites) {
    CAPTURE(static_cast<int>(site.site));
    const bool frames_in_space = site.site == Site::frame && curve.curve.dimension == 3;
    const bool own_basis = site.site == Site::station && !bases_are_coordinates;
    if (!frames_in_space && !own_basis) check_site(curve, site.site, q, tolerance);
  }
  check_isotropic_energy(curve, q, tolerance);
}

template <class SomeKinematics>
void check_state(const Case& c, const TestCurve& shape, double perturbation, Tolerance tolerance = {}) {
  CAPTURE(c.text());
  const DeclaredCurve<SomeKinematics> curve(c.dressed(shape), c.needs());
  const bool bases_are_coordinates =
      c.dimension == 2 || c.material_frames || std::is_same_v<SomeKinematics, EdgeFrames>;
  check_all_sites(curve, perturbed(curve, perturbation, 11), bases_are_coordinates, tolerance);
}

TEST_CASE("B and curvature of edge-frames at random states") {
  for (const Case& c : all_cases()) check_state<EdgeFrames>(c, crooked_curve(c.dimension, 6, 3), 0.2);
}

TEST_CASE("B and curvature of nodes at random states") {
  for (const Case& c : all_cases()) check_state<Nodes>(c, crooked_curve(c.dimension, 6, 5), 0.2);
}

TEST_CASE("B and curvature of edge-frames at nearly straight states") {
  for (const Case& c : all_cases()) check_state<EdgeFrames>(c, straight_curve(c.dimension, 6, 12.0), 1e-8);
}

TEST_CASE("B and curvature of nodes at nearly straight states") {
  for (const Case& c : all_cases()) check_state<Nodes>(c, straight_curve(c.dimension, 6, 12.0), 1e-8);
}

TEST_CASE("B and curvature of edge-frames where edges double back") {
  for (const Case& c : all_cases()) {
    check_state<EdgeFrames>(c, zigzag(c.dimension, 6, M_PI - 0.05, 9), 1e-3, {1e-8, 1e-7});
    // A direction's derivatives grow like 1/sin of the turn, a rotation's stay bounded up to a half turn.
    if (c.dimension == 2 || c.material_frames) check_state<EdgeFrames>(c, zigzag(c.dimension, 6, M_PI - 1e-3, 9), 1e-6);
  }
}

TEST_CASE("B and curvature of nodes where edges double back") {
  for (const Case& c : all_cases()) check_state<Nodes>(c, zigzag(c.dimension, 6, M_PI - 0.05, 9), 1e-3, {1e-8, 1e-7});
}

TEST_CASE("a frame's tangent numbers are those of the orientation field") {
  for (const int dimension : {2, 3}) {
    for (const bool material_frames : {false, true}) {
      const Case c{dimension, material_frames, Extension::stretching, Ends::free};
      const DeclaredCurve<EdgeFrames> curve(c.dressed(crooked_curve(dimension, 5, 3)), c.needs());
      const SiteDeclaration& site = curve.site(Site::frame);
      CHECK(site.identity);
      CHECK(site.values == site.width);
      const std::vector<double> b = curve.jacobian(Site::frame, curve.start());
      const int position_numbers = dimension * 5;
      for (int r = 0; r < site.count * site.values; ++r) {
        for (int u = 0; u < curve.unknowns(); ++u) {
          CHECK(b[at(r * curve.unknowns() + u)] == (u == position_numbers + r ? 1.0 : 0.0));
        }
      }
    }
  }
}

/// Coordinates of edge-frames with the positions and the frames of a state of nodes.
std::vector<double> as_edge_frames(const DeclaredCurve<Nodes>& nodes, const std::vector<double>& q,
                                   const DeclaredCurve<EdgeFrames>& frames, const lie::Rotation& turn) {
  std::vector<double> middles;
  for (int i = 0; i + 1 < nodes.curve.nodes(); ++i) middles.push_back(i + 0.5);
  CurveSample sample;
  REQUIRE(nodes.kinematics.sample(q, middles, sample).ok());
  std::vector<double> out = frames.start();
  for (int i = 0; i < nodes.curve.nodes(); ++i) (turn * Vector3::load(q.data() + 3 * i)).store(out.data() + 3 * i);
  const int begin = frames.coordinate_begin("orientation");
  for (int i = 0; i + 1 < nodes.curve.nodes(); ++i) {
    (turn * lie::Rotation::load(sample.orientation.data() + 4 * i)).store(out.data() + begin + 4 * i);
  }
  return out;
}

TEST_CASE("angles and positions carry the strain of the frames that they sample, whatever its rigid rotation") {
  const Case c{3, true, Extension::stretching, Ends::free};
  const DeclaredCurve<Nodes> nodes(c.dressed(crooked_curve(3, 8, 5)), c.needs());
  const DeclaredCurve<EdgeFrames> frames(c.dressed(crooked_curve(3, 8, 5)), c.needs());
  CHECK(nodes.unknowns() == 3 * 8 + 7);
  CHECK(frames.unknowns() == 3 * 8 + 3 * 7 + 7);
  for (const double size : {0.0, 1e-8, 0.3}) {
    const std::vector<double> q = perturbed(nodes, size, 17);
    const std::vector<double> strain = nodes.values(Site::station, q);
    REQUIRE(strain.size() == 3 * 6);
    for (const Vector3& axis : {Vector3{{0.0, 0.0, 0.0}}, Vector3{{0.4, -1.1, 2.6}}}) {
      const std::vector<double> expected =
          frames.values(Site::station, as_edge_frames(nodes, q, frames, lie::exp(axis)));
      double norm = 0.0;
      for (std::size_t k = 0; k < strain.size(); ++k) {
        norm += strain[k] * strain[k];
        CHECK(std::fabs(strain[k] - expected[k]) <= 1e-14);
      }
      REQUIRE(norm > 0.1);
    }
  }
}

TEST_CASE("a start that differs from State 1 has Bishop frames in both kinematics") {
  const Case c{3, true, Extension::stretching, Ends::free};
  TestCurve curve = crooked_curve(3, 8, 5);
  curve.start = crooked_curve(3, 8, 6).reference;
  const DeclaredCurve<Nodes> nodes(curve, c.needs());
  const DeclaredCurve<EdgeFrames> frames(curve, c.needs());
  const std::vector<double> strain = nodes.values(Site::station, nodes.start());
  const std::vector<double> expected = frames.values(Site::station, frames.start());
  REQUIRE(strain.size() == expected.size());
  for (std::size_t k = 0; k < strain.size(); ++k) {
    CHECK(std::fabs(strain[k] - expected[k]) <= 1e-14);
    if (k % 3 == 0) CHECK(std::fabs(strain[k]) <= 1e-14);
  }
}

TEST_CASE("an edge that points against State 1 stops nodes with angles in words") {
  const Case c{3, true, Extension::stretching, Ends::free};
  const DeclaredCurve<Nodes> nodes(straight_curve(3, 5, 8.0), c.needs());
  std::vector<double> q = nodes.start();
  for (int k = 0; k < 3; ++k) q[at(3 + k)] = -q[at(3 + k)];
  std::vector<double> out(at(nodes.site(Site::station).count * 3));
  const Status status = nodes.kinematics.evaluate({Site::station, q, out, {}, {}, {}});
  REQUIRE(status.code == Code::failed);
  CHECK(status.text ==
        "edge 0 of 'test' (nodes 0 and 1) points against its direction in State 1, so that its frame cannot follow it: "
        "use kinematics = \"edge-frames\"");
}

}  // namespace
