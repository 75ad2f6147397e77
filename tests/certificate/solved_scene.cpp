#include "tests/certificate/solved_scene.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace bowstring::testing {

SmallScene contact_scene(int dimension, const char* vessel_kinematics, const char* wire_kinematics) {
  SmallScene scene;
  scene.dimension = dimension;
  scene.geometry = dimension == 2
                       ? R"({ type = "sinusoid", chord = "60 mm", amplitude = "9 mm", periods = 1, nodes = 20 })"
                       : R"({ type = "helix", chord = "60 mm", radius = "9 mm", turns = 0.8, nodes = 20 })";
  scene.wire_nodes = 18;
  scene.vessel_kinematics = vessel_kinematics;
  scene.wire_kinematics = wire_kinematics;
  return scene;
}

std::string contact_text(const SmallScene& scene, const std::string& solver_keys) {
  std::string text = scene.text();
  const std::string window = "window = 20\n";
  if (const std::size_t where = text.find(window); where != std::string::npos) text.erase(where, window.size());
  return text + solver_keys + "\n";
}

SolvedScene solved(std::unique_ptr<Session> session) {
  SolvedScene out;
  out.session = std::move(session);
  out.solution = solve(*out.session, {});
  return out;
}

CertificateTable no_thresholds() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CertificateTable out;
  out.stationarity = out.penetration = out.complementarity = infinity;
  out.multiplier = -infinity;
  return out;
}

Certificate certified(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& multipliers,
                      const CertificateTable& thresholds, Claim claim, const std::string& reason) {
  Certificate out;
  const Status status = certify(assembly, q, multipliers, thresholds, claim, reason, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

RowOrigin contact_rows(const Assembly& assembly) {
  for (const RowOrigin& group : assembly.row_origins()) {
    if (group.constraint >= 0) return group;
  }
  FAIL("the scene has no constraint");
  return {};
}

}  // namespace bowstring::testing
