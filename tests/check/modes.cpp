#include <doctest/doctest.h>

#include "tests/check/checked_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr const char* helix = R"(type = "helix", chord = "40 mm", radius = "6 mm", turns = 0.6)";
constexpr const char* free_ends = "; nothing resists, so that the equilibrium is not unique";

CheckReport report_of(const Rod& rod) { return check(*session_of_text(rod.text())->assembly); }

std::string rigid(const CheckReport& report) { return line_of(report.modes, "'rod'", "rigid motions").text; }

void check_no_soft_modes(const CheckReport& report) {
  CHECK(line_of(report.modes, "the scene", "soft modes").text == "no other mode is near zero");
}

Rod spatial(const char* kinematics, const char* ends, bool frames) {
  Rod rod;
  rod.dimension = 3;
  rod.kinematics = kinematics;
  rod.ends = ends;
  rod.frames = frames;
  return rod;
}

}  // namespace

TEST_CASE("a free rod's rigid modes are named: three in the plane") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    Rod rod;
    rod.kinematics = kinematics;
    const CheckReport report = report_of(rod);
    CHECK(rigid(report) == std::string("3 free: translations along every axis and a rotation") + free_ends);
    check_no_soft_modes(report);
    CHECK(report.verdict() == CheckVerdict::note);
  }
}

TEST_CASE("six in space; about its own axis a straight rod turns only where it has frames") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    Rod rod = spatial(kinematics, R"(["free", "free"])", false);
    const std::string five = "5 free: translations along every axis and rotations about every axis across x";
    CHECK(rigid(report_of(rod)) == five + free_ends);
    rod.frames = true;
    const CheckReport twisting = report_of(rod);
    CHECK(rigid(twisting) == five + free_ends);
    CHECK(line_of(twisting.modes, "'rod'", "twist").text == std::string("it may turn about its tangent") + free_ends);
    rod.geometry = helix;
    const CheckReport curved = report_of(rod);
    CHECK(rigid(curved) ==
          std::string("6 free: translations along every axis and rotations about every axis") + free_ends);
    check_no_soft_modes(curved);
  }
}

TEST_CASE("a rod that is pinned at one end turns about it, at both about the chord, or twists") {
  Rod rod = spatial("edge-frames", R"(["pinned", "free"])", false);
  CHECK(rigid(report_of(rod)) ==
        std::string("2 free: rotations about every axis across x through (0, 0, 0) mm") + free_ends);
  rod.dimension = 2;
  CHECK(rigid(report_of(rod)) == std::string("1 free: a rotation about (0, 0) mm") + free_ends);

  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    Rod held = spatial(kinematics, R"(["pinned", "pinned"])", true);
    const CheckReport straight = report_of(held);
    CHECK(line_of(straight.modes, "'rod'", "twist").text == std::string("it may turn about its tangent") + free_ends);
    check_no_soft_modes(straight);
    held.geometry = helix;
    const std::string about_chord = rigid(report_of(held));
    CHECK_MESSAGE(contains(about_chord, "1 free: a rotation about (0.96"), about_chord);
    held.ends = R"(["clamped", "pinned"])";
    CHECK(rigid(report_of(held)) == "the ends hold them all");
  }
}

TEST_CASE("springs and ends that hold a curve are believed") {
  Rod rod;
  rod.more = "\n[[energy]]\ntype = \"anchoring\"\non = \"rod\"\nstiffness = \"0.02 N/mm\"\n";
  const CheckReport report = report_of(rod);
  CHECK(rigid(report) == "ends and energies hold them all");
  check_no_soft_modes(report);
}

TEST_CASE("rigid motions that energies resist only farther away are near zero at the start") {
  Rod rod;
  rod.more = "\n[[energy]]\ntype = \"test-slack\"\non = \"rod\"\n";
  const CheckReport report = check(*dishonest_session(rod.text())->assembly);
  CHECK(rigid(report) == "ends and energies hold them all");
  CHECK(line_of(report.modes, "'rod'", "soft modes").text ==
        "3 near zero: at the start it is free to move as a rigid body");
}

TEST_CASE("a load along a free translation has no equilibrium; one that a pinned rod hangs from has") {
  Rod rod;
  rod.more = "\n[[energy]]\ntype = \"point-load\"\non = \"rod\"\nforce = [\"0 N\", \"0.5 N\"]\nat = \"last\"\n";
  rod.ends = R"([{ position = ["free", "held"], axes = "end", tangent = [1, 1] }, "free"])";  // rails at 45 degrees
  const CheckReport driven = report_of(rod);
  CHECK(line_of(driven.modes, "'rod'", "rigid motions").verdict == CheckVerdict::failed);
  CHECK(rigid(driven).find("a load drives that and nothing resists: there is no equilibrium") != std::string::npos);
  rod.ends = R"(["pinned", "free"])";
  const CheckReport hanging = report_of(rod);
  CHECK(rigid(hanging) == "ends and energies hold them all");
  check_no_soft_modes(hanging);
}

TEST_CASE("a wire that only its lumen holds is said to") {
  SmallScene scene;
  scene.vessel_kinematics = scene.wire_kinematics = "edge-frames";
  const auto session = session_of_text([&] {
    std::string text = scene.text();
    const std::string sliding = "ends = [\"pinned\", \"pinned\"]\n[[energy]]\ntype = \"wire-bending\"";
    const std::size_t place = text.find(sliding);
    REQUIRE(place != std::string::npos);
    text.replace(place, sliding.size(),
                 "ends = [\"free\", \"free\"]\nlength = \"fixed\"\n[[energy]]\ntype = \"wire-bending\"");
    const std::size_t tension = text.find("[[energy]]\ntype = \"axial-tension\"");
    REQUIRE(tension != std::string::npos);
    text.erase(tension, text.find("[[constraint]]") - tension);
    return text;
  }());
  const CheckReport report = check(*session->assembly);
  CHECK(line_of(report.modes, "'wire'", "rigid motions").text ==
        "3 free: translations along every axis and a rotation; inequality rows alone can hold that");
  CHECK(line_of(report.modes, "'vessel'", "rigid motions").text == "the ends hold them all");
}

TEST_CASE("nodes that may slide along their curve are found and counted") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    const CheckReport report = check(
        *session_of_text(
             "schema = 1\n[scene]\ndimension = 3\n[[vessel]]\nname = \"tube\"\ngeometry = { type = \"line\", length = "
             "\"100 mm\", nodes = 9 }\nradius = \"5 mm\"\nkinematics = \"" +
             std::string(kinematics) +
             "\"\nends = [\"pinned\", \"pinned\"]\n[[energy]]\ntype = \"vessel-strain\"\non = "
             "\"tube\"\nbending-stiffness = "
             "\"1000 N mm^2\"\n[solver]\ntype = \"ipopt\"\n")
             ->assembly);
    const CheckLine& line = line_of(report.modes, "'tube'", "soft modes");
    CHECK(line.verdict == CheckVerdict::note);
    CHECK(line.text == "7 near zero: its nodes may slide along it");
  }
}

}  // namespace bowstring::testing
