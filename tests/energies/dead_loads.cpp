#include <doctest/doctest.h>

#include <cmath>

#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// A free rod in the plane, 100 mm long with EI 1000 N mm², clamped at its first end.
std::string rod(const std::string& load, const std::string& more = "", const std::string& kinematics = "edge-frames") {
  return "schema = 1\n[scene]\ndimension = 2\n[[wire]]\nname = \"rod\"\nradius = 0.1\nkinematics = \"" + kinematics +
         "\"\ngeometry = { type = \"line\", length = 100, nodes = 41 }\nends = [\"clamped\", \"free\"]\n" + more +
         "[[energy]]\ntype = \"wire-bending\"\non = \"rod\"\nbending-stiffness = 1000\n[[energy]]\non = \"rod\"\n" +
         load + "[solver]\ntype = \"ipopt\"\n";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Solved {
  std::unique_ptr<Session> session;
  Solution solution;
  Readings readings;

  explicit Solved(const std::string& text) : session(session_of_text(text)), solution(solve(*session, nullptr)) {
    REQUIRE_MESSAGE(solution.certificate.verdict == Verdict::converged, solution.certificate.reason);
    REQUIRE(read_solution(*session, solution, readings).ok());
  }
  double x(int node) const { return readings.curves[0].points[at(2 * node)]; }
  double y(int node) const { return readings.curves[0].points[at(2 * node + 1)]; }
};

}  // namespace

TEST_CASE("a dead moment rolls a cantilever up: n full circles bring the tip back to the root, to rounding") {
  for (const int turns : {1, 2}) {
    const double moment = 1000.0 * 2.0 * 3.14159265358979323846 * turns / 100.0;
    char text[80];
    std::snprintf(text, sizeof text, "type = \"dead-moment\"\nmoment = \"%.17g N mm\"\n", moment);
    const Solved solved{rod(text)};
    CHECK(std::hypot(solved.x(40), solved.y(40)) < 1e-8);
    CHECK(solved.y(20 / turns) > 10.0 / turns);  // half a circle up
    CHECK(solved.readings.curves[0].curvature[20] == doctest::Approx(moment / 1000.0).epsilon(1e-9));
  }
}

TEST_CASE("supports take what the loads give") {
  const Solved solved{rod("type = \"point-load\"\nforce = [\"-0.02 N\", \"0.3 N\"]\nat = \"37 mm\"\n")};
  REQUIRE(solved.readings.supports.size() == 1);
  CHECK(solved.readings.supports[0].force[0] == doctest::Approx(0.02).epsilon(1e-8));
  CHECK(solved.readings.supports[0].force[1] == doctest::Approx(-0.3).epsilon(1e-8));
}

TEST_CASE("a force between two nodes is shared so that neither force nor lever arm is lost") {
  // Small loads: superposition of the two neighbouring nodes' solutions.
  const auto tip = [](const std::string& place) {
    return Solved{rod("type = \"point-load\"\nforce = [0, \"1e-4 N\"]\nat = " + place + "\n")}.y(40);
  };
  const double left = tip("50"), right = tip("52.5"), between = tip("51");
  REQUIRE(right > left);
  CHECK(between == doctest::Approx(0.6 * left + 0.4 * right).epsilon(1e-5));
  CHECK(tip("\"last\"") == doctest::Approx(1e-4 * 1e6 / 3000.0).epsilon(1e-3));
  CHECK(tip("100") == doctest::Approx(tip("\"last\"")).epsilon(1e-12));
}

TEST_CASE("loads that cannot act are refused in words, or warned of") {
  const std::string force = "type = \"point-load\"\nforce = [0, 1]\n";
  CHECK(contains(refusal_of(rod(force + "at = \"130 mm\"\n")),
                 "'at' is 130 mm; expected at most the 100 mm that 'rod' is long in State 1"));
  CHECK(contains(refusal_of(rod(force + "at = \"middle\"\n")),
                 "'at' of energy 'point-load' is text \"middle\"; expected a quantity in mm, at least 0, or 'first' or "
                 "'last'"));
  CHECK(contains(refusal_of(rod("type = \"point-load\"\nforce = [1, 2, 3]\n")),
                 "'force' has 3 entries; expected one per dimension of the scene, 2"));
  CHECK(contains(refusal_of(rod("type = \"dead-moment\"\nmoment = 1\n", "", "nodes")),
                 "energy 'dead-moment' reads frames, which kinematics 'nodes' of 'rod' does not have; expected a "
                 "kinematics that has them; use kinematics = \"edge-frames\""));
  const auto session = session_of_text(rod(force + "at = \"first\"\n"));
  REQUIRE(session->scene->warnings.size() == 1);
  CHECK(session->scene->warnings[0] ==
        "point-load acts on the first end of 'rod', whose position is held: the support takes it");
  SmallScene sliding;
  CHECK(contains(refusal_of(sliding.text() + "[[energy]]\non = \"wire\"\n" + force + "at = 10\n"),
                 "'at' is an arc length of 'wire', whose material slides"));
}

TEST_CASE("a dead force that nothing resists is refused: no minimum exists") {
  const std::string up = "type = \"point-load\"\nforce = [0, 0.5]\nat = \"last\"\n";
  const std::string unheld = edited(rod(up), R"(["clamped", "free"])", R"(["free", "free"])");
  CHECK(
      contains(refusal_of(unheld),
               "nothing holds 'rod' against a dead force of (0, 0.5) N: it would move away without end, and no minimum "
               "exists; expected an end that is held, a constraint, or an energy of its position; hold an end, or add "
               "an anchoring"));
  // Two that cancel, or tissue that holds the rod, leave a minimum.
  CHECK(session_of_text(
            edited(unheld, "[solver]",
                   "[[energy]]\nname = \"down\"\non = \"rod\"\ntype = \"point-load\"\nforce = [0, -0.5]\nat = "
                   "\"first\"\n[solver]")) != nullptr);
  CHECK(session_of_text(
            edited(unheld, "[solver]",
                   "[[energy]]\non = \"rod\"\ntype = \"anchoring\"\nstiffness = \"0.1 N/mm^2\"\n[solver]")) != nullptr);
}

TEST_CASE("a rod without a vessel has a fixed length, and to let it slide is refused with the reason") {
  const std::string force = "type = \"point-load\"\nforce = [0, 1]\n";
  CHECK(session_of_text(rod(force))->scene->find("rod")->view.extension == Extension::fixed);
  CHECK(contains(refusal_of(rod(force, "length = \"sliding\"\n")),
                 "wire 'rod' slides, but has an end that is free along it; expected both ends held, and a vessel: "
                 "otherwise the wire withdraws and no minimum exists; write length = \"fixed\", or hold its ends"));
}

}  // namespace bowstring::testing
