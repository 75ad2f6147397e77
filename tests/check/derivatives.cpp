#include <doctest/doctest.h>

#include "tests/check/checked_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr const char* planar = R"(
[[energy]]
type = "TYPE"
on   = "rod"
)";

CheckReport with_energy(const std::string& type, int nodes = 9) {
  Rod rod;
  rod.nodes = nodes;
  rod.geometry = R"(type = "arc", radius = "100 mm", angle = "1 rad")";
  rod.ends = R"(["pinned", "pinned"])";
  rod.more = planar;
  rod.more.replace(rod.more.find("TYPE"), 4, type);
  return check(*dishonest_session(rod.text())->assembly);
}

CheckReport with_constraint(const std::string& type) {
  Rod rod;
  rod.geometry = R"(type = "arc", radius = "100 mm", angle = "1 rad")";
  rod.more = "\n[[constraint]]\nname = \"channel\"\ntype = \"" + type + "\"\non = [\"rod\"]\n";
  return check(*dishonest_session(rod.text())->assembly);
}

}  // namespace

TEST_CASE("shipped scenes hold, and every line was judged") {
  for (const char* name :
       {"planar-iliac-smooth.toml", "helical-iliac-full.toml", "cantilever.toml", "buckled-rod.toml"}) {
    CAPTURE(name);
    const auto session = session_of_file(name);
    const CheckReport report = check(*session->assembly);
    CHECK_MESSAGE(report.verdict() == CheckVerdict::ok, remarks(report));
    CHECK(report.states == 3);
    CHECK(report.directions >= 10);
    const std::size_t claims = 2 * (session->scene->energies.size() + session->assembly->row_origins().size() + 1);
    REQUIRE(report.derivatives.size() == claims);
    for (const CheckLine& line : report.derivatives) {
      CAPTURE(line.subject);
      CHECK(line.error <= 1e-6);
    }
  }
}

TEST_CASE("a wall of polylines is not smooth where wires start on its corners, and that is no fault") {
  for (const char* name : {"planar-iliac.toml", "helical-iliac.toml"}) {
    CAPTURE(name);
    const CheckReport report = check(*session_of_file(name)->assembly);
    CHECK_MESSAGE(report.verdict() == CheckVerdict::note, remarks(report));
    const CheckLine& line = line_of(report.derivatives, "constraint 'lumen'", "Hessian");
    CHECK(line.verdict == CheckVerdict::note);
    CHECK_MESSAGE(contains(line.text, "not smooth"), line.text);
    CHECK_MESSAGE(contains(line.where, "the start"), line.where);
  }
}

TEST_CASE("every kinematics, with and without material frames, holds") {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const bool frames : {false, true}) {
        if (frames && dimension == 2) continue;
        SmallScene scene;
        scene.dimension = dimension;
        scene.vessel_kinematics = scene.wire_kinematics = kinematics;
        scene.vessel_frames = scene.wire_frames = frames;
        scene.wire_ends = R"(["clamped", "pinned"])";
        CAPTURE(scene.text());
        const CheckReport report = check(*session_of(scene)->assembly);
        CHECK_MESSAGE(report.verdict() == CheckVerdict::ok, remarks(report));
      }
    }
  }
}

TEST_CASE("a stress that is no derivative is caught, and its node is named, in a small and in a large scene") {
  for (const int nodes : {9, 200}) {
    CAPTURE(nodes);
    const CheckReport report = with_energy("test-wrong-gradient", nodes);
    const std::string subject = "energy 'test-wrong-gradient' on 'rod'";
    const CheckLine& line = line_of(report.derivatives, subject, "gradient");
    CHECK(line.verdict == CheckVerdict::failed);
    CHECK(line.text == "is not the derivative");
    CHECK_MESSAGE(contains(line.where, "position 3 of 'rod'"), line.where);
    CHECK(line.error > 1e-5);
    CHECK(line.error <= 0.011);
    CHECK(line_of(report.derivatives, subject, "Hessian").text ==
          "not judged: the gradient that it would be compared with is wrong");
    CHECK(line_of(report.derivatives, "energy 'bending' on 'rod'", "gradient").verdict == CheckVerdict::ok);
    CHECK(line_of(report.derivatives, "the assembled Lagrangian", "gradient").verdict == CheckVerdict::failed);
    CHECK(report.verdict() == CheckVerdict::failed);
  }
}

TEST_CASE("a modulus that is no derivative is caught, and its node is named") {
  for (const int nodes : {9, 200}) {
    CAPTURE(nodes);
    const CheckReport report = with_energy("test-wrong-hessian", nodes);
    const std::string subject = "energy 'test-wrong-hessian' on 'rod'";
    CHECK(line_of(report.derivatives, subject, "gradient").verdict == CheckVerdict::ok);
    const CheckLine& line = line_of(report.derivatives, subject, "Hessian");
    CHECK(line.verdict == CheckVerdict::failed);
    CHECK_MESSAGE(contains(line.where, "at position 4 of 'rod'"), line.where);
    CHECK(line.error == doctest::Approx(0.1).epsilon(0.5));
  }
}

TEST_CASE("a row with a wrong gradient or second derivative is caught, and named with the node that it reads") {
  const CheckReport first = with_constraint("test-wrong-jacobian");
  const CheckLine& jacobian = line_of(first.derivatives, "constraint 'channel'", "Jacobian");
  CHECK(jacobian.verdict == CheckVerdict::failed);
  CHECK_MESSAGE(contains(jacobian.where, "at row 2 (node 2 of 'rod'), along position 2 of 'rod', y"), jacobian.where);
  CHECK(jacobian.error == doctest::Approx(0.05).epsilon(0.1));

  const CheckReport second = with_constraint("test-wrong-row-hessian");
  CHECK(line_of(second.derivatives, "constraint 'channel'", "Jacobian").verdict == CheckVerdict::ok);
  const CheckLine& hessian = line_of(second.derivatives, "constraint 'channel'", "Hessian");
  CHECK(hessian.verdict == CheckVerdict::failed);
  CHECK_MESSAGE(contains(hessian.where, "at position 2 of 'rod', y"), hessian.where);
}

TEST_CASE("a kink is said to be one") {
  const CheckReport report = with_energy("test-kink");
  const std::string subject = "energy 'test-kink' on 'rod'";
  CHECK(line_of(report.derivatives, subject, "gradient").verdict == CheckVerdict::ok);
  const CheckLine& line = line_of(report.derivatives, subject, "Hessian");
  CHECK(line.verdict == CheckVerdict::note);
  CHECK_MESSAGE(contains(line.text, "not smooth"), line.text);
  CHECK_MESSAGE(contains(line.where, "the start"), line.where);
}

TEST_CASE("an energy that vanishes was not judged") {
  const CheckReport report = with_energy("test-idle");
  const CheckLine& line = line_of(report.derivatives, "energy 'test-idle' on 'rod'", "gradient");
  CHECK(line.verdict == CheckVerdict::note);
  CHECK(line.text == "vanishes at every state: nothing was judged");
}

TEST_CASE("checking leaves the assembly where it was") {
  const auto session = session_of_file("planar-iliac-smooth.toml");
  const std::vector<double> start = session->scene->start_coordinates();
  const int n = session->assembly->unknowns();
  const auto gradient = [&] {
    std::vector<double> out(at(n));
    ProblemEvaluation wanted;
    wanted.gradient = out;
    REQUIRE(session->assembly->evaluate(start, wanted).ok());
    return out;
  };
  const std::vector<double> before = gradient();
  REQUIRE(largest(before) > 0.0);
  (void)check(*session->assembly);
  CHECK(largest_difference(before, gradient()) == 0.0);
}

TEST_CASE("one energy's gradient and Hessian are those of a scene that has no other") {
  SmallScene scene;
  scene.contact = "";
  const auto session = session_of(scene);
  Assembly& assembly = *session->assembly;
  const std::vector<double> q = moved_start(*session, 0.2, 3);
  const SparsityPattern pattern = assembly.hessian_pattern();
  std::vector<double> sum(at(session->scene->unknowns), 0.0), own, all;
  std::vector<double> sum_hessian(at(pattern.entries()), 0.0), own_hessian(sum_hessian), hessian(sum_hessian);
  for (int e = 0; e < static_cast<int>(session->scene->energies.size()); ++e) {
    REQUIRE(assembly.term_gradient(q, e, own).ok());
    REQUIRE(assembly.term_hessian(q, e, own_hessian).ok());
    CHECK(largest(own) > 0.0);
    for (std::size_t u = 0; u < sum.size(); ++u) sum[u] += own[u];
    for (std::size_t k = 0; k < sum_hessian.size(); ++k) sum_hessian[k] += own_hessian[k];
  }
  const std::vector<double> none(at(assembly.rows()), 0.0);
  REQUIRE(assembly.full_gradient(q, none, all).ok());
  REQUIRE(assembly.lagrangian_hessian(q, 1.0, none, hessian).ok());
  CHECK(largest_difference(sum, all) <= 1e-12 * largest(all));
  CHECK(largest_difference(sum_hessian, hessian) <= 1e-12 * largest(hessian));
}

}  // namespace bowstring::testing
