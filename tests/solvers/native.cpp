#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"
#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const char* const line = R"({ type = "line", length = "100 mm", nodes = 41 })";
const char* const wave = R"({ type = "sinusoid", chord = "100 mm", amplitude = "10 mm", periods = 1, nodes = 41 })";

/// A wire of fixed length along a tube, its last end moved.
struct Moved {
  std::string geometry = line, radius = "4 mm", move = R"(["0 mm", "15 mm"])", end = "pinned";
  std::string kinematics = "edge-frames", solver = "interior-point", stiffness = "1000 N mm^2";
  bool rigid = true;
  std::string text() const {
    std::string out =
        "schema = 1\n[scene]\ndimension = 2\n[[vessel]]\nname = \"tube\"\ngeometry = " + geometry + "\nradius = \"" +
        radius + "\"\nkinematics = \"" + kinematics + "\"\n" + (rigid ? "rigid = true\n" : "") +
        "[[wire]]\nname = \"rod\"\nvessel = \"tube\"\nlength = \"fixed\"\nnodes = 41\nradius = \"0.4 mm\"\n"
        "kinematics = \"" +
        kinematics + "\"\nends = [\"" + end + "\", { type = \"" + end + "\", move = " + move +
        " }]\n[[energy]]\ntype = \"wire-bending\"\non = \"rod\"\nbending-stiffness = \"" + stiffness + "\"\n";
    if (!rigid) {
      out +=
          "[[energy]]\ntype = \"vessel-strain\"\non = \"tube\"\nbending-stiffness = \"200 N mm^2\"\n"
          "stretch-stiffness = \"11 N\"\n[[energy]]\ntype = \"anchoring\"\non = \"tube\"\nstiffness = \"0.0128 "
          "N/mm^2\"\n";
    }
    return out +
           "[[constraint]]\nname = \"lumen\"\ntype = \"node-wise-contact\"\non = [\"rod\", \"tube\"]\n[solver]\ntype = "
           "\"" +
           solver + "\"\n";
  }
};

Solution solved_moved(const Moved& moved) { return solved(session_of_text(moved.text())).solution; }

/// A wire that slides along a vessel with all stiffnesses, by either solver.
struct Sliding {
  int dimension = 2, vessel_nodes = 20, wire_nodes = 55;
  std::string geometry, radius, wire_radius, ends, kinematics = "edge-frames";
  std::string wire_bending, vessel_bending, torsion, stretch, anchoring, tension = "0 N";
  std::string contact = "node-wise-contact", gap = "squared", solver = "interior-point";
  std::string text() const {
    const std::string kind = "\nkinematics = \"" + kinematics + "\"\n";
    return "schema = 1\n[scene]\ndimension = " + std::to_string(dimension) +
           "\n[[vessel]]\nname = \"tube\"\ngeometry = { " + geometry + ", nodes = " + std::to_string(vessel_nodes) +
           " }\nradius = \"" + radius + "\"" + kind +
           "[[wire]]\nname = \"rod\"\nvessel = \"tube\"\nnodes = " + std::to_string(wire_nodes) + "\nradius = \"" +
           wire_radius + "\"\nends = " + ends + kind +
           "[[energy]]\ntype = \"wire-bending\"\non = \"rod\"\nbending-stiffness = \"" + wire_bending +
           "\"\n[[energy]]\ntype = \"vessel-strain\"\non = \"tube\"\nbending-stiffness = \"" + vessel_bending +
           "\"\ntorsional-stiffness = \"" + torsion + "\"\nstretch-stiffness = \"" + stretch +
           "\"\n[[energy]]\ntype = \"anchoring\"\non = \"tube\"\nstiffness = \"" + anchoring +
           "\"\n[[energy]]\ntype = \"axial-tension\"\non = \"rod\"\ntension = \"" + tension +
           "\"\n[[constraint]]\nname = \"lumen\"\ntype = \"" + contact + "\"\non = [\"rod\", \"tube\"]\ngap = \"" +
           gap + "\"\n[solver]\ntype = \"" + solver + "\"\n";
  }
};

/// By both solvers; the wire, or what it does to the vessel, is there to be seen: rows of the wall stand.
void check_converges(Sliding sliding, int most_iterations) {
  for (const char* solver : {"interior-point", "active-set"}) {
    CAPTURE(std::string(solver));
    sliding.solver = solver;
    const SolvedScene scene = solved(session_of_text(sliding.text()));
    REQUIRE(contact_rows(scene.assembly()).count > 0);
    CHECK_MESSAGE(scene.solution.certificate.verdict == Verdict::converged, scene.solution.certificate.reason);
    CHECK(scene.solution.solver.iterations < most_iterations);
  }
}

/// The largest angle between neighbouring edges of a wire, in degrees.
double largest_turn(const Session& session, const std::vector<double>& q, const char* name) {
  const Curve& wire = *session.scene->find(name);
  const double* p = q.data() + wire.coordinate_begin;
  double out = 0.0;
  for (int i = 1; i + 1 < wire.view.nodes; ++i) {
    const double before[2] = {p[2 * i] - p[2 * i - 2], p[2 * i + 1] - p[2 * i - 1]};
    const double after[2] = {p[2 * i + 2] - p[2 * i], p[2 * i + 3] - p[2 * i + 1]};
    const double turn =
        std::atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
    out = std::max(out, std::fabs(turn) * 180.0 / std::acos(-1.0));
  }
  return out;
}

}  // namespace

TEST_CASE("an end that is held outside of a rigid lumen: infeasible, with the place") {
  for (const char* solver : {"interior-point", "active-set"}) {
    for (const char* kinematics : {"edge-frames", "nodes"}) {
      for (const char* geometry : {line, wave}) {
        CAPTURE(std::string(solver));
        CAPTURE(std::string(kinematics));
        CAPTURE(std::string(geometry));
        Moved moved;
        moved.solver = solver;
        moved.kinematics = kinematics;
        moved.geometry = geometry;
        const Solution solution = solved_moved(moved);
        const Certificate& found = solution.certificate;
        INFO(found.reason);
        CHECK(found.verdict == Verdict::infeasible);
        CHECK(solution.solver.claim == Claim::infeasible);
        CHECK(found.penetration > 5.0);
        CHECK(contains(found.reason, "the rows cannot hold together: "));
        CHECK(contains(found.reason, " rows of 'lumen' fail, row 38 the most, by "));
        const std::size_t place = found.reason.find(" in row 38 of 'lumen' (wire 'rod' at s = ");
        REQUIRE(place != std::string::npos);
        // Next to the end that is held outside, at its mesh's distance from the vessel's end.
        const double wire_s = std::stod(found.reason.substr(found.reason.find("s = ", place) + 4));
        const double vessel_s = std::stod(found.reason.substr(found.reason.find("vessel 'tube' at s = ", place) + 21));
        CHECK(wire_s > 95.0);
        CHECK(vessel_s > 95.0);
        CHECK(solution.solver.iterations < 60);
      }
    }
  }
}

TEST_CASE("the same in an elastic vessel: it gives way, and the wall that is crossed at the held end is told") {
  Moved moved;
  moved.geometry = wave;
  moved.rigid = false;
  const Certificate found = solved_moved(moved).certificate;
  INFO(found.reason);
  CHECK(found.penetration <= 1e-8);
  CHECK(found.verdict == Verdict::invalid);
  CHECK(contains(found.reason, "wire 'rod' passes through the wall of 'tube' between its rows"));
}

TEST_CASE("a wire that is too short for its held ends: infeasible, its edges fail all alike") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    CAPTURE(std::string(kinematics));
    Moved moved;
    moved.kinematics = kinematics;
    moved.move = R"(["5 mm", "0 mm"])";
    const Solution solution = solved_moved(moved);
    const Certificate& found = solution.certificate;
    INFO(found.reason);
    CHECK(found.verdict == Verdict::infeasible);
    CHECK(found.penetration == doctest::Approx(5.0 / 40.0).epsilon(1e-2));
    CHECK(contains(found.reason, " in row 0 of 'rod.closure' (edge 0 of 'rod' at s = 0 mm)"));

    Moved curved = moved;
    curved.geometry = R"({ type = "sinusoid", chord = "100 mm", amplitude = "10 mm", periods = 0.5, nodes = 41 })";
    curved.radius = "30 mm";
    curved.move = R"(["15 mm", "0 mm"])";
    const Certificate pulled = solved_moved(curved).certificate;
    INFO(pulled.reason);
    CHECK(pulled.verdict == Verdict::infeasible);
    CHECK(contains(pulled.reason, " of 'rod.closure' (edge "));
  }
}

TEST_CASE("a wire that is too long for a tight tube is infeasible, in a wide one it buckles") {
  Moved tight;
  tight.geometry = R"({ type = "sinusoid", chord = "100 mm", amplitude = "2 mm", periods = 1, nodes = 41 })";
  tight.radius = "0.6 mm";
  tight.move = R"(["-20 mm", "0 mm"])";
  const Certificate found = solved_moved(tight).certificate;
  INFO(found.reason);
  CHECK(found.verdict == Verdict::infeasible);
  CHECK(contains(found.reason, " rows of 'lumen' fail, row "));
  Moved wide = tight;
  wide.radius = "6 mm";
  wide.move = R"(["-3 mm", "0 mm"])";
  CHECK(solved_moved(wide).certificate.verdict == Verdict::converged);
}

TEST_CASE("a rod that is exactly straight and shortened leaves its axis, however stiff it is") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    for (const char* end : {"pinned", "clamped"}) {
      for (const char* stiffness : {"1000 N mm^2", "50 N mm^2"}) {
        CAPTURE(std::string(kinematics));
        CAPTURE(std::string(end));
        CAPTURE(std::string(stiffness));
        Moved moved;
        moved.kinematics = kinematics;
        moved.end = end;
        moved.stiffness = stiffness;
        moved.move = R"(["-5 mm", "0 mm"])";
        const Solution solution = solved_moved(moved);
        INFO(solution.certificate.reason);
        CHECK(solution.certificate.verdict == Verdict::converged);
        CHECK(solution.certificate.second_order.curvature == Curvature::minimum);
      }
    }
  }
}

TEST_CASE("a pushed wire: a curve that lies against the wall is an equilibrium, one that coils has none") {
  struct Push {
    const char* tension;
    const char* rigid;
    bool diverges;
  };
  for (const char* solver : {"interior-point", "active-set"}) {
    // EI/(2c²) = 1.05 N. Elastic walls and meshes leave local minima beyond it.
    for (const Push& push : {Push{"-1 N", "false", false}, Push{"-2 N", "false", false}, Push{"-20 N", "false", true},
                             Push{"-20 N", "true", true}}) {
      CAPTURE(std::string(solver));
      CAPTURE(std::string(push.tension));
      CAPTURE(std::string(push.rigid));
      const SolvedScene scene = solved(session_of_file(
          "planar-iliac-smooth.toml", {{"energy.axial-tension.tension", std::string("\"") + push.tension + "\""},
                                       {"vessel.iliac.rigid", push.rigid},
                                       {"solver.type", solver}}));
      const Certificate& found = scene.solution.certificate;
      INFO(found.reason);
      if (push.diverges) {
        CHECK(found.verdict == Verdict::diverged);
        CHECK(contains(found.reason, "the energy falls without a bound: from "));
        CHECK(contains(found.reason, " while the length of a sliding wire (unknown "));
      } else {
        CHECK(found.verdict == Verdict::converged);
        CHECK(found.second_order.curvature == Curvature::minimum);
        CHECK(largest_turn(*scene.session, scene.solution.q, "lunderquist") < 30.0);
      }
    }
  }
}

TEST_CASE("a free rod in a stiff tube that one end holds: it slides at no cost, and is found all the same") {
  // The rod may slide along the arc, and the tube turns about its first end against a weak foundation.
  const std::string text = R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "tube"
geometry = { type = "arc", radius = "2000 mm", angle = "0.07 rad", nodes = 141, origin = ["-69.985710 mm", "1.2248749 mm"], rotation = ["-0.035 rad"] }
radius = "1 mm"
kinematics = "edge-frames"
ends = ["pinned", "free"]
[[wire]]
name = "rod"
geometry = { type = "line", length = "100 mm", nodes = 201, origin = ["-50 mm", "0.3125 mm"] }
radius = "0.8 mm"
kinematics = "edge-frames"
ends = ["free", "free"]
[[energy]]
type = "wire-bending"
on = "rod"
bending-stiffness = "10000 N mm^2"
[[energy]]
type = "vessel-strain"
on = "tube"
bending-stiffness = "1e7 N mm^2"
stretch-stiffness = "1e5 N"
[[energy]]
type = "anchoring"
on = "tube"
stiffness = "0.01 N/mm^2"
[[constraint]]
name = "lumen"
type = "node-wise-contact"
on = ["rod", "tube"]
[solver]
type = "interior-point"
)";
  const SolvedScene scene = solved(session_of_text(text));
  CHECK_MESSAGE(scene.solution.certificate.verdict == Verdict::converged, scene.solution.certificate.reason);
  CHECK(scene.solution.solver.iterations < 100);
}

TEST_CASE("a straight wire without tension: next to nothing has curvature along it") {
  Sliding straight;
  straight.geometry = "type = \"line\", length = \"209.036 mm\"";
  straight.radius = "3.55 mm", straight.wire_radius = "0.46 mm", straight.ends = R"(["pinned", "clamped"])";
  straight.wire_bending = "886.827 N mm^2", straight.vessel_bending = "45.3152 N mm^2", straight.torsion = "30 N mm^2";
  straight.stretch = "3.70902 N", straight.anchoring = "0.0103929 N/mm^2";
  check_converges(straight, 30);
}

TEST_CASE("State 1 is the solution and the vessel may spin about itself: rounding is no reason to stall") {
  Sliding straight;
  straight.dimension = 3, straight.vessel_nodes = 41, straight.wire_nodes = 63, straight.kinematics = "nodes";
  straight.geometry = "type = \"line\", length = \"365.729 mm\"";
  straight.radius = "7.37728 mm", straight.wire_radius = "0.640606 mm", straight.ends = R"(["pinned", "pinned"])";
  straight.wire_bending = "192.816 N mm^2", straight.vessel_bending = "344.343 N mm^2";
  straight.torsion = "309.355 N mm^2", straight.stretch = "13.4707 N", straight.anchoring = "0.0342073 N/mm^2";
  straight.tension = "16.5815 N", straight.contact = "segment-wise-contact";
  check_converges(straight, 30);
}

TEST_CASE("segment rows far from the wall do not change places for ever") {
  Sliding wave;
  wave.vessel_nodes = 100, wave.wire_nodes = 58, wave.kinematics = "nodes";
  wave.geometry = "type = \"sinusoid\", chord = \"225.77 mm\", amplitude = \"31.6866 mm\", periods = 1.67989";
  wave.radius = "8.34534 mm", wave.wire_radius = "0.352887 mm";
  wave.ends = R"([{ type = "pinned", move = ["0.214872 mm", "0.54526 mm"] },
                  { type = "clamped", axes = "end", turn = "0.0422773 rad" }])";
  wave.wire_bending = "156.125 N mm^2", wave.vessel_bending = "617.652 N mm^2", wave.torsion = "278.344 N mm^2";
  wave.stretch = "50.2999 N", wave.anchoring = "0.00661064 N/mm^2", wave.tension = "22.5433 N";
  wave.contact = "segment-wise-contact", wave.gap = "smooth-distance";
  check_converges(wave, 60);
}

TEST_CASE("the system at the result is lent: that of dense algebra, with active rows exact") {
  struct Lender {
    const char* solver;
    const char* kinematics;
    int dimension;
    bool contact;
  };
  for (const Lender& lender :
       {Lender{"interior-point", "edge-frames", 2, true}, Lender{"interior-point", "nodes", 3, true},
        Lender{"active-set", "edge-frames", 3, true}, Lender{"active-set", "nodes", 2, true},
        Lender{"trust-region", "edge-frames", 2, false}}) {
    CAPTURE(std::string(lender.solver));
    CAPTURE(std::string(lender.kinematics));
    CAPTURE(lender.dimension);
    SmallScene small = contact_scene(lender.dimension, lender.kinematics, lender.kinematics);
    small.vessel_frames = lender.dimension == 3;
    const std::string by = std::string("type = \"") + lender.solver + "\"";
    const SolvedScene scene =
        solved(lender.contact ? session_of_text(edited(contact_text(small), "type = \"ipopt\"", by))
                              : session_of_file("shortened-rod.toml"));
    REQUIRE_MESSAGE(scene.solution.certificate.verdict == Verdict::converged, scene.solution.certificate.reason);
    Assembly& assembly = scene.assembly();
    const int n = assembly.unknowns(), m = assembly.rows();
    std::vector<double> residual(at(m)), jacobian(at(assembly.jacobian_pattern().entries())),
        hessian(at(assembly.hessian_pattern().entries())), multipliers = scene.solution.multipliers;
    ProblemEvaluation wanted;
    wanted.rows = residual;
    wanted.jacobian = jacobian;
    REQUIRE(assembly.evaluate(scene.solution.q, wanted).ok());
    std::vector<char> active(at(m), 1);
    int held = 0;
    for (int r = 0; r < m; ++r) {
      if (assembly.row_lower()[at(r)] == assembly.row_upper()[at(r)]) continue;
      active[at(r)] = multipliers[at(r)] > 1e-3 ? 1 : 0;
      held += active[at(r)];
      if (active[at(r)] == 0) multipliers[at(r)] = 0.0;
    }
    REQUIRE((held > 0) == lender.contact);
    REQUIRE(assembly.lagrangian_hessian(scene.solution.q, 1.0, multipliers, hessian).ok());
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + m, n + m);
    for (int j = 0; j < n; ++j) {
      for (int e = assembly.hessian_pattern().begin[at(j)]; e < assembly.hessian_pattern().begin[at(j) + 1]; ++e) {
        const int i = assembly.hessian_pattern().inner[at(e)];
        k(i, j) = k(j, i) = hessian[at(e)];
      }
    }
    for (int r = 0; r < m; ++r) {
      if (active[at(r)] == 0) k(n + r, n + r) = 1.0;
      for (int e = assembly.jacobian_pattern().begin[at(r)];
           active[at(r)] != 0 && e < assembly.jacobian_pattern().begin[at(r) + 1]; ++e) {
        const int u = assembly.jacobian_pattern().inner[at(e)];
        k(n + r, u) = k(u, n + r) = jacobian[at(e)];
      }
    }
    std::vector<double> right = random_numbers(n + m, 7), out(at(n + m), 1.0);
    for (int r = 0; r < m; ++r) {
      if (active[at(r)] == 0) right[at(n + r)] = 0.0;
    }
    const Status status = scene.session->solver->solve_kkt(right, out);
    REQUIRE_MESSAGE(status.ok(), status.text);
    const Eigen::VectorXd expected = k.fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(right.data(), n + m).eval());
    REQUIRE(expected.cwiseAbs().maxCoeff() > 1e-3);
    const Eigen::VectorXd off = Eigen::Map<const Eigen::VectorXd>(out.data(), n + m) - expected;
    CHECK(off.head(n).cwiseAbs().maxCoeff() <= 1e-6 * expected.head(n).cwiseAbs().maxCoeff());
    CHECK(off.tail(m).cwiseAbs().maxCoeff() <= 1e-6 * expected.tail(m).cwiseAbs().maxCoeff());
  }
}

TEST_CASE("nothing is lent before a solve, and no other right-hand side than one that fits") {
  const auto session =
      session_of_text(edited(contact_text(contact_scene(2)), "type = \"ipopt\"", "type = \"interior-point\""));
  std::vector<double> numbers(at(session->assembly->unknowns() + session->assembly->rows()), 1.0), out = numbers;
  const Status early = session->solver->solve_kkt(numbers, out);
  CHECK(early.code == Code::unsupported);
  CHECK(contains(early.text, "nothing was solved yet"));
  solve(*session, {});
  std::vector<double> few(3, 1.0);
  const Status misfit = session->solver->solve_kkt(few, out);
  CHECK(misfit.code == Code::invalid_input);
  CHECK(session->solver->solve_kkt(numbers, out).ok());
}

}  // namespace bowstring::testing
