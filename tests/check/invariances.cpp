#include <doctest/doctest.h>

#include "core/check/motion.hpp"
#include "tests/check/checked_scene.hpp"

namespace bowstring::testing {

TEST_CASE("an energy that claims to be objective and is not is caught, and named") {
  Rod rod;
  rod.more = "\n[[energy]]\ntype = \"test-false-objectivity\"\non = \"rod\"\n";
  const CheckReport report = check(*dishonest_session(rod.text())->assembly);
  for (const char* what : {"translation", "rotation"}) {
    CAPTURE(what);
    const CheckLine& line = line_of(report.invariances, "energy 'test-false-objectivity' on 'rod'", what);
    CHECK(line.verdict == CheckVerdict::failed);
    CHECK(line.text == "claims to be objective, and changes");
    CHECK(line.error > 0.1);
    const CheckLine& honest = line_of(report.invariances, "energy 'bending' on 'rod'", what);
    CHECK(honest.verdict == CheckVerdict::ok);
    CHECK(honest.error <= 1e-10);
  }
}

TEST_CASE("angles of material frames follow a rigid rotation") {
  Rod rod;
  rod.dimension = 3;
  rod.geometry = R"(type = "helix", chord = "40 mm", radius = "6 mm", turns = 0.6)";
  rod.frames = true;
  const auto session = session_of_text(rod.text());
  const CheckReport report = check(*session->assembly);
  const CheckLine& line = line_of(report.invariances, "energy 'bending' on 'rod'", "rotation");
  CHECK_MESSAGE(line.verdict == CheckVerdict::ok, line.text);
  CHECK(line.error <= 1e-10);

  // Without the holonomy the energy would change.
  const std::vector<double> q = moved_start(*session, 0.2, 4);
  const checking::Mover mover(*session->assembly);
  std::vector<double> moved, before, after;
  REQUIRE(mover.move(q, 0, {{{0.3, -0.4, 0.5}}, {}, {}}, moved).ok());
  const int angle = 3 * rod.nodes;
  REQUIRE(session->scene->curves[0]->declaration.fields[1].name == "angle");
  double change = 0.0;
  for (int i = 0; i + 1 < rod.nodes; ++i) change += std::fabs(moved[at(angle + i)] - q[at(angle + i)]);
  CHECK(change > 1e-3);
}

TEST_CASE("what holds a scene in place is named, and what drives it") {
  const CheckReport report = check(*session_of_file("planar-iliac-smooth.toml")->assembly);
  CHECK(line_of(report.invariances, "energy 'anchoring' on 'iliac'", "role").text ==
        "resists translation and rotation: it holds 'iliac' in place");
  CHECK(line_of(report.invariances, "vessel 'iliac'", "supports").text == "first end pinned, last end pinned");
  CHECK(line_of(report.invariances, "constraint 'lumen'", "rows").text == "move with the scene");
  const CheckReport loaded = check(*session_of_file("cantilever.toml")->assembly);
  const std::string role = line_of(loaded.invariances, "energy 'point-load' on 'rod'", "role").text;
  CHECK_MESSAGE(role.rfind("drives translation", 0) == 0, role);
  CHECK(line_of(loaded.invariances, "wire 'rod'", "supports").text == "first end clamped");
}

TEST_CASE("rows that stand in space are said to") {
  Rod rod;
  rod.more = "\n[[constraint]]\nname = \"channel\"\ntype = \"test-wrong-jacobian\"\non = [\"rod\"]\n";
  const CheckReport report = check(*dishonest_session(rod.text())->assembly);
  const CheckLine& line = line_of(report.invariances, "constraint 'channel'", "rows");
  CHECK(line.verdict == CheckVerdict::note);
  CHECK(line.text == "feel translation and rotation: they stand in space");
}

}  // namespace bowstring::testing
