#include <doctest/doctest.h>

#include <cmath>

#include "core/model/start_shape.hpp"
#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct Solved {
  std::unique_ptr<Session> session;
  Solution solution;
  Readings readings;

  const CurveRecord& curve(const std::string& name) const {
    return readings.curves[at(session->scene->find(name)->view.index)];
  }
};

Solved solved(const std::string& text) {
  Solved out;
  out.session = session_of_text(text);
  out.solution = solve(*out.session, nullptr);
  CAPTURE(out.solution.solver.reason);
  REQUIRE(out.solution.certificate.verdict == Verdict::converged);
  REQUIRE(read_solution(*out.session, out.solution, out.readings).ok());
  return out;
}

/// A straight rod of 100 mm with EI 1000 N mm² in the plane.
std::string rod(const std::string& kinematics, const std::string& ends, const std::string& more = "") {
  return "schema = 1\n[scene]\ndimension = 2\n[[wire]]\nname = \"rod\"\nradius = 0.1\nkinematics = \"" + kinematics +
         "\"\ngeometry = { type = \"line\", length = 100, nodes = 41 }\nends = " + ends +
         "\n[[energy]]\ntype = \"wire-bending\"\non = \"rod\"\nbending-stiffness = 1000\n" + more +
         "[solver]\ntype = \"ipopt\"\n";
}

/// A straight vessel of 100 mm in space with GJ 133 N mm².
std::string tube(const std::string& kinematics, const std::string& ends) {
  return "schema = 1\n[scene]\ndimension = 3\n[[vessel]]\nname = \"tube\"\nkinematics = \"" + kinematics +
         "\"\ngeometry = { type = \"line\", length = 100, nodes = 41 }\nends = " + ends +
         "\n[[energy]]\ntype = \"vessel-strain\"\non = \"tube\"\nbending-stiffness = 2000\n"
         "torsional-stiffness = 133\nstretch-stiffness = 500\n[solver]\ntype = \"ipopt\"\n";
}

}  // namespace

TEST_CASE("a turned end rolls a rod up into whole circles, from either end, to rounding") {
  const double energy = 0.5 * 1000.0 * std::pow(4.0 * M_PI, 2) / 100.0;
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    for (const char* ends : {R"(["clamped", { rotation = "held", turn = "720 deg" }])",
                             R"([{ rotation = "held", turn = "-720 deg" }, "clamped"])",
                             R"([{ type = "clamped", turn = "-360 deg" }, { rotation = "held", turn = "360 deg" }])"}) {
      CAPTURE(kinematics);
      CAPTURE(ends);
      const Solved rolled = solved(rod(kinematics, ends));
      CHECK(rolled.readings.term_energy[0] == doctest::Approx(energy).epsilon(1e-12));
      const std::vector<double>& p = rolled.curve("rod").points;
      CHECK(std::hypot(p[p.size() - 2] - p[0], p[p.size() - 1] - p[1]) <= 1e-10);
    }
  }
}

TEST_CASE("whole turns between two held ends survive in both kinematics") {
  for (const char* turn : {"180 deg", "270 deg", "540 deg", "-270 deg"}) {
    CAPTURE(turn);
    double energy[2] = {};
    for (const bool nodes : {false, true}) {
      std::string text =
          rod(nodes ? "nodes" : "edge-frames",
              std::string(R"(["clamped", { type = "clamped", move = [-60, 10], turn = ")") + turn + "\" }]");
      energy[nodes ? 1 : 0] = solved(edited(text, "nodes = 41", "nodes = 81")).readings.term_energy[0];
    }
    REQUIRE(energy[0] > 100.0);
    CHECK(energy[1] == doctest::Approx(energy[0]).epsilon(1e-9));
  }
}

TEST_CASE("turns that node positions have no room for are refused in words") {
  // The ends stay a whole rod's length apart, so that no start of its length winds once.
  const std::string ends = R"(["clamped", { type = "clamped", turn = "360 deg" }])";
  CHECK(refusal_of(rod("nodes", ends)).find("use kinematics = \"edge-frames\"") != std::string::npos);
  CHECK(session_of_text(rod("edge-frames", ends)) != nullptr);
}

TEST_CASE("a held edge stays where it is, whatever the other end does") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    for (const char* other :
         {R"({ rotation = "held", turn = "60 deg" })", R"({ position = ["free", "held"], move = [0, 20] })",
          R"({ type = "clamped", turn = "60 deg", move = [-5, 0] })"}) {
      CAPTURE(kinematics);
      CAPTURE(other);
      const Solved held = solved(rod(kinematics, std::string(R"(["held-edge", )") + other + "]"));
      const std::vector<double>& p = held.curve("rod").points;
      CHECK(std::vector<double>(p.begin(), p.begin() + 4) == std::vector<double>{0.0, 0.0, 2.5, 0.0});
    }
  }
}

TEST_CASE("a rigid vessel ignores its ends, and hands State 1's tangents to its wire") {
  SmallScene scene;
  scene.wire_ends = R"(["clamped", "free"])";
  const auto plain = session_of_text(edited(scene.text(), "ends = ", "rigid = true\nends = "));
  scene.vessel_ends =
      R"([{ type = "clamped", tangent = [1, 5], move = [0, 3] }, { type = "clamped", turn = "60 deg" }])";
  const auto ignored = session_of_text(edited(scene.text(), "ends = ", "rigid = true\nends = "));
  CHECK(plain->scene->start_coordinates() == ignored->scene->start_coordinates());
  for (int k = 0; k < 2; ++k) {
    CHECK(plain->scene->find("wire")->view.end[0].tangent[k] == ignored->scene->find("wire")->view.end[0].tangent[k]);
  }
}

TEST_CASE("a solver comes back to the circle from a perturbed start") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    const auto session =
        session_of_text(rod(kinematics, R"(["clamped", { rotation = "held", turn = "360 deg", position = "free" }])"));
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    SolverContext context;
    SolverResult result;
    REQUIRE(session->solver->solve(*session->assembly, moved_start(*session, 0.2, 5), context, result).ok());
    CHECK(result.iterations >= 2);
    double energy = 0.0;
    ProblemEvaluation evaluation;
    evaluation.energy = &energy;
    REQUIRE(session->assembly->evaluate(result.q, evaluation).ok());
    CHECK(energy == doctest::Approx(0.5 * 1000.0 * std::pow(2.0 * M_PI, 2) / 100.0).epsilon(1e-12));
  }
}

TEST_CASE("a turn about the tangent twists, whole turns counted, as a number or as a vector") {
  const double moment = 133.0 * 4.0 * M_PI / 100.0;
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    for (const char* turn : {R"("720 deg")", R"(["720 deg", 0, 0])"}) {
      CAPTURE(kinematics);
      CAPTURE(turn);
      const Solved twisted =
          solved(tube(kinematics, std::string(R"(["clamped", { type = "clamped", turn = )") + turn + " }]"));
      CHECK(twisted.readings.term_energy[0] == doctest::Approx(0.5 * moment * 4.0 * M_PI).epsilon(1e-10));
      REQUIRE(twisted.readings.supports.size() == 2);
      CHECK(twisted.readings.supports[1].moment[0] == doctest::Approx(moment).epsilon(1e-9));
      CHECK(twisted.readings.supports[0].moment[0] == doctest::Approx(-moment).epsilon(1e-9));
    }
  }
}

TEST_CASE("an end held along one of its own axes slides along the other, and its support pulls along the held one") {
  // A roller at 45 degrees under a rod that is clamped at its first end.
  const std::string ends = R"(["clamped", { position = ["free", "held"], axes = "end", tangent = [1, 1] }])";
  const std::string load = "[[energy]]\ntype = \"point-load\"\non = \"rod\"\nforce = [0, -0.4]\nat = 50\n";
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(kinematics);
    const Solved rolled = solved(rod(kinematics, ends, load));
    const std::vector<double>& p = rolled.curve("rod").points;
    const double dx = p[p.size() - 2] - 100.0, dy = p[p.size() - 1];
    CHECK(std::fabs(dx) > 1e-3);
    CHECK(std::fabs(dy - dx) <= 1e-9);
    REQUIRE(rolled.readings.supports.size() == 2);
    const SupportRecord& roller = rolled.readings.supports[1];
    CHECK(roller.force[1] > 0.01);
    CHECK(roller.force[0] == doctest::Approx(-roller.force[1]).epsilon(1e-7));
    const SupportRecord& root = rolled.readings.supports[0];
    CHECK(std::fabs(root.force[0] + roller.force[0]) <= 1e-7);
    CHECK(std::fabs(root.force[1] + roller.force[1] - 0.4) <= 1e-7);
  }
}

TEST_CASE("a move in the end's axes is one along the tangent") {
  const auto end_of = [](const std::string& end) {
    const Solved moved = solved(rod("edge-frames", "[\"clamped\", " + end + "]"));
    const std::vector<double>& p = moved.curve("rod").points;
    return std::vector<double>(p.end() - 2, p.end());
  };
  const std::vector<double> global = end_of(R"({ type = "pinned", move = [-3, 1] })");
  const std::vector<double> own = end_of(R"({ type = "pinned", move = [-3, 1], axes = "end" })");
  CHECK(global == std::vector<double>{97.0, 1.0});
  CHECK(own == global);  // the rod runs along x
  const std::vector<double> turned = end_of(R"({ type = "pinned", move = [-3, 0], axes = "end", tangent = [3, 4] })");
  CHECK(turned[0] == doctest::Approx(98.2).epsilon(1e-12));
  CHECK(turned[1] == doctest::Approx(-2.4).epsilon(1e-12));
}

TEST_CASE("turned edges are put together from the end that is held") {
  CurveView view;
  view.dimension = 2;
  view.nodes = 5;
  for (int k = 0; k < 2; ++k) view.end[1].position_held[k] = true;
  Turn turn[2];
  turn[0].rotation[2] = 1.0;
  std::vector<double> points = {0, 0, 1, 0, 2, 0, 3, 0, 4, 0}, edge_turn;
  spread_turns(turn, view, {0, 1, 2, 3, 4}, points, edge_turn);
  CHECK(edge_turn == std::vector<double>{0.875, 0.625, 0.375, 0.125});
  CHECK(points[8] == 4.0);
  CHECK(points[9] == 0.0);
  for (int i = 0; i < 4; ++i) {
    const double dx = points[at(2 * i + 2)] - points[at(2 * i)], dy = points[at(2 * i + 3)] - points[at(2 * i + 1)];
    CHECK(std::atan2(dy, dx) == doctest::Approx(edge_turn[at(i)]).epsilon(1e-14));
    CHECK(std::hypot(dx, dy) == doctest::Approx(1.0).epsilon(1e-14));
  }
}

TEST_CASE("the chord of a sliding wire is State 1's, with what its ends are moved by, however the start is turned") {
  const auto prepared = [](const std::string& ends) {
    return session_of_file("planar-iliac-smooth.toml", {{"wire.lunderquist.ends", ends}});
  };
  const double tension = 10.0;
  const auto check = [&](const std::string& ends, double chord) {
    CAPTURE(ends);
    const auto session = prepared(ends);
    const Curve& wire = *session->scene->find("lunderquist");
    CHECK(wire.view.end_distance == doctest::Approx(chord).epsilon(1e-14));
    const std::vector<double> q = session->scene->start_coordinates();
    std::vector<double> energies;
    REQUIRE(session->assembly->term_energies(q, energies).ok());
    for (std::size_t e = 0; e < energies.size(); ++e) {
      if (session->scene->energies[e].plugin != "axial-tension") continue;
      CHECK(energies[e] == doctest::Approx(tension * (wire.view.start_length - chord)).epsilon(1e-12));
    }
    double lower = 0.0;  // of the only length that is bounded from so high
    for (const double bound : session->assembly->lower()) lower = std::max(lower, std::isfinite(bound) ? bound : 0.0);
    CHECK(lower == doctest::Approx(0.5 * chord).epsilon(1e-14));
    return wire.start;
  };
  const std::string roller = R"({ position = ["held", "free"], axes = "end" })";
  const std::vector<double> straight = check(R"([{ type = "clamped" }, )" + roller + "]", 150.0);
  const std::vector<double> turned = check(R"([{ type = "clamped", turn = "5 deg" }, )" + roller + "]", 150.0);
  REQUIRE(std::fabs(turned.back() - straight.back()) > 1.0);
  check(R"([{ type = "pinned", move = ["-2 mm", "3 mm"] }, "pinned"])", std::hypot(152.0, 3.0));
}

}  // namespace bowstring::testing
