#include <doctest/doctest.h>

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

}  // namespace

TEST_CASE("a number that is not finite never passes") {
  Solved solved;
  std::vector<double> multipliers = solved.solution.multipliers;
  multipliers[3] = std::numeric_limits<double>::quiet_NaN();
  const Certificate certificate = solved.judge(solved.solution.q, multipliers);
  CHECK(certificate.verdict == Verdict::stalled);
  CHECK_FALSE(certificate.first_order);
}

}  // namespace bowstring::testing
