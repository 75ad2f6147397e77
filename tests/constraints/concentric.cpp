#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/curve/arc_length.hpp"
#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

SmallScene concentric(int dimension) {
  SmallScene scene;
  scene.dimension = dimension;
  scene.contact_type = "concentric";
  return scene;
}

/// A wire without clearance in a vessel of small sine waves on a foundation.
std::string straightened(const std::string& vessel_kinematics, const std::string& wire_kinematics) {
  return R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "vessel"
geometry = { type = "sinusoid", chord = "300 mm", amplitude = "0.01 mm", periods = 5, nodes = 301, sampling = "uniform-arc" }
kinematics = ")" +
         vessel_kinematics + R"("
[[wire]]
name = "wire"
vessel = "vessel"
radius = "0.4 mm"
kinematics = ")" +
         wire_kinematics + R"("
[[energy]]
type = "wire-bending"
on = "wire"
bending-stiffness = "1000 N mm^2"
[[energy]]
type = "vessel-strain"
on = "vessel"
bending-stiffness = "200 N mm^2"
stretch-stiffness = "11 N"
[[energy]]
type = "anchoring"
on = "vessel"
stiffness = "0.01 N/mm^2"
[[constraint]]
type = "concentric"
on = ["wire", "vessel"]
[solver]
type = "ipopt"
)";
}

}  // namespace

TEST_CASE("the wire lies on the centerline, and the tube pulls across itself") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    const auto session = session_of(concentric(dimension));
    CHECK(session->scene->constraints[0].rows.rows == 5 * (dimension - 1));
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    Readings readings;
    REQUIRE(read_solution(*session, solution, readings).ok());
    const int vessel = session->scene->find("vessel")->view.index;
    double total = 0.0;
    for (const ContactRecord& contact : readings.contacts) {
      CHECK(std::fabs(contact.gap) <= 1e-8);
      CHECK(contact.force >= 0.0);
      total += contact.force;
      // The direction is across the vessel near its place there.
      const std::vector<double>& p = readings.curves[at(vessel)].points;
      const std::vector<double>& arc = session->scene->find("vessel")->arc;
      const auto segment =
          static_cast<std::size_t>(std::upper_bound(arc.begin(), arc.end() - 1, contact.vessel_arc) - arc.begin() - 1);
      double along = 0.0, length = 0.0;
      for (std::size_t k = 0; k < at(dimension); ++k) {
        const double edge = p[(segment + 1) * at(dimension) + k] - p[segment * at(dimension) + k];
        along += edge * contact.direction[k];
        length += edge * edge;
      }
      CHECK(std::fabs(along) <= 0.35 * std::sqrt(length));  // edges turn by up to about 20 degrees from it
    }
    CHECK(total > 1e-3);
  }
}

TEST_CASE("a wire as wide as the lumen or wider is right without clearance") {
  SmallScene scene = concentric(2);
  scene.radius = "\"0.3 mm\"";
  const auto session = session_of(scene);
  const Solution solution = solve(*session, nullptr);
  REQUIRE(solution.certificate.verdict == Verdict::converged);
  CHECK(solution.certificate.pairs.empty());
}

TEST_CASE("small sine waves are straightened as the linear theory says") {
  // Amplitude ratio (EI_v q⁴ + k)/((EI_v + EI_w) q⁴ + k) away from the ends, whose influence has decayed there.
  const double q = 2.0 * M_PI / 60.0, q4 = std::pow(q, 4);
  const double ratio = (200.0 * q4 + 0.01) / (1200.0 * q4 + 0.01);
  REQUIRE(ratio < 0.95);
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    const auto session = session_of_text(straightened(kinematics, "edge-frames"));
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    const Curve& vessel = *session->scene->find("vessel");
    const double* p = solution.q.data() + vessel.coordinate_begin;
    double crest = 0.0;
    for (int i = 130; i <= 170; ++i) crest = std::max(crest, p[2 * i + 1]);
    CHECK(crest / 0.01 == doctest::Approx(ratio).epsilon(2e-3));
  }
}

TEST_CASE("what cannot be concentric is refused in words") {
  std::string text = concentric(2).text();
  text.replace(text.find("on = [\"wire\", \"vessel\"]"), 23, "on = [\"vessel\"]");
  CHECK(refusal_of(text).find("'concentric' acts on a wire and a vessel, in that order") != std::string::npos);
  SmallScene spatial = concentric(2);
  spatial.geometry = R"({ type = "helix", chord = "50 mm", radius = "5 mm", turns = 1, nodes = 8 })";
  CHECK(refusal_of(spatial.text()).find("expected dimension 3; set dimension = 3 in [scene]") != std::string::npos);
}

}  // namespace bowstring::testing
