#include <doctest/doctest.h>

#include <cmath>

#include "core/lie/s2.hpp"
#include "core/result/carry.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct Solved {
  std::unique_ptr<Session> session;
  Solution solution;
  CarriedState state;
};

Solved solved(const std::string& text, const CarriedState* from = nullptr) {
  Solved out;
  out.session = session_of_text(text, from);
  out.solution = solve(*out.session, nullptr);
  REQUIRE_MESSAGE(out.solution.certificate.verdict == Verdict::converged, out.solution.certificate.reason);
  Readings readings;
  REQUIRE(read_solution(*out.session, out.solution, readings).ok());
  out.state = carry(*out.session, out.solution, readings, "the state before");
  out.state.becomes_rest = true;
  return out;
}

/// Energy of the vessel where the session starts.
double vessel_energy(Session& session) {
  std::vector<double> energies;
  const std::vector<double> own = session.scene->start_coordinates();
  REQUIRE(session.assembly->term_energies(session.start.q.empty() ? own : session.start.q, energies).ok());
  double sum = 0.0;
  for (std::size_t e = 0; e < energies.size(); ++e) {
    if (session.scene->curves[at(session.scene->energies[e].curve)]->name == "vessel") sum += energies[e];
  }
  return sum;
}

const Curve& vessel_of(const Session& session) { return *session.scene->find("vessel"); }

/// The direction that an end holds at the start of a solve.
Vector3 held_direction(const Session& session, int e) {
  const EndCondition& end = vessel_of(session).view.end[e];
  return lie::exp(Vector3::load(end.turn)) * Vector3::load(end.tangent);
}

}  // namespace

TEST_CASE("the state before becomes the vessel's rest state: no stress there, and nothing else changes") {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"edge-frames", "nodes"}) {
      for (const bool frames : {false, true}) {
        for (const char* ends : {R"(["pinned", "pinned"])", R"(["clamped", "clamped"])"}) {
          if (frames && dimension == 2) continue;
          CAPTURE(dimension);
          CAPTURE(kinematics);
          CAPTURE(frames);
          CAPTURE(ends);
          SmallScene scene;
          scene.dimension = dimension;
          scene.vessel_kinematics = kinematics;
          scene.vessel_frames = frames;
          scene.vessel_ends = ends;
          const Solved first = solved(scene.text());
          REQUIRE(vessel_energy(*session_of_text(scene.text())) < 1e-25);
          double moved = 0.0;
          const Curve& before = vessel_of(*first.session);
          const std::vector<double>& recorded = first.state.state->find("vessel")->points;
          moved = largest_difference(recorded, before.reference);
          REQUIRE(moved > 0.1);

          const auto session = session_of_text(scene.text(), &first.state);
          const Curve& vessel = vessel_of(*session);
          CHECK(vessel.reference == recorded);
          CHECK(vessel.state1 == before.reference);
          CHECK(vessel.arc == before.arc);
          CHECK(vessel.radius == before.radius);
          CHECK(vessel_energy(*session) < 1e-18);
          const Curve& wire = *session->scene->find("wire");
          const Curve& wire_before = *first.session->scene->find("wire");
          CHECK(wire.reference == wire_before.reference);
          CHECK(wire.edge_length == wire_before.edge_length);
          CHECK(wire.view.end_distance == wire_before.view.end_distance);
          CHECK(wire.state1.empty());

          // The wire pushes on from there: a larger energy of the vessel again, and less of the wire's.
          const Solution second = solve(*session, nullptr);
          CHECK(second.certificate.verdict == Verdict::converged);
          CHECK(largest_difference(second.q, session->start.q) > 0.01);
        }
      }
    }
  }
}

TEST_CASE("a rest state on another mesh, and of a chain of states, is without stress as well") {
  SmallScene scene;
  scene.dimension = 3;
  scene.vessel_frames = true;
  scene.vessel_ends = R"(["clamped", "clamped"])";
  const Solved first = solved(scene.text());
  const std::string finer = edited(scene.text(), "nodes = 8 }", "nodes = 15 }");
  const Solved second = solved(finer, &first.state);
  CHECK(vessel_energy(*session_of_text(finer, &first.state)) < 1e-18);
  const auto third = session_of_text(finer, &second.state);
  CHECK(vessel_energy(*third) < 1e-18);
  CHECK(vessel_of(*third).state1 == vessel_of(*second.session).state1);
  CHECK(largest_difference(vessel_of(*third).reference, vessel_of(*second.session).reference) > 0.01);
  // Without becoming the rest state, State 1 is it again.
  CarriedState plain = second.state;
  plain.becomes_rest.reset();
  const auto again = session_of_text(finer, &plain);
  CHECK(vessel_of(*again).state1.empty());
  CHECK(vessel_energy(*again) > 0.1);
}

TEST_CASE("moves and turns count from State 1, whatever the rest state") {
  const auto ends = [](double turn, double move, int dimension) {
    const std::string angles =
        dimension == 2 ? std::to_string(turn) : "[0, " + std::to_string(0.5 * turn) + ", " + std::to_string(turn) + "]";
    const std::string way =
        dimension == 2 ? "[" + std::to_string(move) + ", 0.5]" : "[" + std::to_string(move) + ", 0.5, 0.25]";
    return R"(["clamped", { type = "clamped", turn = )" + angles + ", move = " + way + " }]";
  };
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"edge-frames", "nodes"}) {
      CAPTURE(dimension);
      CAPTURE(kinematics);
      SmallScene scene;
      scene.dimension = dimension;
      scene.vessel_kinematics = kinematics;
      scene.vessel_frames = dimension == 3;
      scene.wire_ends = R"(["pinned", "free"])";
      scene.tension = false;
      scene.vessel_ends = ends(0.2, 1.0, dimension);
      const Solved first = solved(scene.text());
      const Vector3 held = held_direction(*first.session, 1);

      // The same composition again: at rest where it is.
      const auto same = session_of_text(scene.text(), &first.state);
      CHECK(vessel_energy(*same) < 1e-18);
      CHECK(norm(held_direction(*same, 1) - held) < 1e-13);

      scene.vessel_ends = ends(0.3, 1.5, dimension);
      const auto further = session_of_text(scene.text(), &first.state);
      const auto afresh = session_of_text(scene.text());
      CHECK(norm(held_direction(*further, 1) - held_direction(*afresh, 1)) < 1e-13);
      REQUIRE(norm(held_direction(*further, 1) - held) > 0.05);
      const int last = (vessel_of(*further).view.nodes - 1) * dimension;
      for (int k = 0; k < dimension; ++k) {
        CHECK(vessel_of(*further).start[at(last + k)] == vessel_of(*afresh).start[at(last + k)]);
      }
      CHECK(vessel_energy(*further) > 1e-6);
      CHECK(solve(*further, nullptr).certificate.verdict == Verdict::converged);
    }
  }
}

TEST_CASE("an end that is held along an axis of its own stays where State 1 has it") {
  SmallScene scene;
  scene.vessel_ends = R"(["pinned", { position = ["held", "free"], axes = "end", move = [0.5, 0] }])";
  scene.wire_ends = R"(["pinned", "free"])";
  scene.tension = false;
  const Solved first = solved(scene.text());
  const auto again = session_of_text(scene.text(), &first.state);
  CHECK(vessel_energy(*again) < 1e-16);
  const Solution solution = solve(*again, nullptr);
  CHECK(solution.certificate.verdict == Verdict::converged);
  const auto axes = [](const Session& session) {
    for (const ConstraintUse& use : session.scene->constraints) {
      if (!use.held_axes.empty()) return use.held_axes.front();
    }
    FAIL("no held axis");
    return HeldAxis{};
  };
  CHECK(axes(*again).value == axes(*first.session).value);
}

TEST_CASE("a vessel that was clamped only now begins at the direction that it is turned from") {
  for (const int dimension : {2, 3}) {
    SmallScene scene;
    scene.dimension = dimension;
    scene.vessel_frames = dimension == 3;
    const Solved first = solved(scene.text());
    scene.vessel_ends = R"(["clamped", "pinned"])";
    const auto session = session_of_text(scene.text(), &first.state);
    const Curve& vessel = vessel_of(*session);
    const auto own = session_of_text(scene.text());
    CHECK(norm(held_direction(*session, 0) - held_direction(*own, 0)) < 1e-13);
    REQUIRE(norm(Vector3::load(vessel.view.end[0].turn)) > 1e-4);
    CHECK(solve(*session, nullptr).certificate.verdict == Verdict::converged);
  }
}

TEST_CASE("a vessel that becomes rigid stays where it was left") {
  SmallScene scene;
  const Solved first = solved(scene.text());
  const std::string rigid = edited(scene.text(), "radius = " + scene.radius, "rigid = true\nradius = " + scene.radius);
  const auto session = session_of_text(rigid, &first.state);
  const Curve& vessel = vessel_of(*session);
  const std::vector<double>& recorded = first.state.state->find("vessel")->points;
  CHECK(vessel.start == recorded);
  CHECK(std::equal(recorded.begin(), recorded.end(), session->start.q.begin() + vessel.coordinate_begin));
  CHECK(solve(*session, nullptr).certificate.verdict == Verdict::converged);
}

TEST_CASE("a state without the vessel's shape becomes no rest state") {
  SmallScene scene;
  Solved first = solved(scene.text());
  RecordedState older = *first.state.state;
  older.curves.clear();
  first.state.state = std::make_shared<const RecordedState>(older);
  first.state.position = "here";
  CHECK(refusal_of(scene.text(), &first.state) ==
        "here: the state before has 'vessel' with no entry in 'curves'; expected its shape, which becomes the rest "
        "state; start from a result that this version wrote");
}

}  // namespace bowstring::testing
