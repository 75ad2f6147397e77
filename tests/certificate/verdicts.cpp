#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct Solved {
  std::unique_ptr<Session> session;
  Solution solution;

  explicit Solved(const SmallScene& scene = {}) : session(session_of(scene)), solution(solve(*session, nullptr)) {
    REQUIRE_MESSAGE(solution.certificate.verdict == Verdict::converged, solution.certificate.reason);
  }
  Certificate judge(const std::vector<double>& q, const std::vector<double>& multipliers,
                    const CertificateTable& thresholds = {}, Claim claim = Claim::stalled) {
    REQUIRE(session->assembly->accept(q).ok());
    Certificate out;
    const Status status = certify(*session->assembly, q, multipliers, thresholds, claim, "so it says", out);
    REQUIRE_MESSAGE(status.ok(), status.text);
    return out;
  }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("every threshold that is missed is named with its figure, and the solver's claim names the status") {
  Solved solved;
  const std::vector<double>& q = solved.solution.q;
  std::vector<double> multipliers = solved.solution.multipliers;
  CHECK(solved.judge(q, multipliers, {}, Claim::failed).verdict == Verdict::converged);  // whatever the solver says

  multipliers.back() -= 0.5;
  const Certificate wrong = solved.judge(q, multipliers);
  CHECK(wrong.verdict == Verdict::stalled);
  CHECK(wrong.stationarity > 0.01);
  CHECK(wrong.minimum_multiplier == doctest::Approx(multipliers.back()));
  CHECK(wrong.complementarity > 0.01);
  CHECK(contains(wrong.reason, "so it says; stationarity "));
  CHECK(contains(wrong.reason, "N (threshold 1e-06), complementarity "));
  CHECK(contains(wrong.reason, "N mm (threshold 1e-08), smallest multiplier -0.5 N (threshold -1e-08)"));
  CHECK(solved.judge(q, multipliers, {}, Claim::infeasible).verdict == Verdict::infeasible);
  CHECK(solved.judge(q, multipliers, {}, Claim::diverged).verdict == Verdict::diverged);
  CHECK(solved.judge(q, multipliers, {}, Claim::failed).verdict == Verdict::failed);
  CHECK(solved.judge(q, multipliers, {}, Claim::optimal).verdict == Verdict::stalled);

  CertificateTable generous;
  generous.stationarity = generous.complementarity = 1e3;
  generous.multiplier = -1.0;
  CHECK(solved.judge(q, multipliers, generous).verdict == Verdict::converged);
}

TEST_CASE("a number that is not finite never passes") {
  Solved solved;
  std::vector<double> multipliers = solved.solution.multipliers;
  multipliers[3] = std::numeric_limits<double>::quiet_NaN();
  const Certificate certificate = solved.judge(solved.solution.q, multipliers);
  CHECK(certificate.verdict == Verdict::stalled);
  CHECK_FALSE(certificate.first_order);
}

TEST_CASE("rows that are violated are measured in mm") {
  Solved solved;
  std::vector<double> q = solved.solution.q;
  const Curve& wire = *solved.session->scene->find("wire");
  q[at(wire.coordinate_begin + 3 * 2 + 1)] += 0.25;
  const Certificate certificate = solved.judge(q, solved.solution.multipliers);
  CHECK(certificate.verdict == Verdict::stalled);
  CHECK(certificate.penetration >= 0.25 * 0.99);
  CHECK(contains(certificate.reason, "row penetration"));
}

TEST_CASE("folded: an edge shorter than a fifth, or one that turns back, is invalid with its place") {
  SmallScene scene;
  scene.vessel_kinematics = scene.wire_kinematics = "nodes";
  scene.contact = "";
  Solved solved(scene);
  CertificateTable lenient;
  lenient.stationarity = 1e6;
  const Curve& vessel = *solved.session->scene->find("vessel");
  const int d = 2, begin = vessel.coordinate_begin;
  REQUIRE(solved.judge(solved.solution.q, solved.solution.multipliers, lenient).verdict == Verdict::converged);

  std::vector<double> shortened = solved.solution.q;
  for (int k = 0; k < d; ++k) {
    const double edge = shortened[at(begin + 4 * d + k)] - shortened[at(begin + 3 * d + k)];
    shortened[at(begin + 4 * d + k)] = shortened[at(begin + 3 * d + k)] + 0.1 * edge;
  }
  const Certificate folded = solved.judge(shortened, solved.solution.multipliers, lenient);
  CHECK(folded.verdict == Verdict::invalid);
  CHECK(contains(folded.reason, "edge 3 of vessel 'vessel' at s = "));
  CHECK(contains(folded.reason, " mm has folded: stretch ratio 0.1"));
  CHECK(contains(folded.reason, "give the vessel a stretch-stiffness, or a coarser mesh"));

  std::vector<double> turned = solved.solution.q;
  for (int k = 0; k < d; ++k) {
    const double edge = turned[at(begin + 4 * d + k)] - turned[at(begin + 3 * d + k)];
    turned[at(begin + 4 * d + k)] = turned[at(begin + 3 * d + k)] - 0.7 * edge;
  }
  const Certificate back = solved.judge(turned, solved.solution.multipliers, lenient);
  CHECK(back.verdict == Verdict::invalid);
  CHECK(contains(back.reason, "turns by more than 90 degrees against the one before it"));
}

TEST_CASE("tunnelled: a wall crossed between rows that all hold is invalid with its place") {
  SmallScene scene;
  scene.geometry = R"({ type = "arc", radius = "20 mm", angle = 3.0, nodes = 25 })";
  scene.radius = "\"1 mm\"";
  scene.wire_nodes = 4;
  scene.wire_kinematics = scene.vessel_kinematics = "nodes";
  scene.contact = R"(centerline = "spline")";
  const auto session = session_of(scene);
  // Three chords whose nodes lie on the centerline: each row holds, and each chord leaves the lumen.
  const std::vector<double> q = session->scene->start_coordinates();
  const std::vector<double> multipliers(at(session->assembly->rows()), 0.0);
  CertificateTable lenient;
  lenient.stationarity = 1e6;
  lenient.penetration = 1e-4;  // mm: the chords' lengths are not quite equal
  Certificate certificate;
  REQUIRE(certify(*session->assembly, q, multipliers, lenient, Claim::optimal, "", certificate).ok());
  CHECK(certificate.penetration <= 1e-4);
  CHECK(certificate.verdict == Verdict::invalid);
  const double depth = 20.0 * (1.0 - std::cos(0.5)) - 0.6;
  CHECK(certificate.dense_penetration().value() == doctest::Approx(depth).epsilon(0.01));
  CHECK(contains(certificate.reason, "wire 'wire' passes through the wall of 'vessel' between its rows, from wire s = "));
  CHECK(contains(certificate.reason, " mm there, where a sound mesh allows 0.63 mm; use a finer wire mesh"));
}

}  // namespace bowstring::testing
