#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/result/quantities.hpp"
#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

/// Forces in N and moments about the origin in N mm, on the whole scene.
struct Balance {
  double force[3] = {}, moment[3] = {}, largest_force = 0.0;

  void add(const double* place, const double* own, int dimension) {
    double p[3] = {}, f[3] = {};
    for (int k = 0; k < dimension; ++k) p[k] = place[k], f[k] = own[k];
    for (int k = 0; k < 3; ++k) {
      force[k] += f[k];
      moment[k] += p[(k + 1) % 3] * f[(k + 2) % 3] - p[(k + 2) % 3] * f[(k + 1) % 3];
      largest_force = std::max(largest_force, std::fabs(f[k]));
    }
  }
};

void add_supports(const Readings& readings, int d, Balance& out) {
  REQUIRE(readings.supports.size() == 4);
  for (const SupportRecord& support : readings.supports) {
    const std::vector<double>& points = readings.curves[at(support.curve)].points;
    out.add(points.data() + (support.end == 0 ? 0 : points.size() - at(d)), support.force, d);
    for (int k = 0; k < 3; ++k) out.moment[k] += support.moment[k];
  }
  REQUIRE(out.largest_force > 1.0);
}

void add_foundation(const Curve& vessel, const std::vector<double>& points, double stiffness, Balance& out) {
  const int d = vessel.view.dimension;
  double sum = 0.0;
  for (int i = 0; i < vessel.view.nodes; ++i) {
    const double before = i > 0 ? vessel.view.edge_length[i - 1] : 0.0;
    const double after = i + 1 < vessel.view.nodes ? vessel.view.edge_length[i] : 0.0;
    double force[3] = {};
    for (int k = 0; k < d; ++k) {
      const double displacement = points[at(d * i + k)] - vessel.reference[at(d * i + k)];
      force[k] = -stiffness * 0.5 * (before + after) * displacement;
      sum += std::fabs(force[k]);
    }
    out.add(points.data() + d * i, force, d);
  }
  REQUIRE(sum > 1.0);
}

void check_balance(const SolvedScene& scene, double stiffness) {
  REQUIRE(scene.solution.certificate.verdict == Verdict::converged);
  Readings readings;
  const Status status = read_solution(*scene.session, scene.solution, readings);
  REQUIRE_MESSAGE(status.ok(), status.text);
  Balance out;
  add_supports(readings, scene.session->scene->dimension, out);
  const Curve& vessel = *scene.session->scene->find("iliac");
  add_foundation(vessel, readings.curves[at(vessel.view.index)].points, stiffness, out);
  for (int k = 0; k < 3; ++k) {
    CHECK(std::fabs(out.force[k]) <= 1e-6);
    CHECK(std::fabs(out.moment[k]) <= 1e-4);
  }
}

}  // namespace

TEST_CASE("forces and moments of every kind of support balance the foundation: in the plane") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    for (const char* ends : {R"(["pinned", "pinned"])", R"(["clamped", "held-edge"])"}) {
      CAPTURE(std::string(kinematics));
      CAPTURE(std::string(ends));
      const std::string quoted = std::string("\"") + kinematics + "\"";
      check_balance(solved(session_of_file("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", "40"},
                                                                        {"vessel.iliac.kinematics", quoted},
                                                                        {"wire.lunderquist.kinematics", quoted},
                                                                        {"wire.lunderquist.ends", ends},
                                                                        {"solver.tolerance", "1e-9"}})),
                    0.012801);
    }
  }
}

TEST_CASE("forces and moments of every kind of support balance the foundation: a helix with material frames") {
  for (const char* ends : {R"(["clamped", "pinned"])", R"(["held-edge", "clamped"])"}) {
    CAPTURE(std::string(ends));
    check_balance(solved(session_of_file("helical-iliac-full.toml", {{"vessel.iliac.geometry.nodes", "30"},
                                                                     {"wire.lunderquist.ends", ends},
                                                                     {"solver.tolerance", "1e-9"}})),
                  0.023314);
  }
}

}  // namespace bowstring::testing
