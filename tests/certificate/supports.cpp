#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/lie/small_matrix.hpp"
#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// Force of the foundation on the vessel, N: −Σ k_i (p_i − p_i⁰), from stiffness and shares of the curve alone.
Vector3 foundation_force(const Session& session, const std::vector<double>& q, double stiffness,
                         double& largest_spring) {
  const Curve& vessel = *session.scene->find("iliac");
  const int d = session.scene->dimension;
  Vector3 out;
  for (int i = 0; i < vessel.view.nodes; ++i) {
    const double share = 0.5 * ((i > 0 ? vessel.edge_length[at(i - 1)] : 0.0) +
                                (i + 1 < vessel.view.nodes ? vessel.edge_length[at(i)] : 0.0));
    for (int k = 0; k < d; ++k) {
      const double u = q[at(vessel.coordinate_begin + i * d + k)] - vessel.reference[at(i * d + k)];
      out[k] -= stiffness * share * u;
      largest_spring = std::max(largest_spring, std::fabs(stiffness * share * u));
    }
  }
  return out;
}

/// What the supports and the foundation exert sums to zero: contact and tension are internal.
void check_balance(const std::string& name, double stiffness, std::vector<Override> overrides) {
  CAPTURE(name);
  overrides.push_back({"solver.tolerance", "1e-9"});
  const auto session = session_of_file(name, overrides);
  const Solution solution = solve(*session, nullptr);
  REQUIRE_MESSAGE(solution.certificate.verdict == Verdict::converged, solution.certificate.reason);
  Readings readings;
  REQUIRE(read_solution(*session, solution, readings).ok());
  double largest_spring = 0.0;
  Vector3 sum = foundation_force(*session, solution.q, stiffness, largest_spring);
  REQUIRE(largest_spring > 1e-2);
  double largest_force = 0.0;
  for (const SupportRecord& support : readings.supports) {
    for (int k = 0; k < 3; ++k) sum[k] += support.force[k];
    largest_force = std::max(largest_force, std::hypot(support.force[0], support.force[1], support.force[2]));
  }
  REQUIRE(largest_force > 0.1);
  CHECK(norm(sum) <= 1e-6);
  MESSAGE(name << ": supports and foundation leave " << norm(sum) << " N");
}

}  // namespace

TEST_CASE("supports and foundation balance to 1e-6 N") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    check_balance("planar-iliac-smooth.toml", 0.012801,
                  {{"vessel.iliac.kinematics", kinematics}, {"wire.lunderquist.kinematics", kinematics}});
  }
  check_balance("helical-iliac-full.toml", 0.023314, {});
  check_balance("tortuous-iliac.toml", 0.02, {});
}

TEST_CASE("supports and foundation balance on a real artery" *
          doctest::skip(std::getenv("BOWSTRING_DATA") == nullptr)) {
  const std::string file = std::string(std::getenv("BOWSTRING_DATA")) + "/vmr_0110/left_smoothed_200.csv";
  check_balance("tortuous-iliac.toml", 0.02,
                {{"vessel.iliac.geometry", "{ type = \"csv\", file = \"" + file + "\" }"},
                 {"vessel.iliac.radius", "{ column = \"radius_mm\" }"}});
}

}  // namespace bowstring::testing
